#include "solvers/anderson.hpp"

#include <Eigen/QR>

namespace quicksand {

Eigen::VectorXd Anderson::next(const Eigen::VectorXd& x, const Eigen::VectorXd& g) {
  residuals_.emplace_back(g - x);
  images_.push_back(g);
  if (static_cast<int>(residuals_.size()) > depth_ + 1) {
    residuals_.pop_front();
    images_.pop_front();
  }
  const auto history = static_cast<Eigen::Index>(residuals_.size()) - 1;
  if (history == 0) return g;
  Eigen::MatrixXd residual_steps(x.size(), history);
  Eigen::MatrixXd image_steps(x.size(), history);
  for (Eigen::Index k = 0; k < history; ++k) {
    const auto i = static_cast<std::size_t>(k);
    residual_steps.col(k) = residuals_[i + 1] - residuals_[i];
    image_steps.col(k) = images_[i + 1] - images_[i];
  }
  const Eigen::VectorXd weights = residual_steps.colPivHouseholderQr().solve(residuals_.back());
  return g - image_steps * weights;
}

}  // namespace quicksand
