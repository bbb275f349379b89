#include "solvers/algebra/spectrum.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace frahm::algebra {

Spectrum spectrum(const Eigen::MatrixXd& A) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A);
  Spectrum result{solver.eigenvalues(), solver.eigenvectors(), {}};
  result.inverse = result.vectors.partialPivLu().inverse();
  return result;
}

}  // namespace frahm::algebra
