// Whatever a checkpoint holds, it is refused or gives a flow that can be looked at; behind a wrong seal and a right
// one.
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "app/build_flow.hpp"
#include "app/checkpoints.hpp"
#include "core/errors.hpp"
#include "core/seal.hpp"
#include "fuzz/hdf5_tree.hpp"
#include "physics/diagnostics.hpp"
#include "physics/time_step.hpp"

namespace quicksand::fuzz {

namespace {

namespace fs = std::filesystem;

constexpr const char* small_case = R"(title: A bubble
units: none
grid: {dimension: 2, x: {from: 0, to: 1, cells: 6}, z: {from: 0, to: 1, cells: 5}}
boundaries: {x_min: symmetry, x_max: no_slip, z_min: no_slip, z_max: {open: 1}}
gravity: 1
ambient_pressure: 1
species: [{name: mud, density: 2, rheology: {law: bingham, viscosity: 1, yield_stress: 0.1}}]
initial: [{fill: mud, shape: {layer: {bottom: 0, top: 0.8}}}]
bubbles: [{center: [0, 0.4], radius: 0.2, pressure: 2, adiabatic_exponent: 1.4}]
stages: [{until: 0.5, grid: {x: {from: 0, to: 1, cells: 6}, z: {from: 0, to: 1, cells: 5}}}]
time: {end: 1, cfl: 0.5, max_step: 0.1}
)";

const CaseConfig& config() {
  static const CaseConfig the_case = parse_case(small_case, "case.yaml");
  return the_case;
}

RunMemory<2> new_memory() {
  return {GridSequence<2>(config()), SteadyState(config().time.until_steady), false, RunStatistics({"mud"})};
}

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// A checkpoint after one step.
fs::path sound_checkpoint() {
  RunMemory<2> memory = new_memory();
  Flow<2> flow = build_flow<2>(config(), memory.grids.first());
  memory.statistics.begin_grid("6 x 5", 30, 0);
  memory.statistics.start(flow.volume());
  const StepReport report = flow.advance(0.01);
  memory.statistics.add(report, flow.volume(), flow.state().time);
  return write_checkpoint<2>(scratch_folder(), config(), true, memory, flow);
}

/// Puts the right seal in front of what stands behind the free bytes.
void seal(const fs::path& file) {
  std::string content = content_of(file);
  content.replace(0, seal_size, make_seal(checkpoint_format, std::string_view(content).substr(seal_size)));
  std::ofstream(file, std::ios::binary) << content;
}

void resume_from(const fs::path& file) {
  try {
    ResumePoint point = open_checkpoint(file);
    parse_case(point.head.case_text, file.string());
    RunMemory<2> memory = new_memory();
    Flow<2> flow = read_checkpoint<2>(*point.reader, config(), memory);
    memory.grids.next(flow);
    diagnose(flow);
    stable_step(flow, 0.5);
    memory.statistics.summary("finished", "");
  } catch (const FileError&) {
    // Refused.
  } catch (const InputError&) {
    // So is its case.
  } catch (const NumericalError&) {
    // Its state is not finite.
  }
}

}  // namespace

}  // namespace quicksand::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace quicksand;
  using namespace quicksand::fuzz;
  static const std::filesystem::path sound = sound_checkpoint();
  static const std::string bytes = content_of(sound);
  static const std::vector<Item> items_of_sound = read_tree(sound);
  static const std::filesystem::path file = scratch_folder() / "spoiled.h5";
  Input input(data, size);
  if (input.byte() % 4 == 0) {
    // Behind a seal that is no longer right: bytes replaced, cut off or added.
    std::string text = bytes;
    const std::size_t at = input.below(text.size());
    const bool cut = input.byte() % 2 == 0;
    const std::string piece = input.rest();
    text.replace(at, cut ? std::string::npos : piece.size(), piece);
    std::ofstream(file, std::ios::binary) << text;
    try {
      open_checkpoint(file);
      if (text != bytes) std::abort();
    } catch (const FileError&) {
      // Refused.
    }
    return 0;
  }
  std::vector<Item> items = items_of_sound;
  spoil(items, input);
  write_tree(file, items, seal_size);
  seal(file);
  resume_from(file);
  return 0;
}
