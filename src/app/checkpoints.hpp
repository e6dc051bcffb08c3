#pragma once
/// \file
/// The checkpoints of a run: what they hold, where they are, and which one a run goes on from.
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/run_memory.hpp"
#include "core/checkpoint.hpp"

namespace quicksand {

/// What a checkpoint tells about itself before anything is built from it.
struct CheckpointHead {
  std::string case_text;  ///< the effective case, YAML
  long step = 0;          ///< steps taken
  double time = 0;
  bool fields_due = false;  ///< whether the fields of that step are on schedule, so belong to the results

  void exchange(Archive& archive);
};

/// A checkpoint opened and found in order.
struct ResumePoint {
  std::unique_ptr<CheckpointReader> reader;
  CheckpointHead head;
};

/// Name of the checkpoint of a step: checkpoint_00001200.h5. Names sort by step.
std::string checkpoint_file_name(long step);

/// Whether a file is named as a checkpoint.
bool is_checkpoint(const std::filesystem::path& file);

/// The checkpoints of a folder, newest first.
std::vector<std::filesystem::path> checkpoints_in(const std::filesystem::path& folder);

/// Opens a checkpoint. \throws FileError where it is none, damaged, or of another version
ResumePoint open_checkpoint(const std::filesystem::path& file);

/// Opens the newest checkpoint of a folder that is in order, and makes sure that it is one of the case. Those that are
/// newer and damaged are passed over. \param say  is told of them
/// \throws InputError if the folder holds no checkpoint, or that of another case, naming the key
/// \throws FileError if none is in order
ResumePoint find_resume_point(const std::filesystem::path& folder, const CaseConfig& config,
                              const std::function<void(const std::string&)>& say);

/// Writes a checkpoint, then removes all but the newest two. \returns its path \throws FileError
template <int Dim>
std::filesystem::path write_checkpoint(const std::filesystem::path& folder, const CaseConfig& config, bool fields_due,
                                       RunMemory<Dim>& memory, Flow<Dim>& flow);

/// The flow and the run's memory as they were. \throws FileError
template <int Dim>
Flow<Dim> read_checkpoint(CheckpointReader& reader, const CaseConfig& config, RunMemory<Dim>& memory);

}  // namespace quicksand
