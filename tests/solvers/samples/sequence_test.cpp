#include "solvers/samples/sequence.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <vector>

namespace sequence_test {
namespace {

using namespace frahm::samples;

// The whole number of 52 bits in whose part of the unit a point lies.
std::uint64_t bits_of(double share) {
  return static_cast<std::uint64_t>(std::floor(std::ldexp(share, 52)));
}

TEST_CASE("random points are the draws of the generator that the standard of C++ defines") {
  // ISO/IEC 14882, [rand.predef]: the 10000th of a default mt19937_64, whose seed is 5489.
  constexpr std::uint64_t drawn = 9981545732273789042U;
  const Eigen::MatrixXd points = unit_points(Sequence::random, 10'000, 1, 5489);
  CHECK(bits_of(points(9999, 0)) == drawn >> 12U);
}

TEST_CASE("Sobol's points are those of Joe and Kuo but for one shift of their digits") {
  // The table of new-joe-kuo-6: the first points in three dimensions.
  const std::vector<std::vector<double>> joe_kuo{{0, 0, 0},
                                                 {0.5, 0.5, 0.5},
                                                 {0.75, 0.25, 0.25},
                                                 {0.25, 0.75, 0.75},
                                                 {0.375, 0.375, 0.625},
                                                 {0.875, 0.875, 0.125},
                                                 {0.625, 0.125, 0.875}};
  const Eigen::MatrixXd points = unit_points(Sequence::sobol, joe_kuo.size(), 3, 42);
  for (std::size_t i = 0; i < joe_kuo.size(); ++i) {
    for (int d = 0; d < 3; ++d) {
      INFO("point " << i << ", dimension " << d);
      const std::uint64_t unshifted = bits_of(points(static_cast<int>(i), d)) ^ bits_of(points(0, d));
      CHECK(unshifted == bits_of(joe_kuo[i][static_cast<std::size_t>(d)]));
    }
  }
}

TEST_CASE("of 1024 Sobol points each of 1024 equal parts, and each square of 32 by 32, has one") {
  const Eigen::MatrixXd points = unit_points(Sequence::sobol, 1024, 2, 7);
  std::set<std::uint64_t> first, second, squares;
  for (int i = 0; i < 1024; ++i) {
    const auto part = [&](int d, double parts) { return static_cast<std::uint64_t>(points(i, d) * parts); };
    first.insert(part(0, 1024));
    second.insert(part(1, 1024));
    squares.insert(32 * part(0, 32) + part(1, 32));
  }
  CHECK(first.size() == 1024);
  CHECK(second.size() == 1024);
  CHECK(squares.size() == 1024);
}

TEST_CASE(
    "a latin hypercube has one point in each of n equal parts of every dimension, in another order each") {
  const Eigen::MatrixXd points = unit_points(Sequence::latin_hypercube, 777, 3, 11);
  std::vector<std::vector<std::uint64_t>> orders;
  for (int d = 0; d < 3; ++d) {
    std::vector<std::uint64_t> order;
    for (int i = 0; i < 777; ++i) order.push_back(static_cast<std::uint64_t>(points(i, d) * 777));
    std::vector<std::uint64_t> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    for (std::uint64_t i = 0; i < 777; ++i) CHECK(sorted[i] == i);
    for (const auto& other : orders) CHECK(order != other);
    orders.push_back(order);
  }
}

TEST_CASE("the same seed gives the same points, another seed others, and all lie within the unit") {
  for (const Sequence sequence : {Sequence::sobol, Sequence::latin_hypercube, Sequence::random}) {
    const Eigen::MatrixXd points = unit_points(sequence, 300, 4, 3);
    CHECK(points == unit_points(sequence, 300, 4, 3));
    CHECK(points != unit_points(sequence, 300, 4, 4));
    CHECK(points.minCoeff() > 0.0);
    CHECK(points.maxCoeff() < 1.0);
  }
}

TEST_CASE("a longer sequence of Sobol or at random begins with the shorter one") {
  for (const Sequence sequence : {Sequence::sobol, Sequence::random})
    CHECK(unit_points(sequence, 500, 3, 9).topRows(200) == unit_points(sequence, 200, 3, 9));
}

TEST_CASE("Sobol's points find a known mean with a twentieth of the error of random ones") {
  // The mean of exp(u + v) over the unit square is (e - 1)^2; error: root mean square of 20 seeds.
  const double exact = std::pow(std::exp(1.0) - 1.0, 2);
  const auto error = [&](Sequence sequence) {
    double squares = 0.0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Eigen::MatrixXd points = unit_points(sequence, 4096, 2, seed);
      const double mean = points.rowwise().sum().array().exp().mean();
      squares += (mean - exact) * (mean - exact);
    }
    return std::sqrt(squares / 20.0);
  };
  CHECK(error(Sequence::sobol) < 0.05 * error(Sequence::random));
  CHECK(error(Sequence::latin_hypercube) < 0.5 * error(Sequence::random));
}

}  // namespace
}  // namespace sequence_test
