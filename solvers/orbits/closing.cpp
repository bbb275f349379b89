#include "solvers/orbits/closing.hpp"

#include "solvers/mechanics/free_directions.hpp"

namespace frahm::periodic {

// With coordinates c of the network's free directions, those of the orbit are c = Z a: no bend that it
// reaches is bent. Of these, U = R V: nothing resists them. Z^T Z = 1, V^T V = 1, so that R^T M R = 1 stays.
Closing::Closing(const StepFree& free, ContactMask reached) {
  Eigen::MatrixXd held(free.bent.rows(), free.R.cols());
  for (Eigen::Index j = 0; j < held.rows(); ++j)
    held.row(j) = (contains(reached, j) ? 1.0 : 0.0) * free.bent.row(j);
  const Eigen::MatrixXd Z = mechanics::unstrained(held);
  R_ = free.R * Z;
  along_ = Z.transpose() * free.along;
  if (!is_modulo()) return;
  const Eigen::MatrixXd A = mechanics::unstrained(free.bent * Z);
  anywhere_ = A * A.transpose();
  const Eigen::MatrixXd V = mechanics::unstrained(free.resisted * Z);
  U_ = R_ * V;
  along_U_ = V.transpose() * along_;
  driven_ = (Z * V).transpose() * free.driven;
}

}  // namespace frahm::periodic
