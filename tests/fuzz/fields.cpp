// Whatever a sound HDF5 file holds, `info` tells of it or refuses it.
#include "app/case_report.hpp"
#include "core/errors.hpp"
#include "core/snapshot.hpp"
#include "fuzz/hdf5_tree.hpp"

namespace quicksand::fuzz {

namespace {

std::vector<Item> sound_items() {
  FieldSnapshot snapshot;
  snapshot.title = "Fields";
  snapshot.units = "none";
  snapshot.geometry = "planar";
  snapshot.axes = {{"x", {0, 1, 2, 3}}, {"z", {0, 1, 2}}};
  snapshot.fields = {{"density", 1, std::vector<double>(6, 1.5)}, {"velocity", 2, std::vector<double>(12, -1.0)}};
  const std::filesystem::path file = scratch_folder() / "sound.h5";
  write_fields(file, snapshot);
  return read_tree(file);
}

}  // namespace

}  // namespace quicksand::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace quicksand;
  static const std::vector<fuzz::Item> sound = fuzz::sound_items();
  static const std::filesystem::path file = fuzz::scratch_folder() / "fields_00000001.h5";
  std::vector<fuzz::Item> items = sound;
  fuzz::Input input(data, size);
  fuzz::spoil(items, input);
  fuzz::write_tree(file, items, 0);
  try {
    result_report(file.string());
  } catch (const FileError&) {
    // Refused, as it may be.
  }
  return 0;
}
