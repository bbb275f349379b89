#include "studies/map/value_match.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "solvers/algebra/no_value.hpp"

namespace frahm::studies {
namespace {

struct Value {
  double value = 0.0;
  double rounding = 0.0;  // its largest rounding error
};

// The different values of an axis, ascending.
std::vector<Value> distinct(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  std::vector<Value> result;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    double step = kInfinity;
    if (i > 0) step = sorted[i] - sorted[i - 1];
    if (i + 1 < sorted.size()) step = std::min(step, sorted[i + 1] - sorted[i]);
    const double length = sorted.size() > 1 ? static_cast<double>(sorted.size()) * step : 0.0;
    result.push_back(
        {sorted[i], 2.0 * std::numeric_limits<double>::epsilon() * (std::abs(sorted[i]) + length)});
  }
  return result;
}

std::size_t first_not_below(std::span<const Value> values, double value) {
  return static_cast<std::size_t>(
      std::distance(values.begin(), std::ranges::lower_bound(values, value, {}, &Value::value)));
}

// The rank of the known value equal to this one.
std::uint32_t same_of(std::span<const Value> known, const Value& wanted) {
  const std::size_t above = first_not_below(known, wanted.value);
  std::uint32_t nearest = ValueMatch::none;
  double least = kInfinity;
  for (std::size_t i = above > 0 ? above - 1 : 0; i < std::min(above + 1, known.size()); ++i) {
    const double difference = std::abs(known[i].value - wanted.value);
    if (difference > known[i].rounding + wanted.rounding || difference >= least) continue;
    nearest = static_cast<std::uint32_t>(i);
    least = difference;
  }
  return nearest;
}

}  // namespace

ValueMatch match_values(std::span<const double> known, std::span<const double> wanted) {
  const std::vector<Value> of_known = distinct(known), of_wanted = distinct(wanted);
  ValueMatch match;
  for (const double value : known)
    match.known.push_back(static_cast<std::uint32_t>(first_not_below(of_known, value)));
  std::vector<std::uint32_t> same;
  for (const Value& value : of_wanted) same.push_back(same_of(of_known, value));
  for (const double value : wanted) match.wanted.push_back(same[first_not_below(of_wanted, value)]);
  return match;
}

}  // namespace frahm::studies
