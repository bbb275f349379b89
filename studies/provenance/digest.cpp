#include "studies/provenance/digest.hpp"

#include <fmt/format.h>
#include <xxhash.h>

namespace frahm::studies {

std::string digest(std::span<const std::byte> bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::string digest(std::span<const double> numbers) {
  return digest(std::as_bytes(numbers));
}

std::string digest(const Eigen::MatrixXd& matrix) {
  return digest(std::span(matrix.data(), static_cast<std::size_t>(matrix.size())));
}

}  // namespace frahm::studies
