#include "solvers/mechanics/network_values.hpp"

#include <cstddef>
#include <vector>

namespace frahm::mechanics {

void add(const NetworkValues& values, double factor, NetworkValues& sum) {
  const auto add_list = [factor](const std::vector<double>& list, std::vector<double>& to) {
    for (std::size_t i = 0; i < list.size(); ++i) to[i] += factor * list[i];
  };
  sum.omega += factor * values.omega;
  add_list(values.mass, sum.mass);
  add_list(values.element, sum.element);
  add_list(values.second, sum.second);
  add_list(values.damping, sum.damping);
  if (sum.bends.size() < values.bends.size()) sum.bends.resize(values.bends.size());
  for (std::size_t e = 0; e < values.bends.size(); ++e) {
    if (sum.bends[e].size() < values.bends[e].size()) sum.bends[e].resize(values.bends[e].size());
    for (std::size_t i = 0; i < values.bends[e].size(); ++i) {
      sum.bends[e][i].place += factor * values.bends[e][i].place;
      sum.bends[e][i].stiffness += factor * values.bends[e][i].stiffness;
      sum.bends[e][i].damping += factor * values.bends[e][i].damping;
    }
  }
  for (std::size_t i = 0; i < values.excitation.size(); ++i) {
    sum.excitation[i].amplitude += factor * values.excitation[i].amplitude;
    sum.excitation[i].phase += factor * values.excitation[i].phase;
    sum.excitation[i].rod += factor * values.excitation[i].rod;
  }
  sum.hysteretic_omega += factor * values.hysteretic_omega;
}

}  // namespace frahm::mechanics
