#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string>

namespace frahm::studies {

// A hash of bytes, numbers or a matrix (XXH3, 128 bits, as hex).
std::string digest(std::span<const std::byte> bytes);
std::string digest(std::span<const double> numbers);
std::string digest(const Eigen::MatrixXd& matrix);

}  // namespace frahm::studies
