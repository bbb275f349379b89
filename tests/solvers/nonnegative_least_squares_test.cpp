#include "solvers/tuning/nonnegative_least_squares.hpp"

#include <catch2/catch.hpp>
#include <random>

namespace frahm::tuning {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kOptimality = 1e-10;  // of the slopes, with entries of order 1

MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, std::mt19937& generator) {
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(generator); });
}

// x >= 0, A^T (A x - b) >= 0, and one of the two zero in every component.
void check_optimal(const MatrixXd& A, const VectorXd& b, const VectorXd& x) {
  const VectorXd slope = A.transpose() * (A * x - b);
  CHECK(x.minCoeff() >= 0.0);
  CHECK(slope.minCoeff() >= -kOptimality);
  CHECK(x.cwiseProduct(slope).cwiseAbs().maxCoeff() <= kOptimality);
}

TEST_CASE("Non-negative least squares meets its optimality conditions on random matrices") {
  std::mt19937 generator(1974);
  for (int trial = 0; trial < 300; ++trial) {
    const Eigen::Index rows = 1 + trial % 12, columns = 1 + trial % 17;
    const MatrixXd A = random_matrix(rows, columns, generator);
    const VectorXd b = random_matrix(rows, 1, generator);
    INFO("trial " << trial << ", " << rows << " x " << columns);
    check_optimal(A, b, nonnegative_least_squares(A, b));
  }
}

TEST_CASE("Non-negative least squares finds a solution that exists, of any rank") {
  std::mt19937 generator(23);
  for (int trial = 0; trial < 100; ++trial) {
    MatrixXd A = random_matrix(8, 12, generator);
    A.col(3) = A.col(1);
    A.col(4) = -A.col(2);
    A.col(5).setZero();
    const VectorXd x = random_matrix(12, 1, generator).cwiseAbs();
    const VectorXd b = A * x;
    CHECK((A * nonnegative_least_squares(A, b) - b).norm() <= kOptimality * b.norm());
  }
}

TEST_CASE("Non-negative least squares of nothing is nothing") {
  CHECK(nonnegative_least_squares(MatrixXd(3, 0), VectorXd::Ones(3)).size() == 0);
  CHECK(nonnegative_least_squares(MatrixXd::Identity(2, 2), -VectorXd::Ones(2)) == VectorXd::Zero(2));
  CHECK(nonnegative_least_squares(MatrixXd::Zero(2, 2), VectorXd::Ones(2)) == VectorXd::Zero(2));
}

}  // namespace
}  // namespace frahm::tuning
