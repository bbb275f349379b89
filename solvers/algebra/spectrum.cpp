#include "solvers/algebra/spectrum.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "solvers/algebra/no_value.hpp"

namespace frahm::algebra {

Spectrum spectrum(const Eigen::MatrixXd& A) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A);
  if (solver.info() != Eigen::Success) {
    const auto none = Eigen::MatrixXcd::Constant(A.rows(), A.cols(), kNone);
    return {none.col(0), none, none};
  }
  Spectrum result{solver.eigenvalues(), solver.eigenvectors(), {}};
  result.inverse = result.vectors.partialPivLu().inverse();
  return result;
}

}  // namespace frahm::algebra
