#include "studies/map/known_digits.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace frahm::studies {

double rounded(double x, int bits) {
  constexpr int stored = 52;
  if (bits <= 0 || bits >= stored || !std::isfinite(x)) return x;
  const int dropped = stored - bits;
  const auto whole = std::bit_cast<std::uint64_t>(x);
  // Ties to even, as arithmetic rounds; a carry into the exponent is the next power of two.
  const std::uint64_t half = (std::uint64_t{1} << (dropped - 1)) - 1 + ((whole >> dropped) & 1);
  return std::bit_cast<double>((whole + half) >> dropped << dropped);
}

int bits_of(const Study& study, const periodic::QuantityDescription& variable) {
  if (variable.kind != periodic::QuantityKind::real || study.map()->output.precision == Precision::full)
    return 0;
  const bool is_diagnostic =
      variable.name == "residual" || variable.name == "error_bound" || variable.name == "energy_balance";
  return is_diagnostic ? diagnostic_bits : most_bits;
}

KnownDigits::KnownDigits(const Study& study, const std::vector<periodic::QuantityDescription>& variables)
    : keeps_all_(study.map()->output.precision == Precision::full), error_bound_(variables.size()) {
  for (std::size_t i = 0; i < variables.size(); ++i) {
    bits_.push_back(bits_of(study, variables[i]));
    if (variables[i].name == "error_bound") error_bound_ = i;
    const bool is_peak = std::ranges::any_of(
        study.network.masses, [&](const std::string& mass) { return variables[i].name == mass + "_peak"; });
    if (is_peak) peaks_.push_back(i);
  }
}

void KnownDigits::round(std::span<double> point) const {
  if (keeps_all_) return;
  const int supported = supported_bits(point);
  for (std::size_t i = 0; i < point.size(); ++i) {
    if (bits_[i] != 0) point[i] = rounded(point[i], std::min(bits_[i], supported));
  }
}

// 2^-bits is below the bound over the largest peak, and rounding to the nearest is off by a quarter of that
// at most.
int KnownDigits::supported_bits(std::span<const double> point) const {
  if (error_bound_ == point.size()) return most_bits;
  double peak = 0.0;
  for (const std::size_t i : peaks_) peak = std::max(peak, point[i]);
  const double relative = rounded(point[error_bound_], diagnostic_bits) / peak;
  if (!(relative > 0.0 && std::isfinite(relative))) return most_bits;
  return std::clamp(1 - std::ilogb(relative), least_bits, most_bits);
}

}  // namespace frahm::studies
