#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

// Points of the unit cube, from which samples of any distribution follow by its quantiles.
namespace frahm::samples {

enum class Sequence {
  sobol,            // Sobol's points, shifted digit by digit at random
  latin_hypercube,  // in each dimension one point in each of n equal parts, at random within it
  random,           // independent of each other
};

// points x dimensions numbers strictly between 0 and 1. They depend on the arguments alone, on every machine:
// the draws are those of std::mt19937_64, by whole numbers.
//
// sobol: the points of Joe and Kuo [19] from the origin on, exclusive or one random number of 64 bits for
// each dimension. The shift keeps how evenly they lie, and makes each point uniform (P. L'Ecuyer and C.
// Lemieux, in Modeling Uncertainty, 2002); leaving out the origin would spoil it (A. B. Owen, arXiv
// 2008.08051). A longer sequence begins with the shorter one; so does `random`.
// Throws std::range_error for more dimensions than there are direction numbers for (3667).
Eigen::MatrixXd unit_points(Sequence sequence, std::size_t points, std::size_t dimensions,
                            std::uint64_t seed);

}  // namespace frahm::samples
