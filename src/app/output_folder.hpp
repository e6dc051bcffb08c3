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

/// Makes the folder of an interrupted run ready to go on from its checkpoint of a step: removes what does not belong to
/// the results up to there (later fields and checkpoints, the summary, files left half written).
/// \param keep_fields  whether fields of that very step belong to them
/// \throws FileError if it can't be written to
void rewind_output_folder(const std::string& folder, long step, bool keep_fields);

/// Removes the checkpoints of a run that is over. \throws FileError
void remove_checkpoints(const std::string& folder);

/// Makes sure that a run into the folder does not replace or remove the case file it reads.
/// \throws InputError if the file lies in the folder under a name that runs write
void protect_case_file(const std::string& case_file, const std::string& folder);

}  // namespace quicksand
