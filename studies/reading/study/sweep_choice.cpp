#include "studies/reading/study/sweep_choice.hpp"

#include <algorithm>
#include <cmath>

namespace frahm::studies {

bool is_on_axis(double value, double of_axis) {
  constexpr double rounding = 1e-9;
  return std::abs(value - of_axis) <= rounding * std::max(std::abs(value), std::abs(of_axis));
}

std::vector<std::size_t> elements_with_events(const mechanics::Network& network) {
  std::vector<std::size_t> found;
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    const mechanics::Element& element = network.elements[e];
    const bool has_events = mechanics::has_contact(element) || !element.bends.empty();
    if (has_events && mechanics::reported_by(network, e) == e) found.push_back(e);
  }
  return found;
}

bool SweepChoice::sweeps_frequency() const {
  return orbits.is_slow_sweep() ||
         (comparison && comparison->show && periodic::OrbitsWanted::is_slow_sweep(*comparison->show));
}

std::vector<const StudyValue*> SweepChoice::values() const {
  std::vector<const StudyValue*> all;
  if (comparison && comparison->law == mechanics::ForceLaw::arctan) all.push_back(&comparison->slope);
  return all;
}

}  // namespace frahm::studies
