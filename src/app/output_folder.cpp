#include "app/output_folder.hpp"

#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>
#include <vector>

#include "app/checkpoints.hpp"
#include "core/errors.hpp"
#include "core/snapshot.hpp"

namespace quicksand {

namespace {

namespace fs = std::filesystem;

/// Whether the file was left half written, see AtomicFile.
bool is_part(const fs::path& file) { return file.extension() == ".part" && file.filename().string().starts_with('.'); }

/// Whether a run writes files of that name.
bool is_result(const fs::path& file) {
  const std::string name = file.filename().string();
  if (is_part(file)) return true;
  for (const char* table : {"case.yaml", "summary.json", "history.csv", "bubbles.csv", "events.csv", "crater.csv",
                            "crater_profiles.csv", "fields.xdmf"}) {
    if (name == table) return true;
  }
  return file.extension() == ".h5" &&
         (name.starts_with("fields_") || name.starts_with("failed_fields_") || is_checkpoint(file));
}

/// Removes the files for which wanted(path) is false.
template <class Wanted>
void remove_files(const fs::path& folder, Wanted&& wanted) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  for (const fs::path& file : files) {
    if (!wanted(file)) fs::remove(file);
  }
}

void check_writable(const fs::path& folder) {
  const fs::path probe = folder / ".quicksand_probe";
  if (!std::ofstream(probe)) throw FileError("output folder " + folder.string() + ": no permission to write");
  fs::remove(probe);
}

}  // namespace

void prepare_output_folder(const std::string& folder, bool overwrite) {
  try {
    if (fs::exists(folder) && !fs::is_directory(folder)) {
      throw FileError("output folder " + folder + ": a file has this name");
    }
    if (fs::exists(folder) && !fs::is_empty(folder) && !overwrite) {
      throw InputError("output folder " + folder +
                       " is not empty: choose another with --output, or replace the results " +
                       "in it with --overwrite");
    }
    fs::create_directories(folder);
    check_writable(folder);
    if (overwrite) remove_files(folder, [](const fs::path& file) { return !is_result(file); });
  } catch (const fs::filesystem_error& error) {
    throw FileError("output folder " + folder + ": " + error.code().message());
  }
}

void rewind_output_folder(const std::string& folder, long step, bool keep_fields) {
  const std::string last_fields = fields_file_name(keep_fields ? step : step - 1);
  const std::string last_checkpoint = checkpoint_file_name(step);
  // Names of one kind sort by step; longer ones are of more digits.
  const auto later = [](const std::string& name, const std::string& last) {
    return std::pair(name.size(), name) > std::pair(last.size(), last);
  };
  try {
    check_writable(folder);
    remove_files(folder, [&](const fs::path& file) {
      const std::string name = file.filename().string();
      if (!is_result(file)) return true;
      if (is_part(file) || name == "summary.json" || name.starts_with("failed_fields_")) return false;
      if (is_checkpoint(file)) return !later(name, last_checkpoint);
      return !(name.starts_with("fields_") && file.extension() == ".h5" && later(name, last_fields));
    });
  } catch (const fs::filesystem_error& error) {
    throw FileError("output folder " + folder + ": " + error.code().message());
  }
}

void remove_checkpoints(const std::string& folder) {
  try {
    for (const fs::path& file : checkpoints_in(folder)) fs::remove(file);
  } catch (const fs::filesystem_error& error) {
    throw FileError("output folder " + folder + ": " + error.code().message());
  }
}

void protect_case_file(const std::string& case_file, const std::string& folder) {
  std::error_code code;
  // A link is protected as well as the file it leads to.
  for (const fs::path& file : {fs::absolute(case_file), fs::weakly_canonical(case_file, code)}) {
    if (is_result(file) && fs::equivalent(file.parent_path(), folder, code)) {
      throw InputError(case_file + ": the run would write over this case file, which lies in the output folder " +
                       folder + "; rename it, or choose another folder with --output");
    }
  }
}

}  // namespace quicksand
