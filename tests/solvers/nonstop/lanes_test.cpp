#include "solvers/nonstop/lanes.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>

namespace lanes_test {
// The functions of sixteen numbers at once, beside those of the standard library.
namespace {

constexpr double kRounding = 4e-16;

template <class Visit>
void visit_numbers(double from, double to, const Visit& visit) {
  constexpr int kCount = 40000;
  for (int i = 0; i < kCount; ++i) {
    Lanes x = lanes(0.0);
    for (int lane = 0; lane < 8; ++lane) at(x, lane) = from + (to - from) * (i + lane / 8.0) / kCount;
    visit(x);
  }
}

TEST_CASE("exponential, turn, logarithm and root of lanes are right to rounding") {
  double of_exp = 0.0, of_turn = 0.0, of_log = 0.0, of_root = 0.0;
  visit_numbers(-700.0, 700.0, [&](Lanes x) {
    Lanes e = exp(x), positive = abs(x) + 1e-6, l = log(positive), r = sqrt(positive);
    Complex u = turn(x * 1000.0);
    for (int i = 0; i < 8; ++i) {
      const double number = at(x, i), size = std::abs(number) + 1e-6;
      of_exp = std::max(of_exp, std::abs(at(e, i) / std::exp(number) - 1.0));
      of_turn = std::max(of_turn, std::abs(at(u.re, i) - std::cos(number * 1000.0)));
      of_turn = std::max(of_turn, std::abs(at(u.im, i) - std::sin(number * 1000.0)));
      of_log =
          std::max(of_log, std::abs(at(l, i) - std::log(size)) / std::max(1.0, std::abs(std::log(size))));
      of_root = std::max(of_root, std::abs(at(r, i) - std::sqrt(size)));
    }
  });
  CHECK(of_exp <= kRounding);
  CHECK(of_turn <= kRounding);
  CHECK(of_log <= kRounding);
  CHECK(of_root == 0.0);
}

TEST_CASE("an exponential that is too small to be a number is zero") {
  Lanes e = exp(lanes(-1e4));
  CHECK(at(e, 0) == 0.0);
}

TEST_CASE("floor and the lanes' choice are exact") {
  visit_numbers(-20.0, 20.0, [&](Lanes x) {
    Lanes down = floor(x), larger = max(x, lanes(0.5));
    for (int i = 0; i < 8; ++i) {
      CHECK(at(down, i) == std::floor(at(x, i)));
      CHECK(at(larger, i) == std::max(at(x, i), 0.5));
    }
  });
}

}  // namespace
}  // namespace lanes_test
