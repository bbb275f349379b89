#include "studies/map/motion_cost.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/flow/equations.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "studies/map/first_modes.hpp"
#include "studies/motion/one_motion.hpp"

namespace frahm::studies {
namespace {

// [s] of a step with its quantities, measured from 1 to 40 masses with up to 20 contacts; large systems go by
// their sparse matrices.
double step_seconds(double masses) {
  return 1e-6 * (1.0 + 0.4 * masses);
}

}  // namespace

double predicted_motion_seconds(const Study& study) {
  constexpr double kAtLeast = 1e-4;  // of setting a motion up
  constexpr double kOfRunUp = 8.0;   // its stairs are halved until the motion stands, three times or so
  constexpr double kUnknown = 1e-2;  // of a first point without a meaning, which fails
  const std::vector<double> parameters = parameters_at_first_point(study);
  try {
    const transient::ForcedOptions options = forced_options(study, parameters);
    const mechanics::Assembly assembly(study.network, free_masses(study.kind(), study.network));
    const mechanics::NetworkValues values = values_at_first_point(study);
    mechanics::LinearSystem system;
    assembly.set_values(values, system);
    const double fastest =
        std::max({periodic::fastest_rate(system), transient::stepping_frequency(assembly, values, options),
                  options.run_up.to});
    const double steps = options.duration * fastest / periodic::kStepRate;
    const double runs = options.run_up.rate > 0.0 ? kOfRunUp : 1.0;
    const double seconds =
        kAtLeast + runs * steps * step_seconds(static_cast<double>(study.network.masses.size()));
    return std::isfinite(seconds) ? seconds : kUnknown;
  } catch (const mechanics::MechanicsError&) {
    return kUnknown;
  } catch (const StudyError&) {
    return kUnknown;
  }
}

}  // namespace frahm::studies
