#include "studies/map/way_of_slow_sweep.hpp"

#include <algorithm>
#include <utility>

namespace frahm::studies {

std::vector<std::vector<double>> way_of_slow_sweep(const Study& study, const periodic::OrbitsWanted& wanted,
                                                   std::span<const double> parameters) {
  const double sign = wanted.show == periodic::OrbitsWanted::Show::down ? -1.0 : 1.0;
  mechanics::NetworkValues values;
  const auto place = [&](std::vector<double>& point) {
    evaluate(study.values, study.parameters, point, values);
    return sign * values.omega;
  };
  std::vector<double> end(parameters.begin(), parameters.end());
  const double last = place(end);
  std::vector<std::pair<double, std::vector<double>>> passed;
  if (wanted.is_slow_sweep()) {
    const std::size_t along = *study.sweep()->frequency_dimension;
    for (std::size_t i = 0; i < study.map()->dimensions[along].size; ++i) {
      std::vector<double> point = end;
      set_along(*study.sweep(), along, i, point);
      const double at = place(point);
      if (at < last) passed.emplace_back(at, std::move(point));
    }
  }
  std::ranges::stable_sort(passed, {}, &std::pair<double, std::vector<double>>::first);
  std::vector<std::vector<double>> way;
  for (auto& [at, point] : passed) way.push_back(std::move(point));
  way.push_back(std::move(end));
  return way;
}

}  // namespace frahm::studies
