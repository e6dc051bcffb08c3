// Checkpoint files: what they give back, and which are refused.
#include <functional>

#include "app/case_difference.hpp"
#include "app/checkpoint_schedule.hpp"
#include "app/checkpoints.hpp"
#include "app/output_folder.hpp"
#include "core/errors.hpp"
#include "core/seal.hpp"
#include "unit/config_test_case.hpp"
#include "unit/output_test_folder.hpp"

namespace quicksand {
namespace {

namespace fs = std::filesystem;

using CheckpointTest = FolderTest;

template <class Error>
std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

void write(const fs::path& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }

/// A checkpoint without a flow.
fs::path small_checkpoint(const fs::path& folder, long step, const std::string& text = valid_case) {
  fs::path file = folder / checkpoint_file_name(step);
  CheckpointWriter writer(file);
  CheckpointHead head{text, step, 0.1, true};
  head.exchange(writer);
  writer.commit();
  return file;
}

std::string resume_error(const fs::path& folder, const std::string& text = valid_case) {
  return message_of<std::exception>(
      [&] { find_resume_point(folder, parse_case(text, "now.yaml"), [](const std::string&) {}); });
}

TEST_F(CheckpointTest, GivesBackWhatItTook) {
  const Layout<2> layout(Index<2>{{3, 2}});
  std::vector<double> numbers{1, -0.0, 1e-310, INFINITY};
  std::vector<std::int64_t> none;
  std::string text = "a\nb";
  long step = -7;
  CellField field(layout, 0.1);
  Field<Cell, int> labels(layout, 3);
  {
    CheckpointWriter writer(path("c.h5"));
    writer.exchange("numbers", numbers);
    writer.exchange("a/none", none);
    writer.exchange("a/text", text);
    carry(writer, "step", step);
    carry(writer, "field", field);
    carry(writer, "labels", labels);
    writer.commit();
  }
  CheckpointReader reader(path("c.h5"));
  std::vector<double> numbers_back;
  std::vector<std::int64_t> none_back{1};
  std::string text_back;
  long step_back = 0;
  CellField field_back(layout);
  Field<Cell, int> labels_back(layout);
  reader.exchange("numbers", numbers_back);
  reader.exchange("a/none", none_back);
  reader.exchange("a/text", text_back);
  carry(reader, "step", step_back);
  carry(reader, "field", field_back);
  carry(reader, "labels", labels_back);
  EXPECT_EQ(numbers_back, numbers);
  EXPECT_TRUE(std::signbit(numbers_back[1]));
  EXPECT_TRUE(none_back.empty());
  EXPECT_EQ(text_back, text);
  EXPECT_EQ(step_back, step);
  EXPECT_EQ(field_back.values(), field.values());
  EXPECT_EQ(labels_back.values(), labels.values());

  CellField other(Layout<2>(Index<2>{{3, 3}}));
  EXPECT_NE(message_of<FileError>([&] { carry(reader, "field", other); }).find("'field': 42 values, not 49"),
            std::string::npos);
}

TEST_F(CheckpointTest, EveryDamageIsNoticed) {
  const fs::path file = small_checkpoint(folder_, 5);
  EXPECT_EQ(open_checkpoint(file).head.step, 5);
  const std::string whole = content(file);
  for (std::size_t at = 0; at < whole.size(); at += 97) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    write(file, damaged);
    EXPECT_THROW(open_checkpoint(file), FileError) << "byte " << at;
  }
  for (const std::size_t length : {std::size_t{0}, std::size_t{10}, std::size_t{600}, whole.size() - 1}) {
    write(file, whole.substr(0, length));
    EXPECT_THROW(open_checkpoint(file), FileError) << length << " bytes";
  }
  write(file, whole.substr(0, whole.size() - 1));
  EXPECT_NE(message_of<FileError>([&] { open_checkpoint(file); }).find("is cut short"), std::string::npos);
  std::string damaged = whole;
  damaged[2000] = static_cast<char>(damaged[2000] + 1);
  write(file, damaged);
  EXPECT_NE(message_of<FileError>([&] { open_checkpoint(file); }).find("is damaged"), std::string::npos);
  write(file, "x,y\n1,2\n");
  EXPECT_NE(message_of<FileError>([&] { open_checkpoint(file); }).find("is not a quicksand checkpoint"),
            std::string::npos);
  write(file, make_seal({"quicksand checkpoint", 99}, "the future"));
  EXPECT_NE(message_of<FileError>([&] { open_checkpoint(file); }).find("has version 99 of the format"),
            std::string::npos);
}

TEST_F(CheckpointTest, TheNewestInOrderIsTaken) {
  EXPECT_NE(resume_error(folder_).find("holds no checkpoint"), std::string::npos);
  EXPECT_NE(resume_error(path("nowhere")).find("holds no checkpoint"), std::string::npos);
  small_checkpoint(folder_, 99999999);
  const fs::path newest = small_checkpoint(folder_, 100000000);
  const CaseConfig config = parse_case(valid_case, "case.yaml");
  const auto silent = [](const std::string&) {};
  EXPECT_EQ(find_resume_point(folder_, config, silent).head.step, 100000000);
  write(newest, "half");
  std::string said;
  EXPECT_EQ(find_resume_point(folder_, config, [&](const std::string& text) { said = text; }).head.step, 99999999);
  EXPECT_NE(said.find(newest.string()), std::string::npos) << said;
  write(path(checkpoint_file_name(99999999)), "half");
  EXPECT_NE(resume_error(folder_).find("there is no checkpoint to resume from"), std::string::npos);
}

TEST_F(CheckpointTest, AnotherCaseIsRefusedByKey) {
  small_checkpoint(folder_, 5);
  EXPECT_EQ(resume_error(folder_), "no error");
  EXPECT_EQ(resume_error(folder_, with("end: 4.0", "end: 9")), "no error");
  EXPECT_EQ(resume_error(folder_, with("every: 0.1", "every: 0.2")), "no error");
  EXPECT_EQ(resume_error(folder_, with("results/test", "results/other")), "no error");
  const auto refused = [&](const std::string& from, const std::string& to, const std::string& message) {
    const std::string error = resume_error(folder_, with(from, to));
    EXPECT_NE(error.find(message), std::string::npos) << error;
  };
  refused("density: 2.0", "density: 3", "species[0].density was 2, is 3");
  refused("step: 5.0e-4", "cfl: 0.3, max_step: 1", "time.cfl was absent, is 0.3");
  refused("law: newtonian, viscosity: 0.01", "law: inviscid", "species[1].rheology.law was newtonian, is inviscid");
  refused("cells: 16", "cells: 8", "grid.x.cells was 16, is 8");
  refused("  - name: water\n    density: 1.0\n    rheology: {law: newtonian, viscosity: 0.01}\n", "",
          "species was 2 items, is 1 items");
}

TEST_F(CheckpointTest, FolderIsRewound) {
  for (const char* name :
       {"fields_00000001.h5", "fields_00000002.h5", "fields_00000003.h5", "failed_fields_00000002.h5", "summary.json",
        "history.csv", "notes.txt", ".fields_00000003.h5.17.part"}) {
    write(path(name), "");
  }
  for (const long step : {1L, 2L, 3L}) small_checkpoint(folder_, step);
  rewind_output_folder(folder_.string(), 2, true);
  for (const char* name : {"fields_00000001.h5", "fields_00000002.h5", "history.csv", "notes.txt",
                           "checkpoint_00000001.h5", "checkpoint_00000002.h5"}) {
    EXPECT_TRUE(fs::exists(path(name))) << name;
  }
  EXPECT_EQ(files(), 6U);
  rewind_output_folder(folder_.string(), 2, false);
  EXPECT_FALSE(fs::exists(path("fields_00000002.h5")));
  EXPECT_EQ(files(), 5U);
}

TEST(CheckpointSchedule, IsDueOncePerInterval) {
  CheckpointSchedule none({.every = {}, .wall_interval = 1e9}, 0);
  CheckpointSchedule tenths({.every = 0.1, .wall_interval = 1e9}, 0.25);
  CheckpointSchedule always({.every = {}, .wall_interval = 1e-9}, 0);
  EXPECT_FALSE(none.due(100));
  EXPECT_FALSE(tenths.due(0.29));
  EXPECT_TRUE(tenths.due(3 * 0.1)) << "above 0.3 by round-off, as sums of steps may be below";
  EXPECT_FALSE(tenths.due(0.35));
  EXPECT_TRUE(tenths.due(0.7)) << "once for all that a long step passes";
  EXPECT_FALSE(tenths.due(0.75));
  EXPECT_TRUE(always.due(0));
}

}  // namespace
}  // namespace quicksand
