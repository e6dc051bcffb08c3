#include "app/output_folder.hpp"

#include <filesystem>
#include <fstream>
#include <system_error>

#include "core/errors.hpp"

namespace quicksand {

namespace {

namespace fs = std::filesystem;

/// Whether a run writes files of that name.
bool is_result(const fs::path& file) {
  const std::string name = file.filename().string();
  for (const char* table : {"case.yaml", "summary.json", "history.csv", "bubbles.csv", "events.csv", "crater.csv",
                            "crater_profiles.csv", "fields.xdmf"}) {
    if (name == table) return true;
  }
  return file.extension() == ".h5" &&
         (name.starts_with("fields_") || name.starts_with("failed_fields_") || name.starts_with("checkpoint_"));
}

void remove_results(const fs::path& folder) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (is_result(entry.path())) fs::remove(entry.path());
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
    if (overwrite) remove_results(folder);
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
