#include "solvers/mechanics/halfway.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace frahm::mechanics {
namespace {

double mean(double a, double b) {
  return 0.5 * a + 0.5 * b;
}

void take_means(std::vector<double>& into, const std::vector<double>& other) {
  std::ranges::transform(into, other, into.begin(), mean);
}

}  // namespace

NetworkValues halfway(const NetworkValues& a, const NetworkValues& b) {
  NetworkValues result = a;
  result.omega = mean(a.omega, b.omega);
  result.hysteretic_omega = mean(a.hysteretic_omega, b.hysteretic_omega);
  take_means(result.mass, b.mass);
  take_means(result.element, b.element);
  take_means(result.second, b.second);
  take_means(result.damping, b.damping);
  for (std::size_t i = 0; i < result.excitation.size(); ++i) {
    ExcitationValue& value = result.excitation[i];
    value.amplitude = mean(value.amplitude, b.excitation[i].amplitude);
    value.phase = mean(value.phase, b.excitation[i].phase);
    value.rod = mean(value.rod, b.excitation[i].rod);
  }
  for (std::size_t e = 0; e < result.bends.size(); ++e) {
    for (std::size_t i = 0; i < result.bends[e].size(); ++i) {
      BendValue& value = result.bends[e][i];
      value.place = mean(value.place, b.bends[e][i].place);
      value.stiffness = mean(value.stiffness, b.bends[e][i].stiffness);
      value.damping = mean(value.damping, b.bends[e][i].damping);
    }
  }
  return result;
}

}  // namespace frahm::mechanics
