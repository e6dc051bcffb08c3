// A flow that is handed over at any step goes on to the same bits, on any number of threads.
#include <gtest/gtest.h>

#include <random>

#include "support/cases.hpp"
#include "support/memory_archive.hpp"

namespace quicksand {
namespace {

using testing::MemoryArchive;

struct ResumedCase {
  const char* name;
  double end;   ///< of the quick test
  double full;  ///< of the slow one
  std::vector<std::string> settings;
};

/// Calls after(step) for the start and for every step up to the end of the case, from wherever the flow is.
template <int Dim, class After>
void march(const CaseConfig& config, Flow<Dim>& flow, After&& after) {
  TimeControl control(config.time, config.output.fields);
  control.output_due(flow.state().time);
  after(flow.state().step);
  while (!control.finished(flow.state().time)) {
    const double stable = stable_step(flow, control.cfl());
    flow.advance(control.next_step(flow.state().time, flow.state().dt, stable));
    control.output_due(flow.state().time);
    after(flow.state().step);
  }
}

template <int Dim>
MemoryArchive memory_of(Flow<Dim>& flow) {
  MemoryArchive archive;
  flow.exchange(archive);
  archive.rewind();
  return archive;
}

/// Interrupts a flow after its start and after random steps, and lets it go on on one or two threads.
template <int Dim>
void expect_same_bits(const CaseConfig& config, int interruptions) {
  Flow<Dim> whole = build_flow<Dim>(config);
  std::vector<MemoryArchive> memories;
  march(config, whole, [&](long) { memories.push_back(memory_of(whole)); });
  const auto last = memories.size() - 1;
  ASSERT_GT(last, 5u);
  std::mt19937 random(1);
  for (int k = 0; k < interruptions; ++k) {
    const std::size_t at = k == 0 ? 0 : std::uniform_int_distribution<std::size_t>(1, last - 1)(random);
    SCOPED_TRACE("interrupted after step " + std::to_string(at) + " of " + std::to_string(last));
    const testing::Threads threads(k % 2 == 0 ? 1 : 2);
    Flow<Dim> resumed = empty_flow<Dim>(config, Domain<Dim>(make_grid<Dim>(config.grid), make_sides<Dim>(config)));
    MemoryArchive archive = memories[at];
    resumed.exchange(archive);
    march(config, resumed, [&](long step) {
      const MemoryArchive& expected = memories[static_cast<std::size_t>(step)];
      const MemoryArchive found = memory_of(resumed);
      if (!::testing::Test::HasFailure()) {
        EXPECT_EQ(differences(found, expected), "") << "after step " << step;
        EXPECT_TRUE(found == expected);
      }
    });
  }
}

class Resume : public ::testing::TestWithParam<ResumedCase> {
 protected:
  static void expect(double end, int interruptions) {
    CaseConfig config = testing::with_cfl(testing::shipped_case(GetParam().name, GetParam().settings));
    config.time.end = end;
    if (config.grid.dimension == 2) expect_same_bits<2>(config, interruptions);
    if (config.grid.dimension == 3) expect_same_bits<3>(config, interruptions);
  }
};

TEST_P(Resume, GoesOnToTheSameBits) { expect(GetParam().end, 2); }

using ResumeSlow = Resume;
TEST_P(ResumeSlow, GoesOnToTheSameBitsFromAnywhere) { expect(GetParam().full, 10); }

const ResumedCase cases[] = {
    {"slug/case_e", 0.2, 1.0, {}},        {"slug/case_e_bingham", 0.08, 0.6, {}},
    {"bubbles/free_ball", 0.1, 1.0, {}},  {"slug/case_e_3d", 0.006, 0.2, {}},
    {"channel/poiseuille", 0.3, 2.0, {}}, {"slug/case_d", 0.2, 1.0, {"trapped_gas.adiabatic=true"}},
};

std::string name_of(const ::testing::TestParamInfo<ResumedCase>& info) {
  std::string name = info.param.name;
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Cases, Resume, ::testing::ValuesIn(cases), name_of);
INSTANTIATE_TEST_SUITE_P(Cases, ResumeSlow, ::testing::ValuesIn(cases), name_of);

}  // namespace
}  // namespace quicksand
