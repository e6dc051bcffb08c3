#pragma once
/// \file
/// The folder of a run's results before the run.
#include <string>

namespace quicksand {

/// Makes the folder ready: creates it where missing, checks that it may be written to, and with `overwrite` removes the
/// results of an earlier run (only files that runs write).
/// \throws InputError if the folder holds something and `overwrite` is false
/// \throws FileError if it can't be made or written to
void prepare_output_folder(const std::string& folder, bool overwrite);

/// Makes sure that a run into the folder does not replace or remove the case file it reads.
/// \throws InputError if the file lies in the folder under a name that runs write
void protect_case_file(const std::string& case_file, const std::string& folder);

}  // namespace quicksand
