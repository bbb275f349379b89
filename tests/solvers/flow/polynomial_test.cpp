#include "solvers/flow/polynomial.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

namespace frahm::periodic::polynomial_test {
namespace {

using Catch::Matchers::WithinAbs;
constexpr double kRoot = 1e-10;  // of up to six roots at least 0.01 apart, whose coefficients carry rounding

// Product of (s - root) over the roots, times a factor.
Polynomial from_roots(const std::vector<double>& roots, double factor = 1.0) {
  Polynomial p = Polynomial::Zero();
  p[0] = factor;
  for (const double root : roots) {
    Polynomial shifted = Polynomial::Zero();
    shifted.tail<kTerms - 1>() = p.head<kTerms - 1>();
    p = (shifted - root * p).eval();
  }
  return p;
}

TEST_CASE("A polynomial's sign changes in [0, 1] are all found, in order") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-0.6, 1.6);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<double> roots, inside;
    for (int i = 0; i < 1 + trial % 6; ++i) roots.push_back(uniform(random));
    std::sort(roots.begin(), roots.end());
    bool close = false;
    for (std::size_t i = 0; i + 1 < roots.size(); ++i) close |= roots[i + 1] - roots[i] < 1e-2;
    if (close) continue;
    for (const double root : roots) {
      if (root > 0.0 && root < 1.0) inside.push_back(root);
    }
    const Roots found = sign_changes(from_roots(roots, trial % 2 == 0 ? 3.0 : -1e-7));
    REQUIRE(found.count == static_cast<int>(inside.size()));
    for (std::size_t i = 0; i < inside.size(); ++i) CHECK_THAT(found.at[i], WithinAbs(inside[i], kRoot));
  }
}

TEST_CASE("Two roots that almost touch are both found, and none where they miss") {
  for (const double gap : {1e-2, 1e-4, 1e-6, 1e-7}) {
    for (const double middle : {0.1234, 0.5, 0.87}) {
      const Roots pair = sign_changes(from_roots({middle - gap, middle + gap}));
      INFO("gap " << gap << " middle " << middle);
      REQUIRE(pair.count == 2);
      // A coefficient's rounding of 1e-16 moves a root by 1e-16 / (2 gap).
      CHECK_THAT(pair.at[0], WithinAbs(middle - gap, 1e-15 / gap));
      CHECK_THAT(pair.at[1], WithinAbs(middle + gap, 1e-15 / gap));
      Polynomial lifted = from_roots({middle, middle});
      lifted[0] += gap * gap;
      CHECK(sign_changes(lifted).count == 0);
    }
  }
}

TEST_CASE("A root at the middle of the interval, where halves meet, counts once") {
  for (const std::vector<double>& roots :
       {std::vector<double>{0.5}, {0.25, 0.5, 0.75}, {0.5, 0.5, 0.5}, {0.1, 0.5}, {0.125, 0.5, 0.875}}) {
    const int expected = roots.size() == 2                      ? 2
                         : roots.size() == 3 && roots[0] == 0.5 ? 1
                                                                : static_cast<int>(roots.size());
    CHECK(sign_changes(from_roots(roots)).count == expected);
  }
}

TEST_CASE("A root between two points of opposite sign is found to the last digit") {
  for (const double root : {1e-9, 0.3, 0.999999}) {
    for (const double other : {-3.0, 1.5, 1.0 + 1e-3}) {
      CHECK_THAT(root_between(from_roots({root, other}), 0.0, 1.0), WithinAbs(root, 1e-13));
    }
  }
  // A triple root: slope zero, yet a change of sign.
  CHECK_THAT(root_between(from_roots({0.4, 0.4, 0.4}), 0.0, 1.0), WithinAbs(0.4, 1e-5));
}

TEST_CASE("Deflation divides a known root at zero out") {
  const Polynomial p = from_roots({0.0, 0.0, 0.7});
  const Polynomial q = deflate(p, 2);
  CHECK_THAT(evaluate(q, 0.0), WithinAbs(-0.7, 1e-15));
  const Roots roots = sign_changes(q);
  REQUIRE(roots.count == 1);
  CHECK_THAT(roots.at[0], WithinAbs(0.7, kRoot));
}

}  // namespace
}  // namespace frahm::periodic::polynomial_test
