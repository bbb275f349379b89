#include "solvers/mechanics/bends.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "solvers/mechanics/linear_system.hpp"
#include "solvers/mechanics/smooth_laws.hpp"

namespace frahm::mechanics {
namespace {

void require_number(double value, bool is_allowed, const Element& element, const char* key,
                    const char* rule) {
  if (is_allowed) return;
  std::ostringstream message;
  message << key << " of '" << element.name << "' = " << value << ": " << rule;
  throw MechanicsError(message.str());
}

void check_bend(const Element& element, const laws::Bend& law, const BendValue& value) {
  const char* place = law.pulls ? "a point of the table" : "the clearance";
  require_number(value.place, std::isfinite(value.place), element, place, "must be finite");
  require_number(value.stiffness, std::isfinite(value.stiffness), element, "stiffness", "must be finite");
  require_number(value.damping, std::isfinite(value.damping), element, "damping", "must be finite");
  if (law.pulls) return;
  require_number(value.stiffness, value.stiffness >= 0.0, element, "stiffness", "must not be negative");
  require_number(value.damping, value.damping >= 0.0, element, "damping", "must not be negative");
}

// Whether the slopes of a characteristic, c between its bends on both sides, stay at or above zero.
bool never_falls(const Element& element, double c, const std::vector<BendValue>& bends) {
  for (const double side : {1.0, -1.0}) {
    std::vector<std::pair<double, double>> changes;  // place, change of the slope
    for (std::size_t i = 0; i < bends.size(); ++i)
      if (element.bends[i].side == side) changes.emplace_back(bends[i].place, bends[i].damping);
    std::sort(changes.begin(), changes.end());
    double slope = c;
    for (const auto& [place, change] : changes) {
      slope += change;
      if (slope < -1e-12 * std::abs(change)) return false;
    }
  }
  return true;
}

}  // namespace

Bends place_bends(const Network& network, const std::vector<Incidence>& incidences) {
  Bends bends;
  std::size_t count = 0;
  for (const Element& element : network.elements) count += element.bends.size();
  const auto b = static_cast<Eigen::Index>(count);
  bends.W.setZero(static_cast<Eigen::Index>(network.masses.size()), b);
  bends.W_support.setZero(static_cast<Eigen::Index>(network.prescribed.size()), b);
  bends.stiffness.setZero(b);
  bends.damping.setZero(b);
  bends.place.setZero(b);
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    for (const BendPlace& bend : network.elements[e].bends) {
      const auto column = static_cast<Eigen::Index>(bends.law.size());
      bends.W.col(column) = bend.side * incidences[e].w;
      bends.W_support.col(column) = bend.side * incidences[e].p;
      bends.law.push_back(bend.law);
      bends.side.push_back(bend.side);
      bends.element.push_back(e);
    }
  }
  return bends;
}

void set_bends(const Network& network, const NetworkValues& values, Bends& bends) {
  Eigen::Index column = 0;
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    const Element& element = network.elements[e];
    for (std::size_t i = 0; i < element.bends.size(); ++i, ++column) {
      const BendValue& value = values.bends[e][i];
      check_bend(element, *element.bends[i].law, value);
      bends.place[column] = value.place;
      bends.stiffness[column] = value.stiffness;
      bends.damping[column] = value.damping;
    }
  }
}

bool has_stop(const Network& network) {
  return std::any_of(network.elements.begin(), network.elements.end(), [](const Element& element) {
    return std::any_of(element.bends.begin(), element.bends.end(),
                       [](const BendPlace& bend) { return !bend.law->of_velocity; });
  });
}

bool may_have_several_responses(const Network& network) {
  return std::any_of(network.elements.begin(), network.elements.end(), [](const Element& element) {
    return element.has_static_force || !element.bends.empty() || may_have_several_responses(element.law);
  });
}

bool are_monotone(const Network& network, const NetworkValues& values) {
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    const Element& element = network.elements[e];
    if (element.bends.empty()) continue;
    const bool bends_over_velocity = std::all_of(element.bends.begin(), element.bends.end(),
                                                 [](const BendPlace& bend) { return bend.law->of_velocity; });
    if (!bends_over_velocity || !never_falls(element, values.element[e], values.bends[e])) return false;
  }
  return true;
}

}  // namespace frahm::mechanics
