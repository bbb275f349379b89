#include "solvers/samples/sequence.hpp"

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace frahm::samples {
namespace {

using Generator = std::mt19937_64;

constexpr double largest_share = 1.0 - 0x1p-53;  // a sum may round to 1

// The middle of one of 2^52 equal parts: never 0 or 1.
double share_of(std::uint64_t bits) {
  return std::ldexp(static_cast<double>(bits >> 12U) + 0.5, -52);
}

// A whole number from 0 to n - 1, each as likely: draws beyond the last multiple of n are drawn again.
std::uint64_t draw_below(Generator& generator, std::uint64_t n) {
  const std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  const std::uint64_t beyond = most - most % n;
  for (;;) {
    const std::uint64_t drawn = generator();
    if (drawn < beyond) return drawn % n;
  }
}

Eigen::MatrixXd sobol_points(std::size_t points, std::size_t dimensions, Generator& generator) {
  Eigen::MatrixXd result(points, dimensions);
  std::vector<std::uint64_t> shift(dimensions);
  for (std::uint64_t& each : shift) each = generator();
  boost::random::sobol sequence(dimensions);  // begins after the origin
  for (std::size_t i = 0; i < points; ++i) {
    for (std::size_t d = 0; d < dimensions; ++d)
      result(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(d)) =
          share_of((i == 0 ? 0 : std::uint64_t{sequence()}) ^ shift[d]);
  }
  return result;
}

// Fisher and Yates: each order of 0 ... n - 1 as likely.
std::vector<std::uint64_t> random_order(std::size_t n, Generator& generator) {
  std::vector<std::uint64_t> order(n);
  std::iota(order.begin(), order.end(), std::uint64_t{0});
  for (std::size_t i = n; i > 1; --i) std::swap(order[i - 1], order[draw_below(generator, i)]);
  return order;
}

Eigen::MatrixXd latin_hypercube(std::size_t points, std::size_t dimensions, Generator& generator) {
  Eigen::MatrixXd result(points, dimensions);
  for (Eigen::Index d = 0; d < result.cols(); ++d) {
    const std::vector<std::uint64_t> part = random_order(points, generator);
    for (Eigen::Index i = 0; i < result.rows(); ++i)
      result(i, d) =
          std::min((static_cast<double>(part[static_cast<std::size_t>(i)]) + share_of(generator())) /
                       static_cast<double>(points),
                   largest_share);
  }
  return result;
}

Eigen::MatrixXd random_points(std::size_t points, std::size_t dimensions, Generator& generator) {
  Eigen::MatrixXd result(points, dimensions);
  for (Eigen::Index i = 0; i < result.rows(); ++i) {
    for (Eigen::Index d = 0; d < result.cols(); ++d) result(i, d) = share_of(generator());
  }
  return result;
}

}  // namespace

Eigen::MatrixXd unit_points(Sequence sequence, std::size_t points, std::size_t dimensions,
                            std::uint64_t seed) {
  Generator generator(seed);
  switch (sequence) {
    case Sequence::sobol:
      return sobol_points(points, dimensions, generator);
    case Sequence::latin_hypercube:
      return latin_hypercube(points, dimensions, generator);
    case Sequence::random:
      break;
  }
  return random_points(points, dimensions, generator);
}

}  // namespace frahm::samples
