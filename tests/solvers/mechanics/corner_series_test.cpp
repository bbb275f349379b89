#include "solvers/mechanics/corner_series.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

namespace frahm::mechanics::corner_series_test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double kExact = 1e-15;  // of the largest value: roundings of a few lines
constexpr int kOrders = 200;

using Complex = std::complex<double>;

// Re(c e^(i n theta)) = b sin(n theta) of c = -i b.
Complex sine(double b) {
  return {0.0, -b};
}

TEST_CASE("A triangle's series is 8/(pi n)^2 of its odd orders, with alternating signs") {
  const std::vector<Corner> triangle{{0, 0}, {1, 1}, {3, -1}, {4, 0}};
  const CornerSeries series = corner_series(triangle, kOrders);
  CHECK(series.mean == 0.0);
  double kept = 0.0;
  for (int n = 1; n <= kOrders; ++n) {
    const double b = n % 2 == 0 ? 0.0 : (n % 4 == 1 ? 8.0 : -8.0) / (pi * pi * n * n);
    INFO("order " << n);
    CHECK(std::abs(series.harmonics[static_cast<std::size_t>(n - 1)] - sine(b)) < kExact);
    if (n % 2 == 0) CHECK(series.harmonics[static_cast<std::size_t>(n - 1)] == 0.0);
    kept += 0.5 * b * b;
  }
  // Its mean square is 1/3.
  CHECK(std::abs(series.left_out - std::sqrt(1.0 - 3.0 * kept)) < 1e-7);
}

TEST_CASE("A square's series is 4/(pi n) of its odd orders, a sawtooth's -2/(pi n) of all") {
  const std::vector<Corner> square{{0, 1}, {1, 1}, {1, -1}, {2, -1}};
  const std::vector<Corner> sawtooth{{0, -1}, {3, 1}};
  const CornerSeries of_square = corner_series(square, kOrders), of_saw = corner_series(sawtooth, kOrders);
  for (int n = 1; n <= kOrders; ++n) {
    const auto at = static_cast<std::size_t>(n - 1);
    INFO("order " << n);
    CHECK(std::abs(of_square.harmonics[at] - sine(n % 2 == 0 ? 0.0 : 4.0 / (pi * n))) < kExact);
    CHECK(std::abs(of_saw.harmonics[at] - sine(-2.0 / (pi * n))) < kExact);
  }
  // What is left out of a square's mean square, 1, is sum 8/(pi n)^2 over the odd n above; of its first order
  // alone 1 - 8/pi^2.
  CHECK(std::abs(corner_series(square, 1).left_out - std::sqrt(1.0 - 8.0 / (pi * pi))) < 1e-14);
}

TEST_CASE("A course that begins elsewhere in its period turns each order, and a constant is its mean alone") {
  const std::vector<Corner> course{{0, 2}, {1, 5}, {1, 3}, {4, -2}, {10, 2}};
  // Begun at 1, in front of the step.
  const std::vector<Corner> later{{0, 5}, {0, 3}, {3, -2}, {9, 2}, {10, 5}};
  const CornerSeries series = corner_series(course, kOrders), turned = corner_series(later, kOrders);
  // int over the lines / 10 = (3.5 + 1.5 + 0)/10
  CHECK(std::abs(series.mean - 0.5) < kExact);
  CHECK(std::abs(turned.mean - 0.5) < kExact);
  for (int n = 1; n <= kOrders; ++n) {
    const auto at = static_cast<std::size_t>(n - 1);
    INFO("order " << n);
    CHECK(std::abs(turned.harmonics[at] - series.harmonics[at] * std::polar(1.0, 0.2 * pi * n)) <
          20.0 * kExact);
  }
  const CornerSeries constant = corner_series(std::vector<Corner>{{0, 7}, {2, 7}}, 3);
  CHECK(constant.mean == 7.0);
  CHECK(constant.left_out == 0.0);
  for (const Complex& c : constant.harmonics) CHECK(c == 0.0);
}

TEST_CASE("A steep line is a step, as it becomes shorter") {
  const auto with_edge = [](double edge) {
    return corner_series(std::vector<Corner>{{0, 1}, {1 - edge, 1}, {1 + edge, -1}, {2, -1}}, 50);
  };
  const CornerSeries step = with_edge(0.0);
  for (const double edge : {1e-6, 1e-9, 1e-12}) {
    const CornerSeries steep = with_edge(edge);
    for (std::size_t i = 0; i < 50; ++i) {
      INFO("edge " << edge << ", order " << i + 1);
      // The first difference is of the second order: -(pi n edge/2)^2/6 of the jump's part.
      CHECK(std::abs(steep.harmonics[i] - step.harmonics[i]) < 1e3 * edge * edge + 1e-14);
    }
  }
}

}  // namespace
}  // namespace frahm::mechanics::corner_series_test
