#include "solvers/samples/elementary.hpp"

#include <array>
#include <boost/math/distributions/normal.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "solvers/samples/distribution.hpp"
#include "solvers/samples/sequence.hpp"
#include "tests/solvers/bits.hpp"

namespace frahm::samples::elementary_test {
namespace {

using Kind = Distribution::Kind;
using Catch::WithinRel;

constexpr double rounding = 2e-15;  // relative
constexpr double of_a_share = 5e-14;

// Against long doubles, over all that samples and records ask for.
TEST_CASE("exponentials and logarithms without a library are those of the library") {
  for (int i = -6000; i <= 6000; ++i) {
    const double x = 0.1137 * i;
    CHECK_THAT(exponential(x),
               WithinRel(static_cast<double>(std::exp(static_cast<long double>(x))), rounding));
  }
  for (int i = 1; i <= 4000; ++i) {
    const double x = std::ldexp(0.0005 * i, i % 200 - 100);
    CHECK_THAT(logarithm(x), WithinRel(static_cast<double>(std::log(static_cast<long double>(x))), rounding));
    const double y = std::ldexp(0.0005 * i, -i % 60);
    CHECK_THAT(logarithm_of_1_and(y),
               WithinRel(static_cast<double>(std::log1p(static_cast<long double>(y))), rounding));
  }
  CHECK(logarithm(kInfinity) == kInfinity);
}

TEST_CASE("normal shares and their inverse without a library are those of the library, far into the tails") {
  const boost::math::normal_distribution<long double> normal;
  for (int i = -1200; i <= 1200; ++i) {
    const double x = 0.01 * i;
    CHECK_THAT(normal_share(x), WithinRel(static_cast<double>(boost::math::cdf(normal, x)), of_a_share));
  }
  for (int i = 1; i < 3000; ++i) {
    for (const double share : {i / 3000.0, std::ldexp(i / 3000.0, -i % 300)}) {
      const auto expected =
          static_cast<double>(boost::math::quantile(normal, static_cast<long double>(share)));
      CHECK(std::abs(standard_normal(share) - expected) <= rounding * std::abs(expected));
    }
  }
  CHECK(standard_normal(0.0) == -kInfinity);
  CHECK(standard_normal(1.0) == kInfinity);
}

TEST_CASE("a seed gives samples of the same bits on every machine") {
  constexpr Eigen::Index count = 200;
  const std::array<Distribution, 5> distributions{{{.kind = Kind::normal, .centre = 5.0, .spread = 0.5},
                                                   {Kind::normal, 5.0, 0.5, 4.5, 7.0},
                                                   {.kind = Kind::lognormal, .centre = 2.0, .spread = 0.3},
                                                   {Kind::uniform, 0.0, 1.0, 1.0, 3.0},
                                                   {Kind::triangular, 2.0, 1.0, 1.0, 4.0}}};
  constexpr std::uint64_t expected[3][5] = {
      {0x441d70541249fc5f, 0xa46491d23001dceb, 0x607f1f66825d56a3, 0xe62ce24717239745, 0xaf47b0d9be1d0256},
      {0x715755ae058268e1, 0x3644dd152deadde9, 0xda763a141d6e046e, 0x9a7b0c03bed5ee30, 0xf46870e01e853414},
      {0x957dc95903422676, 0x49cfc12b72950f7e, 0x59d29de61fac5d5e, 0xd25490e59f788490, 0xde8cfc818916c34a}};
  for (const Sequence sequence : {Sequence::sobol, Sequence::latin_hypercube, Sequence::random}) {
    const Eigen::MatrixXd points = unit_points(sequence, count, 5, 7);
    for (std::size_t d = 0; d < 5; ++d) {
      std::vector<double> values;
      for (Eigen::Index i = 0; i < count; ++i)
        values.push_back(quantile(distributions[d], points(i, static_cast<Eigen::Index>(d))));
      INFO("sequence " << static_cast<int>(sequence) << ", distribution " << d);
      CHECK(checksum_of_bits(values) == expected[static_cast<int>(sequence)][d]);
    }
  }
}

}  // namespace
}  // namespace frahm::samples::elementary_test
