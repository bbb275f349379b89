// Buildings, against modal sums in closed form and against the equation of motion solved by complex numbers.
#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "tests/end_to_end/runs.hpp"

namespace structures_test {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

constexpr double linear = 1e-9;   // relative: a linear response
constexpr double balance = 1e-8;  // of shares that add up to 1

// Of a uniform chain of n masses on a base: omega_j = 2 sqrt(k/m) sin((2j - 1) pi / (2 (2n + 1))), with the
// shape sin((2j - 1) pi i / (2n + 1)) at mass i. Relative to the base, under its acceleration a cos(omega t),
// each mode has the load -a sum(shape) / sum(shape^2).
double sway_of_chain(int n, double k_over_m, double zeta, double a, double omega) {
  Complex sum = 0.0;
  for (int j = 1; j <= n; ++j) {
    double load = 0.0, size = 0.0;
    for (int i = 1; i <= n; ++i) {
      const double shape = std::sin((2 * j - 1) * pi * i / (2 * n + 1));
      load += shape;
      size += shape * shape;
    }
    const double own = 2.0 * std::sqrt(k_over_m) * std::sin((2 * j - 1) * pi / (2.0 * (2 * n + 1)));
    const double roof = std::sin((2 * j - 1) * pi * n / (2 * n + 1));
    sum -= roof * load / size * a / Complex(own * own - omega * omega, 2.0 * zeta * own * omega);
  }
  return std::abs(sum);
}

TEST_CASE("sixty_storeys.toml: without friction the roof sways as the sum of sixty modes in closed form",
          "[slow]") {
  const runs::Map map = runs::run_study(runs::reduced("sixty_storeys", {{"omega", 4}}));
  const auto& omega = map.coordinate("omega");
  for (std::size_t i = 0; i < omega.size(); ++i) {  // the first row has F = 0
    INFO("omega " << omega[i]);
    CHECK_THAT(map["sway_peak"][i],
               Catch::WithinRel(sway_of_chain(60, 2000.0, 0.02, 0.02 * 9.80665, omega[i]), linear));
  }
  // What the ground puts in, dampers and structure dissipate.
  for (std::size_t i = 0; i < map["status"].size(); ++i) {
    double shares = map["damping_energy_share"][i];
    for (int brace = 3; brace <= 60; brace += 3)
      shares += map["brace" + std::to_string(brace) + "_energy_share"][i];
    INFO("point " << i);
    CHECK(map["status"][i] == 1.0);
    CHECK_THAT(shares, Catch::WithinAbs(1.0, balance));
  }
}

TEST_CASE("tower_damper.toml: floors and damper move as complex numbers say") {
  constexpr int n = 20;
  constexpr double m = 400e3, k = 900e6, m_d = 120e3, w_d = 3.53, zeta = 0.105, alpha = 0.04, beta = 2e-3;
  const runs::Map map = runs::run_study(runs::reduced("tower_damper", {{"omega", 10}}));
  const auto &omega = map.coordinate("omega"), &inertance = map.coordinate("b");
  for (std::size_t row = 0; row < inertance.size(); ++row) {
    const double b = inertance[row] * 1e3;
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n + 1, n + 1), K = M, C_d = M;
    const auto join = [](Eigen::MatrixXd& matrix, int i, int j, double value) {
      matrix(i, i) += value;
      matrix(j, j) += value;
      matrix(i, j) -= value;
      matrix(j, i) -= value;
    };
    for (int i = 0; i < n; ++i) M(i, i) = m;
    M(n, n) = m_d;
    K(0, 0) = k;
    for (int i = 1; i < n; ++i) join(K, i - 1, i, k);
    join(M, 14, n, b);
    join(K, n - 1, n, (m_d + b) * w_d * w_d);
    join(C_d, n - 1, n, 2.0 * zeta * (m_d + b) * w_d);
    const Eigen::MatrixXd C = C_d + alpha * M + beta * K;
    const Eigen::VectorXcd P = Eigen::VectorXcd::NullaryExpr(
        n + 1, [](Eigen::Index i) { return i < n ? 1e3 * static_cast<double>(i + 1) : 0.0; });
    for (std::size_t i = 0; i < omega.size(); ++i) {
      const double w = omega[i];
      const Eigen::MatrixXcd A = (K - w * w * M) + Complex(0.0, w) * C.cast<Complex>();
      const Eigen::VectorXcd X = A.partialPivLu().solve(P);
      const std::size_t at = row * omega.size() + i;
      INFO("b " << b << " omega " << w);
      CHECK_THAT(map["floor20_peak"][at], Catch::WithinRel(std::abs(X[n - 1]), linear));
      CHECK_THAT(map["floor1_peak"][at], Catch::WithinRel(std::abs(X[0]), linear));
      CHECK_THAT(map["damper_peak"][at], Catch::WithinRel(std::abs(X[n]), linear));
      CHECK_THAT(map["across_peak"][at], Catch::WithinRel(std::abs(X[n] - X[14]), linear));
      CHECK_THAT(map["inerter_force_peak"][at], Catch::WithinAbs(b * w * w * std::abs(X[n] - X[14]), 1e-3));
    }
  }
}

}  // namespace
}  // namespace structures_test
