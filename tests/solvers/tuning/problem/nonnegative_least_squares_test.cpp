#include "solvers/tuning/problem/nonnegative_least_squares.hpp"

#include <catch2/catch.hpp>
#include <random>

namespace frahm::tuning::nonnegative_least_squares_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kOptimality = 1e-10;  // of the slopes, with entries of order 1

MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, std::mt19937& generator) {
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(generator); });
}

// x >= 0, A^T (A x - b) + weight^2 x >= 0, and one of the two zero in every component.
void check_optimal(const MatrixXd& A, const VectorXd& b, const VectorXd& weight, const VectorXd& x) {
  const VectorXd slope = A.transpose() * (A * x - b) + weight.cwiseAbs2().cwiseProduct(x);
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
    const VectorXd none = VectorXd::Zero(columns), weight = random_matrix(columns, 1, generator).cwiseAbs();
    check_optimal(A, b, none, nonnegative_least_squares(A, b, none));
    check_optimal(A, b, weight, nonnegative_least_squares(A, b, weight));
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
    CHECK((A * nonnegative_least_squares(A, b, VectorXd::Zero(12)) - b).norm() <= kOptimality * b.norm());
  }
}

TEST_CASE("Non-negative least squares of nothing is nothing") {
  const VectorXd ones = VectorXd::Ones(2), none = VectorXd::Zero(2);
  CHECK(nonnegative_least_squares(MatrixXd(2, 0), ones, VectorXd(0)).size() == 0);
  CHECK(nonnegative_least_squares(MatrixXd::Identity(2, 2), -ones, none) == none);
  CHECK(nonnegative_least_squares(MatrixXd::Zero(2, 2), ones, none) == none);
}

}  // namespace
}  // namespace frahm::tuning::nonnegative_least_squares_test
