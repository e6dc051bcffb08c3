#include "physics/convection.hpp"

#include <algorithm>
#include <cmath>

#include "core/slope.hpp"

namespace quicksand {

namespace {

/// Momentum of less mass than this, relative to a full cell's, is what rounding left of a cell that emptied.
constexpr double rounded_off = 1e-16;

/// Cells with less liquid move ballistically: no slopes, no acceleration in the predictor.
constexpr double ballistic_fraction = 0.5;

/// The slopes that the predictor may use in a cell.
template <int Dim>
class Reconstruction {
 public:
  Reconstruction(const Grid<Dim>& grid, const CellField& total) : grid_(grid), total_(total) {}

  bool ballistic(Cell c) const { return total_[c] < ballistic_fraction; }
  /// The velocity of an empty neighbour means nothing.
  double velocity_slope(const CellField& q, Cell c, const Index<Dim>& i, int d) const {
    const Step e = grid_.step(d);
    const bool apart = total_[c - e] < empty_fraction || total_[c + e] < empty_fraction;
    return ballistic(c) || apart ? 0 : limited_slope(grid_, q, c, i, d);
  }
  /// Half-time velocity component on the face of c along d; side +1 high, -1 low.
  double face_velocity(const CellField& u_half, const CellField& u, Cell c, const Index<Dim>& i, int d,
                       int side) const {
    return u_half[c] + 0.5 * side * grid_.width_1d(d, i[d]) * velocity_slope(u, c, i, d);
  }
  /// The same from the cell below and the cell above a face, i being the index of the one above.
  double from_low(const CellField& u_half, const CellField& u, Face f, const Index<Dim>& i, int d) const {
    return face_velocity(u_half, u, high_cell(f) - grid_.step(d), shifted(i, d, -1), d, 1);
  }
  double from_high(const CellField& u_half, const CellField& u, Face f, const Index<Dim>& i, int d) const {
    return face_velocity(u_half, u, high_cell(f), i, d, -1);
  }

 private:
  const Grid<Dim>& grid_;
  const CellField& total_;
};

/// Face velocity from the two sides' states: an empty side has no say, liquid against liquid goes upwind of the
/// sqrt(rho)-weighted mean, and states that part leave the face at rest.
double upwind(double u_low, double u_high, double rho_low, double rho_high, bool low_empty, bool high_empty) {
  if (low_empty && high_empty) return 0;
  if (low_empty) return u_high;
  if (high_empty) return u_low;
  if (u_low < 0 && u_high > 0) return 0;
  const double a = std::sqrt(std::max(rho_low, 0.0));
  const double b = std::sqrt(std::max(rho_high, 0.0));
  // Colliding states: continuous in both, and 0 where they are equal and opposite, so that round-off never picks a
  // side.
  if (u_low > 0 && u_high < 0) return (a * u_low * u_low - b * u_high * u_high) / (a * u_low - b * u_high);
  return u_low > 0 ? u_low : u_high;
}

/// -dt/2 (u . grad) q in the cell.
template <int Dim, class Slope>
double advect_half(const CellVectors<Dim>& u, Cell c, double dt, Slope&& slope_along) {
  double change = 0;
  for (int d = 0; d < Dim; ++d) change -= 0.5 * dt * u[d][c] * slope_along(d);
  return change;
}

/// Whether a face lies on an inflow side, where velocity is given.
template <int Dim>
bool on_inflow(const Domain<Dim>& domain, Cell low, Cell high) {
  return domain.beyond[low] == Beyond::inflow || domain.beyond[high] == Beyond::inflow;
}

/// Normal velocities on the faces of inflow sides.
template <int Dim>
void impose_inflow(const Domain<Dim>& domain, FaceScalars<Dim>& u_mac) {
  const Grid<Dim>& grid = domain.grid;
  for (int d = 0; d < Dim; ++d) {
    for (int s = 0; s < 2; ++s) {
      if (domain.sides.at(d, s).kind != SideKind::inflow) continue;
      for_each<Face>(
          domain.layout(), intersect(domain.side_faces(d, s), grid.faces(d)),
          [&](Face f, const Index<Dim>& i) { u_mac[d][f] = domain.side_velocities.at(d, s, grid.centre(i))[d]; });
    }
  }
}

/// What each side of a face gives.
struct TwoSided {
  double up;    ///< velocity >= 0 at which the cell below gives its content upwards
  double down;  ///< velocity <= 0 at which the cell above gives its content downwards
};

/// Splits the projected velocity of a face, two-sided at faces that are not inside D.
template <int Dim>
TwoSided split_velocity(const Domain<Dim>& domain, const ConvectionInput<Dim>& in,
                        const Reconstruction<Dim>& reconstruction, const CellVectors<Dim>& u_half, double mac, Face f,
                        const Index<Dim>& i, int d) {
  const Cell high = high_cell(f);
  const Cell low = high - domain.grid.step(d);
  double up = mac;
  double down = mac;
  const bool given = on_inflow(domain, low, high);
  // A gas-side cell gives with its own velocity; into liquid at least as fast as the liquid recedes.
  if (!in.liquid[low] && !given) {
    const double own = reconstruction.from_low(u_half[d], in.u[d], f, i, d);
    up = in.liquid[high] ? std::max(mac, own) : own;
  }
  if (!in.liquid[high] && !given) {
    const double own = reconstruction.from_high(u_half[d], in.u[d], f, i, d);
    down = in.liquid[low] ? std::min(mac, own) : own;
  }
  return {std::max(up, 0.0), std::min(down, 0.0)};
}

/// Volume per time that the cells below and above a face give, per species.
template <int Dim>
struct VolumeFluxes {
  std::vector<FaceScalars<Dim>> low, high;

  VolumeFluxes(const Layout<Dim>& layout, std::size_t n_species)
      : low(n_species, FaceScalars<Dim>(layout)), high(n_species, FaceScalars<Dim>(layout)) {}
};

/// Volume fluxes of species i from either side: what region i fills of the swept slab, less what species 0 ... i-1 take
/// of it. Where those were limited species i makes up for them, so that liquid stays full.
template <int Dim>
void store_volume_fluxes(const Domain<Dim>& domain, const ConvectionInput<Dim>& in, const FaceScalars<Dim>& u_mac,
                         const CellVectors<Dim>& u_half, double dt, std::size_t i, VolumeFluxes<Dim>& flux) {
  const Reconstruction<Dim> reconstruction(domain.grid, in.total);
  const std::size_t whole = in.phi.size() - 1;
  const auto swept = [&](Cell c, const Index<Dim>& at, int d, int side, double velocity) {
    const auto part = [&](std::size_t k) {
      return swept_fraction(domain.grid, in.interfaces[k], region_fraction(in.phi, k, c), in.u, c, at, d, side,
                            velocity, dt);
    };
    return velocity * (i < whole ? std::min(part(i), part(whole)) : part(i));
  };
  for_each_axis<Dim>([&](auto d) {
    for_each<Face>(domain.layout(), domain.grid.faces(d), [&](Face f, const Index<Dim>& at) {
      const Cell high = high_cell(f);
      const Cell low = high - domain.grid.step(d);
      const auto [up, down] = split_velocity(domain, in, reconstruction, u_half, u_mac[d][f], f, at, d);
      const double area = domain.aperture(d, at);
      double from_low = up > 0 ? area * swept(low, shifted(at, d, -1), d, 1, up) : 0.0;
      double from_high = down < 0 ? area * swept(high, at, d, -1, down) : 0.0;
      for (std::size_t j = 0; j < i; ++j) {
        from_low -= flux.low[j][d][f];
        from_high -= flux.high[j][d][f];
      }
      flux.low[i][d][f] = std::max(from_low, 0.0);
      flux.high[i][d][f] = std::min(from_high, 0.0);
    });
  });
}

/// Scales each cell's outflow of a species to at most what the cell holds.
template <int Dim>
void limit_outflow(const Domain<Dim>& domain, const CellField& phi, double dt, FaceScalars<Dim>& flux_low,
                   FaceScalars<Dim>& flux_high) {
  const Grid<Dim>& grid = domain.grid;
  CellField scale(domain.layout(), 1);
  for_each<Cell>(domain.layout(), grid.cells(), [&](Cell c, const Index<Dim>& i) {
    double out = 0;
    for (int d = 0; d < Dim; ++d) out += flux_low[d][low_face(c + grid.step(d))] - flux_high[d][low_face(c)];
    const double held = std::max(phi[c], 0.0) * grid.volume(i);
    scale[c] = out * dt > held ? held / (out * dt) : 1.0;
  });
  wrap(domain.layout(), grid.cells(), scale);
  for (int d = 0; d < Dim; ++d) {
    for_each<Face>(domain.layout(), grid.faces(d), [&](Face f) {
      const Cell high = high_cell(f);
      flux_low[d][f] *= scale[high - grid.step(d)];
      flux_high[d][f] *= scale[high];
    });
  }
}

/// Volume that crosses open sides outwards during the step.
template <int Dim>
double outflow_through_sides(const Domain<Dim>& domain, const FaceScalars<Dim>& flux_low,
                             const FaceScalars<Dim>& flux_high, double dt) {
  double escaped = 0;
  for (int d = 0; d < Dim; ++d) {
    for (int s = 0; s < 2; ++s) {
      const Box<Dim> layer = intersect(domain.side_faces(d, s), domain.grid.faces(d));
      const double sign = s == 0 ? -1 : 1;
      escaped +=
          sum<Face>(domain.layout(), layer, [&](Face f) { return sign * dt * (flux_low[d][f] + flux_high[d][f]); });
    }
  }
  return escaped;
}

}  // namespace

template <int Dim>
void predict_velocities(const Domain<Dim>& domain, const ConvectionInput<Dim>& in, double dt, CellVectors<Dim>& u_half,
                        FaceScalars<Dim>& u_mac) {
  const Grid<Dim>& grid = domain.grid;
  const Reconstruction<Dim> reconstruction(grid, in.total);
  for (int e = 0; e < Dim; ++e) {
    for_each<Cell>(domain.layout(), grow(grid.cells(), 1), [&](Cell c, const Index<Dim>& i) {
      const double a = reconstruction.ballistic(c) ? 0 : in.acceleration[e][c];
      u_half[e][c] = in.u[e][c] + 0.5 * dt * a +
                     advect_half(in.u, c, dt, [&](int d) { return reconstruction.velocity_slope(in.u[e], c, i, d); });
    });
  }
  for_each_axis<Dim>([&](auto d) {
    for_each<Face>(domain.layout(), grid.faces(d), [&](Face f, const Index<Dim>& i) {
      const Cell high = high_cell(f);
      const Cell low = high - grid.step(d);
      u_mac[d][f] = domain.passes(d, i)
                        ? upwind(reconstruction.from_low(u_half[d], in.u[d], f, i, d),
                                 reconstruction.from_high(u_half[d], in.u[d], f, i, d), in.rho[low], in.rho[high],
                                 in.total[low] < empty_fraction, in.total[high] < empty_fraction)
                        : 0.0;
    });
  });
  impose_inflow(domain, u_mac);
}

template <int Dim>
void convect(const Domain<Dim>& domain, const std::vector<Species>& species, const ConvectionInput<Dim>& in, double dt,
             const FaceScalars<Dim>& u_mac, const CellVectors<Dim>& u_half, Fractions& phi_tilde,
             CellVectors<Dim>& momentum_tilde, std::vector<double>& escaped) {
  const Grid<Dim>& grid = domain.grid;
  VolumeFluxes<Dim> flux(domain.layout(), species.size());
  for (std::size_t i = 0; i < species.size(); ++i) {
    store_volume_fluxes(domain, in, u_mac, u_half, dt, i, flux);
    FaceScalars<Dim>& low = flux.low[i];
    FaceScalars<Dim>& high = flux.high[i];
    limit_outflow(domain, in.phi[i], dt, low, high);
    escaped[i] += outflow_through_sides(domain, low, high, dt);
    for_each<Cell>(domain.layout(), grid.cells(), [&](Cell c, const Index<Dim>& at) {
      double gain = 0;
      for (int d = 0; d < Dim; ++d) {
        const Face below = low_face(c);
        const Face above = low_face(c + grid.step(d));
        gain += low[d][below] + high[d][below] - low[d][above] - high[d][above];
      }
      phi_tilde[i][c] = in.phi[i][c] + dt * gain / grid.volume(at);
    });
  }

  // Momentum goes with the mass that crosses a face, at the velocity of the side that gives it.
  const Reconstruction<Dim> reconstruction(grid, in.total);
  const Layout<Dim>& layout = domain.layout();
  for (int e = 0; e < Dim; ++e) {
    for_each<Cell>(layout, grid.cells(), [&](Cell c) { momentum_tilde[e][c] = in.rho[c] * in.u[e][c]; });
  }
  FaceField mass_low(layout), mass_high(layout), momentum_flux(layout);
  for_each_axis<Dim>([&](auto d) {
    mass_low.fill(0);
    mass_high.fill(0);
    for (std::size_t i = 0; i < species.size(); ++i) {
      const double density = species[i].density;
      for_each<Face>(layout, grid.faces(d), [&](Face f) {
        mass_low[f] += density * flux.low[i][d][f];
        mass_high[f] += density * flux.high[i][d][f];
      });
    }
    for (int e = 0; e < Dim; ++e) {
      const CellField& u = in.u[e];
      const CellField& half = u_half[e];
      for_each<Face>(layout, grid.faces(d), [&](Face f, const Index<Dim>& i) {
        momentum_flux[f] = mass_low[f] * reconstruction.from_low(half, u, f, i, d) +
                           mass_high[f] * reconstruction.from_high(half, u, f, i, d);
      });
      for_each<Cell>(layout, grid.cells(), [&](Cell c, const Index<Dim>& i) {
        const Face below = low_face(c);
        const Face above = low_face(c + grid.step(d));
        momentum_tilde[e][c] += dt * (momentum_flux[below] - momentum_flux[above]) / grid.volume(i);
      });
    }
  });
  double full = 0;
  for (const Species& s : species) full = std::max(full, s.density);
  for_each<Cell>(layout, grid.cells(), [&](Cell c) {
    double mass = 0;
    for (std::size_t i = 0; i < species.size(); ++i) mass += species[i].density * phi_tilde[i][c];
    for (int e = 0; e < Dim; ++e) momentum_tilde[e][c] = mass > rounded_off * full ? momentum_tilde[e][c] : 0.0;
  });
}

#define QUICKSAND_INSTANTIATE(Dim)                                                                             \
  template void predict_velocities(const Domain<Dim>&, const ConvectionInput<Dim>&, double, CellVectors<Dim>&, \
                                   FaceScalars<Dim>&);                                                         \
  template void convect(const Domain<Dim>&, const std::vector<Species>&, const ConvectionInput<Dim>&, double,  \
                        const FaceScalars<Dim>&, const CellVectors<Dim>&, Fractions&, CellVectors<Dim>&,       \
                        std::vector<double>&);
QUICKSAND_INSTANTIATE(2)
QUICKSAND_INSTANTIATE(3)
#undef QUICKSAND_INSTANTIATE

}  // namespace quicksand
