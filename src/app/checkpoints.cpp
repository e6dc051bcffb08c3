#include "app/checkpoints.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "app/build_flow.hpp"
#include "app/case_difference.hpp"
#include "core/errors.hpp"

namespace quicksand {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kept = 2;
constexpr const char* prefix = "checkpoint_";

/// Face coordinates of all axes: a grid may be another than the case begins with.
template <int Dim>
void carry_faces(Archive& archive, std::array<std::vector<double>, Dim>& faces) {
  for (int d = 0; d < Dim; ++d) archive.exchange("grid/" + std::to_string(d), faces[static_cast<std::size_t>(d)]);
}

}  // namespace

void CheckpointHead::exchange(Archive& archive) {
  archive.exchange("head/case", case_text);
  carry(archive, "head/step", step);
  carry(archive, "head/time", time);
  carry(archive, "head/fields_due", fields_due);
}

std::string checkpoint_file_name(long step) {
  const std::string digits = std::to_string(step);
  constexpr std::size_t width = 8;
  return prefix + std::string(width > digits.size() ? width - digits.size() : 0, '0') + digits + ".h5";
}

bool is_checkpoint(const fs::path& file) {
  return file.filename().string().starts_with(prefix) && file.extension() == ".h5";
}

std::vector<fs::path> checkpoints_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code code;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, code)) {
    if (is_checkpoint(entry.path())) files.push_back(entry.path());
  }
  const auto order = [](const fs::path& file) { return std::pair(file.filename().string().size(), file); };
  std::sort(files.begin(), files.end(), [&](const fs::path& a, const fs::path& b) { return order(a) > order(b); });
  return files;
}

ResumePoint open_checkpoint(const fs::path& file) {
  auto reader = std::make_unique<CheckpointReader>(file);
  CheckpointHead head;
  head.exchange(*reader);
  return {std::move(reader), std::move(head)};
}

ResumePoint find_resume_point(const fs::path& folder, const CaseConfig& config,
                              const std::function<void(const std::string&)>& say) {
  const std::vector<fs::path> files = checkpoints_in(folder);
  if (files.empty()) {
    throw InputError("output folder " + folder.string() +
                     " holds no checkpoint to resume from; without --resume the run starts from the beginning");
  }
  std::string reasons;
  for (const fs::path& file : files) {
    try {
      ResumePoint point = open_checkpoint(file);
      const CaseConfig before = parse_case(point.head.case_text, file.string());
      if (const auto difference = difference_that_matters(before, config)) {
        throw InputError(file.string() + " is of another case: " + *difference +
                         "; only time.end, time.until_steady and output may change when a run is resumed");
      }
      if (!reasons.empty()) say("warning: " + reasons + "; resuming from " + file.string());
      return point;
    } catch (const FileError& error) {
      reasons += (reasons.empty() ? "" : "; ") + std::string(error.what());
    }
  }
  throw FileError(reasons + "; there is no checkpoint to resume from");
}

template <int Dim>
fs::path write_checkpoint(const fs::path& folder, const CaseConfig& config, bool fields_due, RunMemory<Dim>& memory,
                          Flow<Dim>& flow) {
  CheckpointHead head{to_yaml(config), flow.state().step, flow.state().time, fields_due};
  fs::path file = folder / checkpoint_file_name(head.step);
  CheckpointWriter writer(file);
  head.exchange(writer);
  memory.exchange(writer);
  std::array<std::vector<double>, Dim> faces;
  for (int d = 0; d < Dim; ++d) faces[static_cast<std::size_t>(d)] = flow.domain().grid.global_faces(d);
  carry_faces<Dim>(writer, faces);
  flow.exchange(writer);
  writer.commit();
  const std::vector<fs::path> files = checkpoints_in(folder);
  for (std::size_t i = kept; i < files.size(); ++i) fs::remove(files[i]);
  return file;
}

template <int Dim>
Flow<Dim> read_checkpoint(CheckpointReader& reader, const CaseConfig& config, RunMemory<Dim>& memory) {
  memory.exchange(reader);
  std::array<std::vector<double>, Dim> faces;
  carry_faces<Dim>(reader, faces);
  Flow<Dim> flow = empty_flow<Dim>(
      config, Domain<Dim>(Grid<Dim>(std::move(faces), geometry_of(config.grid)), make_sides<Dim>(config)));
  flow.exchange(reader);
  return flow;
}

#define QUICKSAND_INSTANTIATE(Dim)                                                                           \
  template fs::path write_checkpoint(const fs::path&, const CaseConfig&, bool, RunMemory<Dim>&, Flow<Dim>&); \
  template Flow<Dim> read_checkpoint(CheckpointReader&, const CaseConfig&, RunMemory<Dim>&);
QUICKSAND_INSTANTIATE(2)
QUICKSAND_INSTANTIATE(3)
#undef QUICKSAND_INSTANTIATE

}  // namespace quicksand
