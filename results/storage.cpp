#include "results/storage.hpp"

#include <fmt/core.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace frahm::results {
namespace {

static_assert(std::endian::native == std::endian::little, "the file's numbers are little-endian");

[[noreturn]] void refuse(const Variable& variable, double value, const char* rule) {
  throw std::invalid_argument(fmt::format("variable '{}': value {}: must be {}", variable.name, value, rule));
}

// `to_number` turns one value into the stored number, or throws.
template <typename Number, typename Convert>
Bytes convert(std::span<const double> values, Convert to_number) {
  Bytes bytes(values.size() * sizeof(Number));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Number number = to_number(values[i]);
    std::memcpy(bytes.data() + i * sizeof(Number), &number, sizeof(Number));
  }
  return bytes;
}

Bytes to_float32(const Variable& variable, std::span<const double> values) {
  constexpr double largest = std::numeric_limits<float>::max();
  return convert<float>(values, [&](double value) {
    if (std::isfinite(value) && std::abs(value) > largest)
      refuse(variable, value, "within the range of float32");
    return static_cast<float>(value);
  });
}

Bytes to_int32(const Variable& variable, std::span<const double> values) {
  constexpr double largest = std::numeric_limits<std::int32_t>::max();
  return convert<std::int32_t>(values, [&](double value) {
    if (!(std::abs(value) <= largest) || value != std::trunc(value)) {
      refuse(variable, value, "a whole number within the range of int32");
    }
    return static_cast<std::int32_t>(value);
  });
}

Bytes to_int64(const Variable& variable, std::span<const double> values) {
  constexpr double largest = 9007199254740992.0;  // 2^53: beyond it a double skips whole numbers
  return convert<std::int64_t>(values, [&](double value) {
    if (!(std::abs(value) <= largest) || value != std::trunc(value)) {
      refuse(variable, value, "a whole number of at most 2^53");
    }
    return static_cast<std::int64_t>(value);
  });
}

Bytes to_flag(const Variable& variable, std::span<const double> values) {
  std::array<bool, 128> named{};
  for (const Flag& flag : variable.flags) named[static_cast<std::size_t>(flag.value)] = true;
  return convert<std::int8_t>(values, [&](double value) {
    if (!(value >= 0.0 && value < 128.0) || value != std::trunc(value) ||
        !named[static_cast<std::size_t>(value)]) {
      refuse(variable, value, "one of its flag values");
    }
    return static_cast<std::int8_t>(value);
  });
}

}  // namespace

std::size_t element_size(Type type) {
  switch (type) {
    case Type::float64:
    case Type::int64:
      return 8;
    case Type::float32:
    case Type::int32:
      return 4;
    case Type::flag:
      return 1;
  }
  throw std::logic_error("unknown results::Type");
}

bool is_float(Type type) {
  return type == Type::float64 || type == Type::float32;
}

double missing_value(Type type) {
  if (is_float(type)) return std::numeric_limits<double>::quiet_NaN();
  return type == Type::flag ? 0.0 : -1.0;
}

Bytes to_storage(const Variable& variable, std::span<const double> values) {
  switch (variable.type) {
    case Type::float64:
      return convert<double>(values, [](double value) { return value; });
    case Type::float32:
      return to_float32(variable, values);
    case Type::int64:
      return to_int64(variable, values);
    case Type::int32:
      return to_int32(variable, values);
    case Type::flag:
      return to_flag(variable, values);
  }
  throw std::logic_error("unknown results::Type");
}

Bytes missing_elements(Type type, std::size_t count) {
  const std::vector<double> values(count, missing_value(type));
  const Variable unnamed{.name = {}, .type = type, .flags = {{"not_computed", 0}}};
  return to_storage(unnamed, values);
}

}  // namespace frahm::results
