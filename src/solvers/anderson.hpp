#pragma once
/// \file
/// Anderson acceleration of a fixed-point iteration x <- G(x).
#include <Eigen/Core>
#include <deque>

namespace quicksand {

/// Mixes the last `depth` iterates so that the residual G(x) - x is least in the Euclidean norm (Walker and Ni 2011).
class Anderson {
 public:
  explicit Anderson(int depth) : depth_(depth) {}

  /// Next iterate from x and g = G(x).
  Eigen::VectorXd next(const Eigen::VectorXd& x, const Eigen::VectorXd& g);

 private:
  int depth_;
  std::deque<Eigen::VectorXd> residuals_;
  std::deque<Eigen::VectorXd> images_;
};

}  // namespace quicksand
