#pragma once
/// \file
/// Measured figures that tests bound and that the page of verification shows: one call does both.
///
/// Where the environment variable QUICKSAND_FIGURES names a file, each figure is appended to it as a line of the fields
/// test, case, quantity, measured, kind, reference, bound, source, separated by tabs; `tools/docs --verification` makes
/// the page.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

namespace quicksand::testing {

/// What is measured.
struct Figure {
  std::string of;        ///< the case and its grid
  std::string quantity;  ///< with its unit where it has one
  std::string source{};  ///< of the reference
};

/// Where a figure is expected. (clang 14 has no std::source_location.)
struct Where {
  const char* file;
  int line;
  static Where current(const char* file = __builtin_FILE(), int line = __builtin_LINE()) { return {file, line}; }
};

inline void record(const Figure& figure, double measured, const char* kind, double reference, double bound) {
  const char* path = std::getenv("QUICKSAND_FIGURES");
  if (path == nullptr) return;
  const ::testing::TestInfo* test = ::testing::UnitTest::GetInstance()->current_test_info();
  std::ostringstream line;
  line.precision(10);
  line << test->test_suite_name() << "." << test->name() << '\t' << figure.of << '\t' << figure.quantity << '\t'
       << measured << '\t' << kind << '\t' << reference << '\t' << bound << '\t' << figure.source << '\n';
  // Tests run side by side: one write per line.
  std::ofstream(path, std::ios::app) << line.str() << std::flush;
}

/// |measured / reference - 1| <= bound
inline void expect_relative(const Figure& figure, double measured, double reference, double bound,
                            Where where = Where::current()) {
  const ::testing::ScopedTrace trace(where.file, where.line, figure.quantity);
  record(figure, measured, "relative", reference, bound);
  EXPECT_LE(std::abs(measured / reference - 1), bound) << figure.of << ": " << measured << " for " << reference;
}

/// |measured - reference| <= bound
inline void expect_absolute(const Figure& figure, double measured, double reference, double bound,
                            Where where = Where::current()) {
  const ::testing::ScopedTrace trace(where.file, where.line, figure.quantity);
  record(figure, measured, "absolute", reference, bound);
  EXPECT_NEAR(measured, reference, bound) << figure.of;
}

/// An error or anything else that must not exceed a bound.
inline void expect_at_most(const Figure& figure, double measured, double bound, Where where = Where::current()) {
  const ::testing::ScopedTrace trace(where.file, where.line, figure.quantity);
  record(figure, measured, "at most", 0, bound);
  EXPECT_LE(measured, bound) << figure.of;
}

/// An order of convergence or anything else that must reach a bound.
inline void expect_at_least(const Figure& figure, double measured, double bound, Where where = Where::current()) {
  const ::testing::ScopedTrace trace(where.file, where.line, figure.quantity);
  record(figure, measured, "at least", 0, bound);
  EXPECT_GE(measured, bound) << figure.of;
}

/// Order of convergence between two grids, one with half the cell width of the other.
inline void expect_order(const Figure& figure, double coarse_error, double fine_error, double bound,
                         Where where = Where::current()) {
  expect_at_least({figure.of, figure.quantity + ", order", figure.source}, std::log2(coarse_error / fine_error), bound,
                  where);
}

}  // namespace quicksand::testing
