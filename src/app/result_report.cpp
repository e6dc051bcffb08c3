#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>

#include "app/case_report.hpp"
#include "app/checkpoints.hpp"
#include "core/config_node.hpp"
#include "core/config_reader.hpp"
#include "core/errors.hpp"
#include "core/hdf5_file.hpp"
#include "core/snapshot.hpp"

namespace quicksand {

namespace {

namespace fs = std::filesystem;

std::string read_text(const fs::path& file) {
  std::ifstream stream(file);
  if (!stream) throw FileError(file.string() + ": can't be read");
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::string title_of(const ConfigDocument& document) {
  const ConfigNode* title = document.root.find("title");
  return title != nullptr ? title->text : "";
}

std::string folder_report(const fs::path& folder) {
  const fs::path case_file = folder / "case.yaml";
  const fs::path summary = folder / "summary.json";
  if (!fs::exists(case_file) && !fs::exists(summary)) {
    throw FileError(folder.string() + ": holds no results (neither case.yaml nor summary.json)");
  }
  std::size_t field_files = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename().string().starts_with("fields_")) ++field_files;
  }
  std::ostringstream out;
  if (fs::exists(case_file)) out << "title        " << title_of(read_yaml_file(case_file.string())) << "\n";
  out << "field files  " << field_files << "\n";
  for (const fs::path& file : checkpoints_in(folder)) out << "checkpoint   " << file.filename().string() << "\n";
  if (!fs::exists(summary)) {
    out << "no summary.json: the run has not finished\n";
  } else {
    out << "summary      " << read_text(summary);
  }
  return out.str();
}

std::string field_file_report(const fs::path& file) {
  const FieldSnapshot snapshot = read_fields(file);
  std::ostringstream out;
  out << "title     " << snapshot.title << "\n"
      << "units     " << snapshot.units << "\n"
      << "geometry  " << snapshot.geometry << "\n"
      << "step      " << snapshot.step << "\n"
      << "time      " << shortest(snapshot.time) << "\n"
      << "dt        " << shortest(snapshot.dt) << "\n";
  for (const SnapshotAxis& axis : snapshot.axes) {
    out << "axis      " << axis.name << ": " << axis.faces.size() - 1 << " cells from " << shortest(axis.faces.front())
        << " to " << shortest(axis.faces.back()) << "\n";
  }
  for (const SnapshotField& field : snapshot.fields) {
    const auto [least, most] = std::minmax_element(field.values.begin(), field.values.end());
    out << "field     " << field.name << ": " << field.components
        << (field.components == 1 ? " component" : " components");
    if (least != field.values.end()) out << ", values from " << shortest(*least) << " to " << shortest(*most);
    out << "\n";
  }
  return out.str();
}

std::string checkpoint_report(const fs::path& file) {
  const CheckpointHead head = open_checkpoint(file).head;
  std::ostringstream out;
  out << "checkpoint, in order\n"
      << "title     " << title_of(parse_yaml(head.case_text, file.string())) << "\n"
      << "step      " << head.step << "\n"
      << "time      " << shortest(head.time) << "\n";
  return out.str();
}

}  // namespace

std::string result_report(const std::string& path) {
  std::error_code code;
  if (!fs::exists(path, code)) throw FileError(path + ": no such file or folder");
  try {
    if (fs::is_directory(path)) return folder_report(path);
    return is_checkpoint(path) ? checkpoint_report(path) : field_file_report(path);
  } catch (const fs::filesystem_error& error) {
    throw FileError(path + ": " + error.code().message());
  }
}

}  // namespace quicksand
