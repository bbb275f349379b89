#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "solvers/quantities/quantity.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// Significant bits (of 52 after the first) that a record keeps: what lies below the error bound of a point
// is noise that takes space and time. A residual, an error bound or an energy balance says an order of
// magnitude.
inline constexpr int most_bits = 48, least_bits = 40, diagnostic_bits = 10;

// The bits that a variable keeps at most; 0: all.  It is real.
int bits_of(const Study& study, const periodic::QuantityDescription& variable);

// Rounds the variables of a point to the bits that its error bound supports: it adds less than a quarter of
// the bound. As much as most_bits where no bound holds, or is recorded, or no peak that it is relative to.
class KnownDigits {
 public:
  // variables: of the record (output_variables()).
  KnownDigits(const Study& study, const std::vector<periodic::QuantityDescription>& variables);

  void round(std::span<double> point) const;

 private:
  int supported_bits(std::span<const double> point) const;

  bool keeps_all_;
  std::vector<int> bits_;           // of each variable; 0: all
  std::vector<std::size_t> peaks_;  // those that are peaks of masses
  std::size_t error_bound_;         // its index; their number: there is none
};

// x to this many bits after the first, to the nearest.
double rounded(double x, int bits);

}  // namespace frahm::studies
