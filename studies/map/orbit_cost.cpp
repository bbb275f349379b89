#include "studies/map/orbit_cost.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/mechanics/element_table.hpp"
#include "studies/map/comparison.hpp"

namespace frahm::studies {

double predicted_orbit_seconds(const Study& study) {
  constexpr double kOneMass = 3e-6, kArctan = 20e-3;  // [s], of one mass; of one or two under the arctan law
  const auto masses = static_cast<double>(study.network.masses.size());
  const auto contacts = static_cast<double>(std::ranges::count_if(
      study.network.elements,
      [](const mechanics::Element& element) { return mechanics::has_contact(element); }));
  // Without contacts a product of matrix and vector. With them the flow's matrices are multiplied over steps
  // that the fastest mode sets, once more for every configuration met: measured 0.2 ms at 10 masses, 1.5 at
  // 20, 25 at 40, 130 at 60 with one contact; 0.1 ms at 5 with three, 12 at 20 with seven.
  const double by_size = contacts > 0.0 ? std::pow(masses / 2.5, 3.3) : masses * masses / 16.0;
  const double exact = kOneMass * (1.0 + by_size * std::max(1.0, 0.5 * (1.0 + contacts)));
  return meets_arctan_law(study) ? exact + kArctan * std::max(1.0, 0.5 * masses) : exact;
}

}  // namespace frahm::studies
