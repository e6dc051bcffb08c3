#include "app/crater_writer.hpp"

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "physics/crater.hpp"

namespace quicksand {

namespace {

/// A step that ends this close before a multiple of the interval, relative to it, has reached it.
constexpr double slack = 1e-9;

std::vector<std::string> crater_columns(int dimension) {
  if (dimension == 3) {
    return {"step",           "time",           "level",        "depth",        "deepest_x",
            "deepest_y",      "width_x",        "width_y",      "volume",       "open_depth",
            "open_deepest_x", "open_deepest_y", "open_width_x", "open_width_y", "open_volume",
            "lip_height",     "lip_x",          "lip_y",        "volume_of_lip"};
  }
  return {"step",       "time",           "level",      "depth",       "deepest_x",  "width", "volume",
          "open_depth", "open_deepest_x", "open_width", "open_volume", "lip_height", "lip_x", "volume_of_lip"};
}

std::vector<std::string> profile_columns(int dimension) {
  if (dimension == 3) return {"step", "time", "x", "y", "surface", "top"};
  return {"step", "time", "x", "surface", "top"};
}

/// What the last line of crater.csv begins with.
struct LastLine {
  long step = -1;
  double time = 0;
  std::optional<double> level{};  ///< none where there is no line
};

LastLine read_last_line(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);  // the names of the columns
  LastLine last;
  char comma = 0;
  while (std::getline(in, line)) {
    std::istringstream numbers(line);
    double level = 0;
    if (numbers >> last.step >> comma >> last.time >> comma >> level) last.level = level;
  }
  return last;
}

/// One line per column of the profile.
template <int Dim>
std::vector<std::vector<double>> profile_lines(const BedProfile<Dim>& profile, long step, double time) {
  std::vector<std::vector<double>> lines;
  for (std::size_t n = 0; n < profile.surface.size(); ++n) {
    std::vector<double>& line = lines.emplace_back(std::vector<double>{static_cast<double>(step), time});
    for (std::size_t rest = n, d = 0; d + 1 < Dim; ++d) {
      const std::vector<double>& centre = profile.axes[d].centre;
      line.push_back(centre[rest % centre.size()]);
      rest /= centre.size();
    }
    line.insert(line.end(), {profile.surface[n], profile.top[n]});
  }
  return lines;
}

}  // namespace

template <int Dim>
CraterWriter<Dim>::CraterWriter(const CaseConfig& config, const std::filesystem::path& folder,
                                std::optional<std::int64_t> last_step)
    : settings_(*config.output.crater),
      crater_(folder / "crater.csv", crater_columns(Dim), last_step),
      profiles_(folder / "crater_profiles.csv", profile_columns(Dim), last_step),
      level_(settings_.level) {
  for (const std::string& name : settings_.species) species_.push_back(species_number(config, name));
  if (!last_step) return;
  const LastLine last = read_last_line(folder / "crater.csv");
  last_step_ = last.step;
  last_time_ = last.time;
  if (!level_) level_ = last.level;
}

template <int Dim>
void CraterWriter<Dim>::append(const Flow<Dim>& flow) {
  const State<Dim>& state = flow.state();
  if (state.step == last_step_) return;
  CellField bed = state.phi[species_.front()];
  for (std::size_t n = 1; n < species_.size(); ++n) {
    const CellField& more = state.phi[species_[n]];
    for_each<Cell>(flow.domain().layout(), flow.domain().grid.cells(), [&](Cell c) { bed[c] += more[c]; });
  }
  const BedProfile<Dim> profile = bed_profile(flow.domain(), bed);
  if (!level_) level_ = median_height(profile);
  const Crater<Dim> crater = measure_crater(profile, *level_);

  std::vector<double> line = {static_cast<double>(state.step), state.time, *level_};
  const auto add = [&line](const Vec<Dim - 1>& v) { line.insert(line.end(), v.v, v.v + Dim - 1); };
  for (const Hollow<Dim>& hollow : {crater.whole, crater.open}) {
    line.push_back(hollow.depth);
    add(hollow.deepest);
    add(hollow.width);
    line.push_back(hollow.volume);
  }
  line.push_back(crater.lip_height);
  add(crater.lip);
  line.push_back(crater.volume_of_lip);
  profiles_.append_lines(profile_lines(profile, state.step, state.time));
  crater_.append(line);
  last_step_ = state.step;
  last_time_ = state.time;
}

template <int Dim>
void CraterWriter<Dim>::append_when_due(const Flow<Dim>& flow) {
  if (!settings_.every) return;
  const auto intervals = [&](double time) { return std::floor(time / *settings_.every + slack); };
  if (intervals(flow.state().time) > intervals(last_time_)) append(flow);
}

template <int Dim>
void CraterWriter<Dim>::sync() const {
  crater_.sync();
  profiles_.sync();
}

template class CraterWriter<2>;
template class CraterWriter<3>;

}  // namespace quicksand
