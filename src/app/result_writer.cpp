#include "app/result_writer.hpp"

#include "core/atomic_file.hpp"
#include "physics/stress.hpp"

namespace quicksand {

namespace {

std::vector<std::string> history_columns(const CaseConfig& config) {
  std::vector<std::string> columns = {"step", "time", "dt"};
  for (const Species& s : config.species) columns.push_back("volume_" + s.name);
  for (const char* name : {"kinetic_energy",
                           "potential_energy",
                           "max_speed",
                           "max_speed_liquid",
                           "height_axis",
                           "height_max",
                           "radius_base",
                           "bubbles",
                           "bubble_volume",
                           "bubble_pressure",
                           "bubble_z",
                           "redistribution_energy_change",
                           "projection_energy_change",
                           "gas_work",
                           "iterations_mac_projection",
                           "iterations_redistribute_volume",
                           "iterations_redistribute_momentum",
                           "iterations_diffusion",
                           "iterations_diffusion_linear",
                           "iterations_projection"}) {
    columns.emplace_back(name);
  }
  return columns;
}

/// Mean of the pressures at a cell's corners.
template <int Dim>
CellField cell_pressure(const Grid<Dim>& grid, const NodeField& pressure) {
  CellField mean(grid.layout());
  for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c) {
    double total = 0;
    for (int k = 0; k < (1 << Dim); ++k) {
      Node n = low_node(c);
      for (int d = 0; d < Dim; ++d) {
        if ((k >> d) & 1) n = n + grid.step(d);
      }
      total += pressure[n];
    }
    mean[c] = total / (1 << Dim);
  });
  return mean;
}

}  // namespace

template <int Dim>
ResultWriter<Dim>::ResultWriter(const CaseConfig& config, std::filesystem::path folder,
                                std::optional<std::int64_t> last_step)
    : config_(config), folder_(std::move(folder)), series_(folder_) {
  write_text_file(folder_ / "case.yaml", to_yaml(config));
  if (last_step) series_.write();
  if (config.output.history) history_.emplace(folder_ / "history.csv", history_columns(config), last_step);
  const bool bubbles = !config.bubbles.empty() || !config.charges.empty() || config.trapped_gas.adiabatic;
  if (config.output.history && bubbles) bubbles_.emplace(folder_, last_step);
  if (config.output.crater) crater_.emplace(config, folder_, last_step);
}

template <int Dim>
FieldSnapshot ResultWriter<Dim>::snapshot(const Flow<Dim>& flow, const State<Dim>& state) const {
  const Grid<Dim>& grid = flow.domain().grid;
  FieldSnapshot s;
  s.title = config_.title;
  s.units = config_.units == UnitSystem::si ? "SI" : "none";
  s.geometry = geometry_name(grid.geometry());
  s.step = state.step;
  s.time = state.time;
  s.dt = state.dt;
  s.axes = snapshot_axes(grid);
  const auto add = [&](const std::string& name, const CellField& field) {
    s.fields.push_back({name, 1, owned_values(grid, field)});
  };
  for (std::size_t i = 0; i < state.phi.size(); ++i) add("phi_" + config_.species[i].name, state.phi[i]);
  CellField density(grid.layout());
  mix_density(grid, config_.species, state.phi, density);
  add("density", density);
  s.fields.push_back({"velocity", Dim, owned_values(grid, state.u)});
  add("pressure", cell_pressure(grid, state.pressure));
  return s;
}

template <int Dim>
FieldSnapshot ResultWriter<Dim>::snapshot(const Flow<Dim>& flow) const {
  const Grid<Dim>& grid = flow.domain().grid;
  FieldSnapshot s = snapshot(flow, flow.state());
  const auto add = [&](const std::string& name, const CellField& field) {
    s.fields.push_back({name, 1, owned_values(grid, field)});
  };
  add("gas_region", gas_region_field(flow));
  const StressFields stress = evaluate_stress(flow);
  add("viscosity", stress.viscosity);
  add("stress_magnitude", stress.magnitude);
  add("unyielded", stress.unyielded);
  return s;
}

template <int Dim>
std::filesystem::path ResultWriter<Dim>::write_fields(const Flow<Dim>& flow) {
  std::filesystem::path file = folder_ / fields_file_name(flow.state().step);
  quicksand::write_fields(file, snapshot(flow));
  series_.add(file);
  return file;
}

template <int Dim>
std::vector<std::filesystem::path> ResultWriter<Dim>::write_failed_step(const Flow<Dim>& flow) {
  std::vector<std::filesystem::path> files;
  const auto write = [&](const State<Dim>& state, const FieldSnapshot& fields) {
    files.push_back(folder_ / ("failed_" + fields_file_name(state.step)));
    quicksand::write_fields(files.back(), fields);
  };
  write(flow.state(), snapshot(flow));
  if (const State<Dim>* attempt = flow.failed_attempt()) write(*attempt, snapshot(flow, *attempt));
  return files;
}

template <int Dim>
void ResultWriter<Dim>::append_history(const Flow<Dim>& flow, const Diagnostics& diagnostics,
                                       const StepReport& report) {
  if (crater_) crater_->append_when_due(flow);
  if (!history_) return;
  const State<Dim>& state = flow.state();
  std::vector<double> line = {static_cast<double>(state.step), state.time, state.dt};
  line.insert(line.end(), diagnostics.volume.begin(), diagnostics.volume.end());
  int obstacle = 0;
  for (const ObstacleReport& o : report.obstacle) obstacle += o.iterations;
  const std::vector<BubbleMeasures<Dim>> bubbles = measure_bubbles(flow);
  BubbleMeasures<Dim> largest{};
  for (const BubbleMeasures<Dim>& b : bubbles) largest = b.volume > largest.volume ? b : largest;
  line.insert(line.end(), {diagnostics.kinetic_energy,
                           diagnostics.potential_energy,
                           diagnostics.max_speed,
                           diagnostics.max_speed_liquid,
                           diagnostics.height_axis,
                           diagnostics.height_max,
                           diagnostics.radius_base,
                           static_cast<double>(bubbles.size()),
                           largest.volume,
                           largest.pressure,
                           largest.centroid[Dim - 1],
                           report.redistribution_energy_change,
                           report.projection_energy_change,
                           report.gas_work,
                           static_cast<double>(report.mac.iterations),
                           static_cast<double>(obstacle),
                           static_cast<double>(report.momentum.iterations),
                           static_cast<double>(report.diffusion.iterations),
                           static_cast<double>(report.diffusion.linear_iterations),
                           static_cast<double>(report.projection.iterations)});
  history_->append(line);
  if (bubbles_) bubbles_->append(state, bubbles, report.gas, full_circle(flow.domain().grid));
}

template <int Dim>
void ResultWriter<Dim>::append_crater(const Flow<Dim>& flow) {
  if (crater_) crater_->append(flow);
}

template <int Dim>
void ResultWriter<Dim>::sync() const {
  if (history_) history_->sync();
  if (bubbles_) bubbles_->sync();
  if (crater_) crater_->sync();
}

template <int Dim>
void ResultWriter<Dim>::write_summary(const Json& summary) {
  write_text_file(folder_ / "summary.json", summary.text());
}

template class ResultWriter<2>;
template class ResultWriter<3>;

}  // namespace quicksand
