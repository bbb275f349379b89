#include "studies/map/orbit_cost.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "solvers/flow/equations.hpp"
#include "solvers/mechanics/bends.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "studies/map/comparison.hpp"
#include "studies/map/first_modes.hpp"

namespace frahm::studies {
namespace {

// How many more steps a period takes than in a chain of as many storeys: where some motion is fast, as in
// most imported matrices.
double extra_steps(const Study& study, double masses) {
  constexpr double kOfChain = 4.0, kMost = 100.0;
  try {
    const mechanics::NetworkValues values = values_at_first_point(study);
    mechanics::LinearSystem system;
    mechanics::Assembly(study.network).set_values(values, system);
    const double ratio = periodic::fastest_rate(system) / (values.omega * kOfChain * masses);
    return ratio > 1.0 ? std::min(ratio, kMost) : 1.0;
  } catch (const mechanics::MechanicsError&) {
    return 1.0;  // the first point fails
  }
}

// [s] of an orbit with stops, measured: small systems by tables, 0.1 ms at 5 masses with three contacts;
// large ones by their equation, 0.7 to 1.2 ms at 20 with seven, 15 to 20 at 60 with twenty; some
// four times that where the matrices are full.
double with_contacts(const Study& study, double masses, double contacts) {
  constexpr double kFromMasses = 8.0;
  if (masses < kFromMasses) return 3e-6 * std::pow(masses / 2.5, 3.3) * std::max(1.0, 0.5 * (1.0 + contacts));
  const bool full =
      study.network.damping == mechanics::DampingModel::modal || !study.network.matrices.empty();
  const double of_chain = 1.15e-3 * std::pow(masses / 20.0, 2.1) * std::sqrt(contacts / 7.0);
  return (full ? 4.0 : 1.0) * of_chain * extra_steps(study, masses);
}

// [s] beyond a few orders, of which a period takes more steps each, measured: 3 ms at 50 orders, 15 at 100,
// 80 at 200.
double of_orders(const Study& study, double masses) {
  constexpr double kFew = 16.0;
  std::set<int> orders;
  for (const auto& component : study.network.excitations) orders.insert(component.order);
  const double more = std::max(0.0, static_cast<double>(orders.size()) - kFew);
  return 2e-3 * std::max(1.0, masses) * std::pow(more / 30.0, 2.0);
}

// [s] of the search for several orbits, measured: 0.12 ms a start of one mass with stops, 2 ms of two masses.
// A sweep and the responses of the neighbouring points count as a start.
double of_search(const Study& study, const periodic::OrbitsWanted& wanted, double masses) {
  if (!mechanics::may_have_several_responses(study.network)) return 0.0;
  return 2e-4 * (1.0 + (wanted.is_slow_sweep() ? 0 : wanted.starts)) * std::pow(masses, 3.0);
}

double of_searches(const Study& study, double masses) {
  const double own = of_search(study, study.orbits_wanted(), masses);
  const bool compares = study.sweep() && study.sweep()->comparison;
  return compares ? own + of_search(study, compared_orbits(study), masses) : own;
}

}  // namespace

double predicted_orbit_seconds(const Study& study) {
  // [s], of one mass; of one or two under a smooth law, and of each start of its search
  constexpr double kOneMass = 3e-6, kSmooth = 20e-3, kSmoothStart = 50e-3;
  const auto masses = static_cast<double>(study.network.masses.size());
  const auto contacts = static_cast<double>(std::ranges::count_if(
      study.network.elements,
      [](const mechanics::Element& element) { return mechanics::has_contact(element); }));
  const double exact = of_searches(study, masses) + of_orders(study, masses) + kOneMass +
                       (contacts == 0.0 ? kOneMass * masses * masses / 16.0  // a matrix and a vector
                                        : with_contacts(study, masses, contacts));
  if (!meets_smooth_laws(study)) return exact;
  const bool searches = mechanics::may_have_several_responses(study.network);
  const double smooth = searches ? kSmoothStart * study.orbits_wanted().starts : kSmooth;
  return exact + smooth * std::max(1.0, 0.5 * masses);
}

}  // namespace frahm::studies
