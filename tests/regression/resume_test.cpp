// A flow that is handed over at any step goes on to the same bits, on any number of threads: also one that has moved to
// another grid, and one whose steps fail now and then.
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "app/grid_sequence.hpp"
#include "app/step_retry.hpp"
#include "physics/remap.hpp"
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
  const char* kind = "";  ///< where a case comes twice
  bool falters = false;   ///< every fourth step fails at first
  bool vents = false;     ///< its bubble is gone before the last step
};

/// A flow with the grids it moves through.
template <int Dim>
struct Voyage {
  GridSequence<Dim> grids;
  Flow<Dim> flow;

  explicit Voyage(const CaseConfig& config) : grids(config), flow(build_flow<Dim>(config, grids.first())) {}
  /// As the archive has it.
  Voyage(const CaseConfig& config, MemoryArchive archive)
      : grids(config),
        flow(empty_flow<Dim>(config, Domain<Dim>(stored_grid(config, archive), make_sides<Dim>(config)))) {
    grids.exchange(archive);
    flow.exchange(archive);
  }

  MemoryArchive memory() {
    MemoryArchive archive;
    for (int d = 0; d < Dim; ++d) {
      std::vector<double> faces = flow.domain().grid.global_faces(d);
      archive.exchange("grid/" + std::to_string(d), faces);
    }
    grids.exchange(archive);
    flow.exchange(archive);
    archive.rewind();
    return archive;
  }

  static Grid<Dim> stored_grid(const CaseConfig& config, MemoryArchive& archive) {
    std::array<std::vector<double>, Dim> faces;
    for (int d = 0; d < Dim; ++d) archive.exchange("grid/" + std::to_string(d), faces[static_cast<std::size_t>(d)]);
    return Grid<Dim>(std::move(faces), geometry_of(config.grid));
  }
};

/// Makes the next step fail at its first try.
template <int Dim>
void spoil_next_step(Flow<Dim>& flow) {
  flow.watch([cell = flow.domain().grid.cell(Index<Dim>{}), done = false](StepInProgress<Dim> step) mutable {
    if (step.part != 5 || done) return;
    done = true;
    step.u_bar[0][cell] = std::numeric_limits<double>::quiet_NaN();
  });
}

/// Calls after(step) for the start and for every step up to the end of the case, from wherever the flow is. \return the
/// number of steps that were tried again
template <int Dim, class After>
int march(const CaseConfig& config, Voyage<Dim>& voyage, bool falters, After&& after) {
  Flow<Dim>& flow = voyage.flow;
  TimeControl control(config.time, config.output.fields);
  control.output_due(flow.state().time);
  after(flow.state().step);
  int retries = 0;
  while (!control.finished(flow.state().time)) {
    if (std::optional<Domain<Dim>> domain = voyage.grids.next(flow)) {
      RemapReport report;
      flow = remap(flow, std::move(*domain), report);
    }
    if (falters && flow.state().step % 4 == 2) spoil_next_step(flow);
    const double dt = control.next_step(flow.state().time, flow.state().dt, stable_step(flow, control.cfl()));
    advance_with_retries(flow, dt, {.halvings = 3, .least_step = 0}, [&](const std::string&) { ++retries; });
    flow.watch({});
    control.output_due(flow.state().time);
    after(flow.state().step);
  }
  return retries;
}

/// Interrupts a flow after its start, before its last step and after random steps, and lets it go on on one or two
/// threads.
template <int Dim>
void expect_same_bits(const CaseConfig& config, const ResumedCase& resumed_case, int interruptions) {
  const bool falters = resumed_case.falters;
  Voyage<Dim> whole(config);
  std::vector<MemoryArchive> memories;
  std::vector<std::size_t> bubbles;
  const int retries = march(config, whole, falters, [&](long) {
    memories.push_back(whole.memory());
    bubbles.push_back(whole.flow.state().gas.bubbles.size());
  });
  const auto last = memories.size() - 1;
  ASSERT_GT(last, 5u);
  EXPECT_EQ(retries > 0, falters);
  if (resumed_case.vents) {
    EXPECT_GT(bubbles.front(), 0u);
    EXPECT_EQ(bubbles[last - 1], 0u);
  }
  if (!config.stages.empty() || config.regrid) {
    EXPECT_GT(whole.grids.number(), 2);
  }
  std::mt19937 random(1);
  for (int k = 0; k < interruptions; ++k) {
    const std::size_t at = k == 0   ? 0
                           : k == 1 ? last - 1
                                    : std::uniform_int_distribution<std::size_t>(1, last - 1)(random);
    SCOPED_TRACE("interrupted after step " + std::to_string(at) + " of " + std::to_string(last));
    const ThreadScope threads(k % 2 == 0 ? 1 : 2);
    Voyage<Dim> resumed(config, memories[at]);
    march(config, resumed, falters, [&](long step) {
      const MemoryArchive& expected = memories[static_cast<std::size_t>(step)];
      const MemoryArchive found = resumed.memory();
      if (!::testing::Test::HasFailure()) {
        EXPECT_EQ(differences(found, expected), "") << "after step " << step;
        EXPECT_TRUE(found == expected);
      }
    });
  }
}

std::ostream& operator<<(std::ostream& out, const ResumedCase& c) { return out << c.name << c.kind; }

class Resume : public ::testing::TestWithParam<ResumedCase> {
 protected:
  static void expect(double end, int interruptions) {
    CaseConfig config = testing::with_cfl(testing::shipped_case(GetParam().name, GetParam().settings));
    config.time.end = end;
    if (config.grid.dimension == 2) expect_same_bits<2>(config, GetParam(), interruptions);
    if (config.grid.dimension == 3) expect_same_bits<3>(config, GetParam(), interruptions);
  }
};

TEST_P(Resume, GoesOnToTheSameBits) { expect(GetParam().end, 3); }

using ResumeSlow = Resume;
TEST_P(ResumeSlow, GoesOnToTheSameBitsFromAnywhere) { expect(GetParam().full, 10); }

/// The bubble outgrows its first grid, and a stage ends.
const std::vector<std::string> through_grids = {
    "bubbles.0.pressure=400", "regrid={bubble_cells: 10}",
    "stages=[{until: 0.33, grid: {x: {from: 0, to: 6.25, cells: 50}, z: {from: 0, to: 6.25, cells: 50}}}]"};

/// A bubble in a thin shell, which it soon breaks.
const std::vector<std::string> vents = {"initial.0.shape.sphere.radius=2", "bubbles.0.pressure=40"};

const ResumedCase cases[] = {
    {"slug/case_e", 0.2, 1.0, {}},
    {"slug/case_e_bingham", 0.08, 0.6, {}},
    {"bubbles/free_ball", 0.1, 1.0, {}},
    {"slug/case_e_3d", 0.006, 0.2, {}},
    {"channel/poiseuille", 0.3, 2.0, {}},
    {"slug/case_d", 0.2, 1.0, {"trapped_gas.adiabatic=true"}},
    {"bubbles/free_ball", 0.36, 1.2, through_grids, "_through_grids"},
    {"bubbles/free_disc", 0.75, 0.9, vents, "_that_vents", false, true},
    {"slug/case_e_bingham", 0.06, 0.3, {}, "_falters", true},
};

std::string name_of(const ::testing::TestParamInfo<ResumedCase>& info) {
  std::string name = std::string(info.param.name) + info.param.kind;
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Cases, Resume, ::testing::ValuesIn(cases), name_of);
INSTANTIATE_TEST_SUITE_P(Cases, ResumeSlow, ::testing::ValuesIn(cases), name_of);

}  // namespace
}  // namespace quicksand
