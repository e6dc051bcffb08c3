// The command line: what is read from the arguments and what the commands that run nothing print.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "app/case_warnings.hpp"
#include "app/command_line.hpp"
#include "app/output_folder.hpp"
#include "config_test_case.hpp"

namespace quicksand {
namespace {

namespace fs = std::filesystem;

/// An empty folder that goes away with the test.
class CommandLineFolder : public testing::Test {
 protected:
  CommandLineFolder()
      : folder_(fs::path(testing::TempDir()) /
                (std::string("quicksand_cli_") + testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~CommandLineFolder() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }

  fs::path folder_;
};

std::string message(const std::vector<std::string>& arguments) {
  try {
    parse_command_line(arguments);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

std::string output_of(const std::vector<std::string>& arguments) {
  std::ostringstream out;
  std::ostringstream err;
  EXPECT_EQ(execute(parse_command_line(arguments), out, err), 0);
  EXPECT_EQ(err.str(), "");
  return out.str();
}

TEST(CommandLineArguments, Run) {
  const CommandLine line = parse_command_line({"run", "--set", "time.end=1", "case.yaml", "--set=gravity=2", "--output",
                                               "out", "--threads=3", "--overwrite", "--quiet"});
  EXPECT_EQ(line.command, Command::run);
  EXPECT_EQ(line.path, "case.yaml");
  EXPECT_EQ(line.settings, (std::vector<std::string>{"time.end=1", "gravity=2"}));
  EXPECT_EQ(line.output, "out");
  EXPECT_EQ(line.run.threads, 3);
  EXPECT_TRUE(line.overwrite);
  EXPECT_TRUE(line.run.quiet);
}

TEST(CommandLineArguments, FileThatLooksLikeAnOption) {
  EXPECT_EQ(parse_command_line({"check", "--", "--odd.yaml"}).path, "--odd.yaml");
}

TEST(CommandLineArguments, HelpIsFoundEverywhere) {
  EXPECT_EQ(parse_command_line({"--help"}).command, Command::help);
  EXPECT_EQ(parse_command_line({"run", "--help"}).command, Command::help);
  EXPECT_EQ(parse_command_line({"--version"}).command, Command::version);
}

TEST(CommandLineArguments, MistakesAreNamed) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> mistakes = {
      {{}, "no command"},
      {{"rnu", "case.yaml"}, "unknown command 'rnu'; did you mean 'run'?"},
      {{"run"}, "'run' needs a case file"},
      {{"run", "a.yaml", "b.yaml"}, "takes one path, but got 'a.yaml' and 'b.yaml'"},
      {{"run", "a.yaml", "--outptu", "x"}, "unknown option --outptu for 'run'; did you mean '--output'?"},
      {{"check", "a.yaml", "--quiet"}, "unknown option --quiet for 'check'"},
      {{"run", "a.yaml", "--set"}, "--set needs a value"},
      {{"run", "a.yaml", "--threads", "0"}, "whole number from 1"},
      {{"run", "a.yaml", "--threads", "two"}, "not 'two'"},
      {{"run", "a.yaml", "--overwrite=yes"}, "--overwrite takes no value"},
      {{"run", "a.yaml", "--output="}, "--output must not be empty"},
      {{"schema", "x"}, "'schema' takes no argument"},
  };
  for (const auto& [arguments, part] : mistakes) EXPECT_NE(message(arguments).find(part), std::string::npos) << part;
}

TEST_F(CommandLineFolder, ShowPrintsACaseThatReadsBack) {
  const std::string file = write("case.yaml", valid_case);
  const std::string shown = output_of({"show", file, "--set", "time.end=3"});
  EXPECT_EQ(parse_case(shown, "shown").time.end, 3);
  EXPECT_EQ(output_of({"show", write("shown.yaml", shown)}), shown);
}

TEST_F(CommandLineFolder, CheckPrintsTheCaseInNumbers) {
  const std::string text = output_of({"check", write("case.yaml", valid_case)});
  for (const std::string part :
       {"A test", "axisymmetric", "16 x 48 = 768", "0.03125", "sand: density 2", "initial volume 0.1963", "8000 steps",
        "results/test", "species water is not present at the start"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
}

TEST_F(CommandLineFolder, CheckThrowsOnABadCase) {
  std::ostringstream out;
  const CommandLine line = parse_command_line({"check", write("case.yaml", with("cells: 16", "cells: 0"))});
  EXPECT_THROW(execute(line, out, out), InputError);
}

TEST_F(CommandLineFolder, CheckPrintsTheFirstStepByCflNumber) {
  const std::string text =
      output_of({"check", write("case.yaml", valid_case), "--set", "time={end: 1, cfl: 0.5, max_step: 0.01}"});
  EXPECT_NE(text.find("CFL number 0.5, at most 0.01; first 0.001\n"), std::string::npos) << text;
}

TEST_F(CommandLineFolder, CheckPrintsTheNumbersOfAGridThatIsTooLarge) {
  const std::string text = output_of(
      {"check", write("case.yaml", valid_case), "--set", "grid.x.cells=40000", "--set", "grid.z.cells=40000"});
  for (const std::string part : {"40000 x 40000 = 1600000000", "1.25e-05", "sand: density 2", "the run needs about"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
}

TEST(CommandLineWarnings, LiquidNearAnOpenSide) {
  const CaseConfig config = parse_case(valid_case, "case.yaml", {"initial.0.shape.cylinder.height=1.49"});
  const CaseWarnings warnings = case_warnings(config);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[1].message.find("less than 2 cells from the open side z_max"), std::string::npos);
}

TEST_F(CommandLineFolder, CheckWarnsAtThePlaceAndFailsWhereItIsStrict) {
  const std::string file = write("case.yaml", valid_case);
  const std::string text = output_of({"check", file});
  EXPECT_NE(text.find("warning        " + file + ":19:5: species[1]: "), std::string::npos) << text;
  std::ostringstream out;
  EXPECT_EQ(execute(parse_command_line({"check", file}), out, out), 0);
  EXPECT_EQ(execute(parse_command_line({"check", file, "--strict"}), out, out), 2);
  out.str("");
  execute(parse_command_line({"check", file, "--set", "time.step=0.5"}), out, out);
  EXPECT_NE(out.str().find("--set time.step=0.5: time.step: is 0.5"), std::string::npos) << out.str();
}

TEST_F(CommandLineFolder, ShowExplainsCasesAndKeys) {
  const std::string file = write("case.yaml", valid_case);
  EXPECT_NE(output_of({"show", file, "--explain"}).find("# mass per volume"), std::string::npos);
  EXPECT_NE(output_of({"show", "--explain"}).find("# A case to begin with"), std::string::npos);
  EXPECT_EQ(output_of({"show", "--explain", "time.cfl"}), output_of({"show", "--explain=cfl"}));
  EXPECT_EQ(output_of({"schema", "--markdown"}).rfind("# Keys of the case file", 0), 0u);
  EXPECT_THROW(output_of({"show", "--explain", "time.clf"}), InputError);
  EXPECT_THROW(output_of({"show", "--explain", "missing.yaml"}), InputError);
  EXPECT_THROW(output_of({"show", file, "--explain=cfl"}), InputError);
}

TEST(CommandLineText, VersionHelpAndSchema) {
  EXPECT_EQ(output_of({"--version"}).rfind("quicksand ", 0), 0u);
  EXPECT_NE(output_of({"--version"}).find("hypre "), std::string::npos);
  EXPECT_NE(output_of({"--help"}).find("quicksand run CASE.yaml"), std::string::npos);
  EXPECT_EQ(output_of({"schema"}).front(), '{');
}

TEST(CommandLineText, HelpOnACommandNamesItsOptions) {
  for (const CommandHelp& command : command_table()) {
    const std::string help = output_of({command.name, "--help"});
    EXPECT_NE(output_of({"--help"}).find(std::string("quicksand ") + command.name), std::string::npos);
    if (command.command == Command::help) continue;
    EXPECT_EQ(help, output_of({"help", command.name}));
    EXPECT_EQ(help.rfind(std::string("quicksand ") + command.name + ":", 0), 0u) << help;
    for (const OptionHelp& option : command.options) EXPECT_NE(help.find(option.name), std::string::npos) << help;
  }
  EXPECT_NE(message({"help", "rnu"}).find("did you mean 'run'?"), std::string::npos);
}

TEST(CommandLineText, ManualPageHoldsEveryCommandAndNoWideLineOfHelp) {
  const std::string page = output_of({"manual"});
  for (const CommandHelp& command : command_table()) {
    EXPECT_NE(page.find(std::string(".SS ") + command.name), std::string::npos) << command.name;
  }
  std::istringstream lines(output_of({"--help"}));
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 92u) << line;
}

TEST_F(CommandLineFolder, InfoOnAResultFolder) {
  EXPECT_THROW(output_of({"info", folder_.string()}), FileError);
  EXPECT_THROW(output_of({"info", (folder_ / "none").string()}), FileError);
  write("case.yaml", valid_case);
  EXPECT_NE(output_of({"info", folder_.string()}).find("not finished"), std::string::npos);
  write("summary.json", "{\"status\": \"finished\"}\n");
  const std::string text = output_of({"info", folder_.string()});
  EXPECT_NE(text.find("A test"), std::string::npos);
  EXPECT_NE(text.find("\"finished\""), std::string::npos);
}

TEST_F(CommandLineFolder, OutputFolderIsMadeAndGuarded) {
  const fs::path results = folder_ / "deep" / "results";
  prepare_output_folder(results.string(), false);
  EXPECT_TRUE(fs::is_empty(results));
  prepare_output_folder(results.string(), false);
  std::ofstream(results / "history.csv") << "step\n";
  std::ofstream(results / "fields_000001.h5") << "x";
  std::ofstream(results / "notes.txt") << "mine";
  EXPECT_THROW(prepare_output_folder(results.string(), false), InputError);
  EXPECT_TRUE(fs::exists(results / "history.csv"));
  prepare_output_folder(results.string(), true);
  EXPECT_FALSE(fs::exists(results / "history.csv"));
  EXPECT_FALSE(fs::exists(results / "fields_000001.h5"));
  EXPECT_TRUE(fs::exists(results / "notes.txt")) << "only results are removed";
  EXPECT_THROW(prepare_output_folder((results / "notes.txt").string(), true), FileError);
}

TEST_F(CommandLineFolder, CaseFileIsNotWrittenOver) {
  const std::string file = write("case.yaml", valid_case);
  std::ostringstream out;
  EXPECT_THROW(execute(parse_command_line({"run", file, "--output", folder_.string(), "--overwrite"}), out, out),
               InputError);
  EXPECT_TRUE(fs::exists(file));
  EXPECT_THROW(protect_case_file(file, (folder_ / "").string()), InputError);
  EXPECT_NO_THROW(protect_case_file(file, (folder_ / "results").string()));
  EXPECT_NO_THROW(protect_case_file(write("mine.yaml", valid_case), folder_.string()));
  fs::create_symlink(file, folder_ / "link.yaml");
  EXPECT_THROW(protect_case_file((folder_ / "link.yaml").string(), folder_.string()), InputError);
}

}  // namespace
}  // namespace quicksand
