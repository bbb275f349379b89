#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "results/layout.hpp"

// Numbers as the file stores them: little-endian, in the type of their variable.
namespace frahm::results {

using Bytes = std::vector<std::byte>;

std::size_t element_size(Type type);  // [bytes]
bool is_float(Type type);
double missing_value(Type type);  // the value where nothing was computed

// `values` in the storage type of `variable`.
// Throws std::invalid_argument for a value the type cannot hold. Integers hold whole numbers within their
// range (NaN is none), flags one of the named values; a finite number stored as float32 must be within its
// range.
Bytes to_storage(const Variable& variable, std::span<const double> values);

// `count` elements, all missing.
Bytes missing_elements(Type type, std::size_t count);

}  // namespace frahm::results
