// JSON documents and CSV tables.
#include <limits>
#include <vector>

#include "core/errors.hpp"
#include "core/text_output.hpp"
#include "unit/output_test_folder.hpp"

namespace quicksand {
namespace {

using CsvTest = FolderTest;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Json, EscapesText) {
  EXPECT_EQ(json_quoted("plain"), "\"plain\"");
  EXPECT_EQ(json_quoted("a\"b\\c\nd\te\r"), R"("a\"b\\c\nd\te\r")");
  EXPECT_EQ(json_quoted(std::string("\x01\x1f", 2)), R"("\u0001\u001f")");
  EXPECT_EQ(json_quoted("Grüße"), "\"Grüße\"");
}

TEST(Json, NumbersReadBackAndNonFiniteOnesAreNull) {
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(-3.0), "-3");
  EXPECT_EQ(std::stod(number_text(1.0 / 3.0)), 1.0 / 3.0);
  EXPECT_EQ(Json(nan).text(), "null\n");
  EXPECT_EQ(Json(-infinity).text(), "null\n");
  EXPECT_EQ(Json(std::size_t{3}).text(), "3\n");
  EXPECT_EQ(Json(true).text(), "true\n");
}

TEST(Json, KeepsTheOrderOfMembers) {
  Json json;
  json["status"] = "finished";
  json["phases"]["projection"]["seconds"] = 1.5;
  json["phases"]["diffusion"] = Json::object();
  json["cells"] = std::vector<int>{16, 48};
  json["empty"] = Json::array();
  json["events"].append("start");
  json["events"].append(Json());
  json["status"] = "stopped";
  EXPECT_EQ(json.text(), R"({
  "status": "stopped",
  "phases": {
    "projection": {
      "seconds": 1.5
    },
    "diffusion": {}
  },
  "cells": [16, 48],
  "empty": [],
  "events": ["start", null]
}
)");
}

TEST_F(CsvTest, EveryLineIsInTheFileAtOnce) {
  CsvWriter table(path("history.csv"), {"step", "time"});
  EXPECT_EQ(content(path("history.csv")), "step,time\n");
  table.append(std::vector<double>{1, 0.1});
  EXPECT_EQ(content(path("history.csv")), "step,time\n1,0.1\n");
  table.append(std::vector<double>{2, nan});
  EXPECT_EQ(content(path("history.csv")), "step,time\n1,0.1\n2,nan\n");
}

TEST_F(CsvTest, ContinuesAfterTheCheckpoint) {
  std::ofstream(path("history.csv")) << "step,time\n1,0.1\n2,0.2\n3,0.3\n4,0.";
  CsvWriter table(path("history.csv"), {"step", "time"}, 2);
  table.append(std::vector<double>{3, 0.25});
  EXPECT_EQ(content(path("history.csv")), "step,time\n1,0.1\n2,0.2\n3,0.25\n");
}

TEST_F(CsvTest, ContinuingWhatIsNotThereStartsIt) {
  const CsvWriter table(path("history.csv"), {"step", "time"}, 2);
  EXPECT_EQ(content(path("history.csv")), "step,time\n");
}

TEST_F(CsvTest, RefusesOtherColumns) {
  std::ofstream(path("history.csv")) << "step,mass\n1,0.1\n";
  EXPECT_THROW(CsvWriter(path("history.csv"), {"step", "time"}, 2), FileError);
  EXPECT_EQ(content(path("history.csv")), "step,mass\n1,0.1\n");
}

}  // namespace
}  // namespace quicksand
