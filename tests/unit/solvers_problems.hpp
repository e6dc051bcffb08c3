#pragma once
/// \file
/// Matrices and axes that the tests of the solvers share.
#include <array>
#include <cmath>
#include <vector>

#include "core/grid.hpp"
#include "solvers/stencil_matrix.hpp"

namespace quicksand::problems {

/// n cells of equal width on [lo, hi].
inline std::vector<double> uniform_axis(int n, double lo = 0, double hi = 1) {
  std::vector<double> faces;
  for (int i = 0; i <= n; ++i) faces.push_back(lo + (hi - lo) * i / n);
  return faces;
}

/// n cells that grow geometrically, the last `ratio` times as wide as the first.
inline std::vector<double> graded_axis(int n, double ratio) {
  std::vector<double> faces{0};
  for (int i = 0; i < n; ++i) faces.push_back(faces.back() + std::pow(ratio, n > 1 ? double(i) / (n - 1) : 0.0));
  for (double& x : faces) x /= faces.back();
  return faces;
}

/// -div grad on the cells inside(Index), in finite volume form; zero flux at the domain's sides and the value zero on
/// faces (dirichlet_on_faces) or in cell centres outside.
template <int Dim, class Inside>
StencilMatrix<Dim, Cell> cell_laplacian(const Grid<Dim>& grid, Inside&& inside, bool dirichlet_on_faces = false) {
  StencilMatrix<Dim, Cell> matrix(grid.layout(), Stencil::star);
  for (int d = 0; d < Dim; ++d) {
    for_each_coloured<Cell>(grid.layout(), grid.cells(), [&](Cell high, const Index<Dim>& i) {
      if (i[d] == 0 && !grid.layout().periodic(d)) return;
      Index<Dim> below = i;
      below[d] = grid.layout().image(d, i[d] - 1);
      const Cell low = grid.cell(below);
      const double area = grid.area(d, i);
      const double width_low = grid.width_1d(d, below[d]);
      const double width_high = grid.width_1d(d, i[d]);
      const double weight = area * 2 / (width_low + width_high);
      if (inside(i) && inside(below)) {
        matrix.lower[static_cast<std::size_t>(d)][high] = -weight;
        matrix.diagonal[low] += weight;
        matrix.diagonal[high] += weight;
      } else if (inside(i)) {
        matrix.diagonal[high] += dirichlet_on_faces ? 2 * area / width_high : weight;
      } else if (inside(below)) {
        matrix.diagonal[low] += dirichlet_on_faces ? 2 * area / width_low : weight;
      }
    });
  }
  for_each<Cell>(grid.layout(), grid.cells(), [&](Cell c) {
    if (matrix.diagonal[c] == 0) matrix.diagonal[c] = 1;
  });
  matrix.wrap_couplings();
  return matrix;
}

/// -div grad with bilinear or trilinear elements on the cells inside(Index); a node that touches a cell outside is an
/// identity row, the domain's sides are natural.
template <int Dim, class Inside>
StencilMatrix<Dim, Node> node_laplacian(const Grid<Dim>& grid, Inside&& inside) {
  StencilMatrix<Dim, Node> matrix(grid.layout(), Stencil::box);
  constexpr int corners = 1 << Dim;
  const auto corner_step = [&](int k) {
    Step s;
    for (int d = 0; d < Dim; ++d) s = s + ((k >> d) & 1) * grid.step(d);
    return s;
  };
  const auto image = [&](Node n) { return grid.layout().image(n); };
  NodeMask fixed(grid.layout(), 0);
  for_each_coloured<Cell>(grid.layout(), grid.cells(), [&](Cell c, const Index<Dim>& index) {
    if (!inside(index)) {
      for (int a = 0; a < corners; ++a) fixed[image(low_node(c) + corner_step(a))] = 1;
      return;
    }
    for (int a = 0; a < corners; ++a) {
      for (int b = 0; b <= a; ++b) {
        double value = 0;
        for (int d = 0; d < Dim; ++d) {
          double product = 1;
          for (int e = 0; e < Dim; ++e) {
            const LineElement& line = grid.line_element(e, index[e]);
            const int ea = (a >> e) & 1;
            const int eb = (b >> e) & 1;
            product *= e == d ? (ea == eb ? line.stiffness : -line.stiffness) : line.mass[ea][eb];
          }
          value += product;
        }
        const Node pa = low_node(c) + corner_step(a);
        const Node pb = low_node(c) + corner_step(b);
        if (a == b) matrix.diagonal[image(pa)] += value;
        const Node upper = pa.n > pb.n ? pa : pb;
        for (std::size_t e = 0; e < matrix.steps.size(); ++e) {
          if (matrix.steps[e].n == std::abs(pa.n - pb.n)) matrix.lower[e][image(upper)] += value;
        }
      }
    }
  });
  for_each_coloured<Node>(grid.layout(), matrix.box, [&](Node p, const Index<Dim>&) {
    if (fixed[p] != 0) matrix.set_identity(p);
  });
  matrix.wrap_couplings();
  return matrix;
}

/// A rough right-hand side in [-1, 1] that does not depend on the platform.
template <int Dim, class At>
Field<At> rough_field(const StencilMatrix<Dim, At>& matrix) {
  Field<At> b(matrix.layout);
  for_each<At>(matrix.layout, matrix.box, [&](At p, const Index<Dim>& i) {
    double phase = 1;
    for (int d = 0; d < Dim; ++d) phase += (12.9898 + 65.1 * d) * i[d];
    const double s = std::sin(phase) * 43758.5453;
    b[p] = matrix.uncoupled(p) ? 0.0 : 2 * (s - std::floor(s)) - 1;
  });
  return b;
}

}  // namespace quicksand::problems
