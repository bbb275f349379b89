#include "solvers/samples/normal_numbers.hpp"

#include "solvers/samples/elementary.hpp"

namespace frahm::samples {
namespace {

std::mt19937_64 seeded(std::uint64_t seed, std::uint32_t stream) {
  std::seed_seq words{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32), stream};
  return std::mt19937_64(words);
}

}  // namespace

NormalNumbers::NormalNumbers(std::uint64_t seed, std::uint32_t stream) : generator_(seeded(seed, stream)) {}

// The middles of 2^52 equal parts of the unit interval, each of which a double holds exactly.
double NormalNumbers::uniform() {
  return (static_cast<double>(generator_() >> 12) + 0.5) * 0x1p-52;
}

// Ratio of uniforms: v/u is normal where (u, v) is uniform in  v^2 <= -4 u^2 ln u,  which lies within
// 0 < u <= 1, |v| <= sqrt(2/e).
// Source: Kinderman and Monahan, ACM Transactions on Mathematical Software 3 (1977) 257-260.
double NormalNumbers::next() {
  constexpr double width = 1.7155277699214135;  // 2 sqrt(2/e)
  for (;;) {
    const double u = uniform();
    const double ratio = width * (uniform() - 0.5) / u;
    if (ratio * ratio <= -4.0 * logarithm(u)) return ratio;
  }
}

}  // namespace frahm::samples
