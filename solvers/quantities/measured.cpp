#include "solvers/quantities/measured.hpp"

#include <utility>

namespace frahm::periodic {

void in_seconds(Eigen::Index masses, double step, Eigen::MatrixXd& gram) {
  gram.middleRows(masses, masses) /= step;
  gram.middleCols(masses, masses) /= step;
}

void append_signals(const Eigen::MatrixXd& products, Eigen::MatrixXd& gram) {
  const Eigen::Index size = gram.rows(), signals = products.rows(), oscillators = products.cols() - 1;
  if (signals == 0) return;
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(size + signals, size + signals);
  whole.topLeftCorner(size, size) = gram;
  whole.block(size, size - oscillators, signals, oscillators) = products.leftCols(oscillators);
  whole.block(size - oscillators, size, oscillators, signals) = products.leftCols(oscillators).transpose();
  whole.diagonal().tail(signals) = products.col(oscillators);
  gram = std::move(whole);
}

}  // namespace frahm::periodic
