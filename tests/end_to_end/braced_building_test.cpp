// braced_building.toml: ten storeys with braces that slip.
#include <Eigen/Dense>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <string>

#include "tests/end_to_end/runs.hpp"

namespace braced_building_test {
namespace {

using Catch::Matchers::WithinRel;
using runs::Map;

constexpr int kStoreys = 10;
constexpr double kLinear = 1e-9, kLoop = 1e-9;  // relative

// Stiffness of a chain that stands on its base: 1 in every storey, and k_b in every second one.
Eigen::MatrixXd chain(double columns, double braces) {
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(kStoreys, kStoreys);
  for (int i = 0; i < kStoreys; ++i) {
    const double k = columns + (i % 2 == 0 ? braces : 0.0);
    K(i, i) += k;
    if (i == 0) continue;
    K(i - 1, i - 1) += k;
    K(i, i - 1) -= k;
    K(i - 1, i) -= k;
  }
  return K;
}

// (K - r^2 + i r C) x = r^2 of the motion relative to the base, C = Phi diag(2 zeta omega) Phi^T of the
// columns.
double roof_without_slip(double r, double k_b) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(chain(1.0, 0.0));
  const Eigen::VectorXd rates = 2.0 * 0.02 * modes.eigenvalues().cwiseSqrt();
  const Eigen::MatrixXd C = modes.eigenvectors() * rates.asDiagonal() * modes.eigenvectors().transpose();
  Eigen::MatrixXcd dynamic = chain(1.0, k_b).cast<std::complex<double>>();
  dynamic.diagonal().array() -= r * r;
  dynamic += std::complex<double>(0.0, r) * C;
  const Eigen::VectorXcd x = dynamic.partialPivLu().solve(Eigen::VectorXcd::Constant(kStoreys, r * r));
  return std::abs(x[kStoreys - 1] + 1.0);
}

TEST_CASE(
    "braced_building.toml: the limits are two linear buildings, and a slip force between them is best") {
  const Map map = runs::run_study(runs::reduced("braced_building", {}));
  const auto &F = map.coordinate("F"), &r = map.coordinate("r");
  std::vector<double> worst(F.size(), 0.0);
  int loops = 0;
  for (std::size_t i = 0; i < F.size(); ++i) {
    for (std::size_t j = 0; j < r.size(); ++j) {
      const std::size_t point = i * r.size() + j;
      INFO("F " << F[i] << ", r " << r[j]);
      CHECK(map["status"][point] == 1.0);
      CHECK(map["energy_balance"][point] < 1e-10);
      worst[i] = std::max(worst[i], map["floor10_peak"][point]);
      if (F[i] == 0.0 || F[i] == 100.0)
        CHECK_THAT(map["floor10_peak"][point],
                   WithinRel(roof_without_slip(r[j], F[i] == 0.0 ? 0.0 : 1.5), kLinear));
      for (int b = 1; b < kStoreys; b += 2) {
        const std::string brace = "brace" + std::to_string(b);
        if (map[brace + "_reversals"][point] != 2.0 || F[i] == 0.0) continue;
        // One loop: 4 F (X - F/k_b).
        const double X = map[brace + "_stroke"][point];
        CHECK_THAT(map[brace + "_energy"][point], WithinRel(4.0 * F[i] * (X - F[i] / 1.5), kLoop));
        ++loops;
      }
    }
  }
  CHECK(loops > 500);
  const auto best = std::min_element(worst.begin(), worst.end());
  CHECK(best != worst.begin());
  CHECK(best != worst.end() - 1);
  CHECK(*best < 0.5 * std::min(worst.front(), worst.back()));
}

}  // namespace
}  // namespace braced_building_test
