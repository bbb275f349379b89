#include "studies/program/point_responses.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solvers/quantities/quantity.hpp"
#include "solvers/response/common_divisor.hpp"

namespace frahm::studies {
namespace {

using Number = FoundResponse::Number;

bool has_state(const mechanics::Element& element) {
  return element.type == mechanics::ElementType::maxwell || element.type == mechanics::ElementType::jenkins;
}

// The samples of a history that are part of the state, by their columns: those of sliders come last.
std::vector<std::size_t> state_columns(const mechanics::Network& network) {
  std::vector<std::size_t> columns;
  std::size_t column = 0, sliders = 0;
  for (; column < 2 * network.masses.size(); ++column) columns.push_back(column);
  for (const mechanics::Element& element : network.elements) {
    if (element.parts == 0) continue;
    if (has_state(element) && element.parts == 1) columns.push_back(column);
    ++column;
  }
  for (const mechanics::Element& element : network.elements) sliders += element.parts > 1 ? element.parts : 0;
  const std::size_t all = periodic::History::of(network, periodic::SliderForces::each).columns.size();
  for (column = all - sliders; column < all; ++column) columns.push_back(column);
  return columns;
}

class Responses {
 public:
  Responses(const Study& study, std::span<const periodic::Quantity> quantities,
            periodic::PeriodicResponse& response)
      : study_(study), quantities_(quantities), response_(response), columns_(state_columns(study.network)) {}

  // The response that is reported now.
  void add() {
    FoundResponse found;
    std::vector<double> values(quantities_.size());
    response_.quantities(values);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const periodic::Quantity& quantity = quantities_[i];
      if (quantity.measure == periodic::Measure::period_multiple)
        found.period_multiple = static_cast<int>(values[i]);
      if (quantity.measure != periodic::Measure::peak) continue;
      const auto description = periodic::describe(quantity, study_.network, study_.dimensionless);
      found.peaks.push_back({description.name, description.unit, values[i]});
    }
    found.multipliers = response_.multipliers();
    found.state = state_at(0.0);
    found.mirror_of = mirrored(found);
    found_.push_back(std::move(found));
  }

  std::vector<Number> state_at(double phase) {
    const periodic::History history =
        response_.history(std::vector<double>{phase}, periodic::SliderForces::each);
    std::vector<Number> state;
    for (const std::size_t i : columns_)
      state.push_back(
          {history.names[i], study_.dimensionless ? "1" : history.units[i], history.columns[i].front()});
    return state;
  }

  // The one with this state at omega t = 0 is that of the point.
  std::vector<FoundResponse> result(const std::vector<Number>& shown) {
    double nearest = HUGE_VAL;
    std::size_t place = 0;
    for (std::size_t i = 0; i < found_.size(); ++i) {
      const double off = distance(found_[i].state, shown, 1.0);
      if (off < nearest) nearest = off, place = i;
    }
    if (!found_.empty()) found_[place].is_shown = true;
    return std::move(found_);
  }

 private:
  // Largest difference of a number of b from `sign` times that of a, relative to the largest there.
  static double distance(const std::vector<Number>& a, const std::vector<Number>& b, double sign) {
    double most = 0.0, size = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      most = std::max(most, std::abs(sign * a[i].value - b[i].value));
      size = std::max({size, std::abs(a[i].value), std::abs(b[i].value)});
    }
    return size > 0.0 ? most / size : most;
  }

  // An earlier one of which the response told now is the mirror image: its state half a period of the
  // excitation later, with the opposite sign, is the other one's.
  std::optional<std::size_t> mirrored(const FoundResponse& found) {
    constexpr double kSame = 1e-6;
    const int parts = periodic::common_divisor(study_.network) * found.period_multiple;
    for (int k = 0; k < parts && !found_.empty(); ++k) {
      const std::vector<Number> later = state_at(std::numbers::pi * (2 * k + 1) / parts);
      if (distance(later, found.state, -1.0) < kSame) return std::nullopt;  // its own image
      for (std::size_t i = 0; i < found_.size(); ++i)
        if (distance(later, found_[i].state, -1.0) < kSame) return i;
    }
    return std::nullopt;
  }

  const Study& study_;
  std::span<const periodic::Quantity> quantities_;
  periodic::PeriodicResponse& response_;
  std::vector<std::size_t> columns_;
  std::vector<FoundResponse> found_;
};

}  // namespace

std::vector<FoundResponse> found_responses(const Study& study, std::span<const periodic::Quantity> quantities,
                                           periodic::PeriodicResponse& response, int coexisting) {
  Responses responses(study, quantities, response);
  const std::vector<Number> shown = responses.state_at(0.0);
  if (coexisting <= 1) responses.add();
  for (int which = 0; which < coexisting && coexisting > 1; ++which) {
    response.tell(which);
    responses.add();
  }
  return responses.result(shown);
}

}  // namespace frahm::studies
