#include "results/variable_io.hpp"

#include <fmt/core.h>

#include <sstream>

#include "results/storage.hpp"
#include "results/store_error.hpp"

namespace frahm::results {
namespace {

void describe_flags(hdf5::Dataset& dataset, const Variable& variable) {
  std::vector<double> values;
  std::string meanings;
  for (const Flag& flag : variable.flags) {
    values.push_back(flag.value);
    meanings += (meanings.empty() ? "" : " ") + flag.meaning;
  }
  dataset.write_numbers("flag_values", variable, values);
  dataset.write_text("flag_meanings", meanings);
}

// The convention of netCDF for values that were rounded to so many bits ("BitRound"); they are plain numbers.
constexpr const char* kRounded = "_QuantizeBitRoundNumberOfSignificantBits";

std::vector<Flag> described_flags(const hdf5::Dataset& dataset) {
  const auto values = dataset.numbers("flag_values");
  const auto meanings = dataset.text("flag_meanings");
  if (!values || !meanings) throw StoreError(dataset.where(), "must have flag_values and flag_meanings", "");
  std::vector<Flag> flags;
  std::istringstream words(*meanings);
  for (const double value : *values) {
    std::string meaning;
    if (!(words >> meaning)) throw StoreError(dataset.where(), "must have a meaning for each flag value", "");
    if (!(value >= 0 && value <= 127))
      throw StoreError(dataset.where(), fmt::format("its flag value {} must be from 0 to 127", value), "");
    flags.push_back({meaning, static_cast<int>(value)});
  }
  return flags;
}

}  // namespace

void describe(hdf5::Dataset& dataset, const Variable& variable, bool missing) {
  if (!variable.unit.empty()) dataset.write_text("units", variable.unit);
  dataset.write_text("long_name", variable.long_name);
  if (variable.type == Type::flag) describe_flags(dataset, variable);
  if (variable.significant_bits > 0) {
    const double bits = variable.significant_bits;
    dataset.write_numbers(kRounded, {.name = variable.name, .type = Type::int32}, {&bits, 1});
  }
  if (missing && is_float(variable.type)) {
    const double value = missing_value(variable.type);
    dataset.write_numbers("_FillValue", variable, {&value, 1});
  }
}

Variable described(const hdf5::Dataset& dataset) {
  Variable variable{.name = dataset.name(), .type = dataset.type()};
  const auto long_name = dataset.text("long_name");
  if (!long_name) throw StoreError(dataset.where(), "must have a long_name", "");
  variable.long_name = *long_name;
  if (variable.type == Type::flag) {
    variable.flags = described_flags(dataset);
    return variable;
  }
  const auto unit = dataset.text("units");
  if (!unit) throw StoreError(dataset.where(), "must have units", "");
  variable.unit = *unit;
  if (const auto bits = dataset.numbers(kRounded)) {
    constexpr double most_bits = 52;  // of a float64
    if (bits->size() != 1 || !(bits->front() >= 0 && bits->front() <= most_bits))
      throw StoreError(dataset.where(), fmt::format("{} must be a number of bits, 0 to 52", kRounded), "");
    variable.significant_bits = static_cast<int>(bits->front());
  }
  return variable;
}

Variable index_variable(const std::string& dimension) {
  return {.name = dimension, .unit = "1", .long_name = "index of " + dimension, .type = Type::int64};
}

bool is_index(const hdf5::Dataset& dataset) {
  return dataset.is_scale() && dataset.type() == Type::int64;
}

}  // namespace frahm::results
