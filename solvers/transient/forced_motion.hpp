#pragma once

#include <span>
#include <vector>

#include "solvers/mechanics/linear_system.hpp"
#include "solvers/mechanics/network.hpp"
#include "solvers/transient/motion.hpp"
#include "solvers/transient/motion_quantity.hpp"
#include "solvers/transient/record.hpp"

// Forced motion from given initial values: at one frequency, running through a range of them, or under
// records.
namespace frahm::transient {

// The excitation's phase: omega t at constant frequency; in a run-up or run-down
//   phi(t) = omega_0 t + alpha t^2 / 2  until the frequency has reached `to`, where it stays.
struct RunUp {
  double to = 0.0;    // [rad/s], > 0
  double rate = 0.0;  // |alpha| [rad/s^2], > 0
};

struct ForcedOptions {
  double from = 0.0;                             // frequency at t = 0 [rad/s], > 0
  RunUp run_up = {};                             // rate 0: none; must be none with records
  std::vector<RecordedExcitation> records = {};  // of each recorded component of the excitation
  double duration = 0.0;                         // [s], > 0
  int samples = 0;
  Watch watch = {};
  std::span<const MotionQuantity> quantities = {};  // if not empty, ForcedMotion::numbers are these
  bool extrema = false;  // ForcedMotion::extrema and peaks are kept, whatever the quantities
  // Energies are followed, and a motion whose energies do not balance fails, whatever is asked of it.
  // Without, it is for a search whose outcome is weighed.
  bool weighed = true;
};

struct ForcedMotion {
  std::string failure;  // why the motion could not be completed; empty: it is complete
  Samples history;
  std::vector<double> frequency;            // at the history's times [rad/s]
  std::vector<Extremum> peaks;              // of each mass, then of each signal, the largest |displacement|
  std::vector<std::vector<Stop>> stops;     // of each friction contact
  std::vector<std::vector<Touch>> touches;  // of each bend, in the order of mechanics::Bends
  EnergyBudget energy;                      // to the duration
  // For a run-up: the largest change of any sample of a mass [m] when the stairs were last halved; NaN
  // otherwise. The error that remains is a fraction of it, as halving divides it by four or more.
  double discretisation_error = 0.0;
  int stairs = 0;                                   // of a run-up
  std::vector<double> numbers = {};                 // of the quantities asked for
  std::vector<std::vector<Extremum>> extrema = {};  // of each mass, then of each signal; empty: not asked for
};

// Whether some element or signal asks where a belt is, not only for its velocity: the spring by which
// something is pulled along.
bool asks_where_belts_are(const mechanics::Network& network);

// The frequency [rad/s] that limits the length of a step. It is options.from; but where nothing in the
// excitation oscillates it means nothing else, and free masses may have no rate of their own: then it is one
// of which the duration has a hundred steps.
double stepping_frequency(const mechanics::Assembly& assembly, const mechanics::NetworkValues& values,
                          const ForcedOptions& options);

// The flow is exact at constant frequency. A run-up is cut into stairs of constant frequency each, that of
// their middle, so that the phase is exact at every stair's ends but for a constant,
//   phi - phi_stair = alpha (t - t_a)(t - t_b) / 2 + alpha tau^2 / 12,
// which makes its mean over each stair zero. Stairs are halved until the motion changes by less than
// kRunUpTolerance of its largest peak. A prescribed motion has its acceleration's part from the changing
// frequency too: y'' = (i alpha - omega^2) Y e^{i phi}.
//
// A belt that is asked where it is moves as under a record of its velocity, V t from the start on.
//
// Records are exact too: polynomials from one of their samples to the next, at which passages begin.
//
// Throws mechanics::MechanicsError for values and records without a meaning, and for a motion that outlasts a
// record after whose end its support's motion is not known (is_known_behind).
ForcedMotion forced_motion(const mechanics::Network& network, const ValuesAt& values_at,
                           const InitialState& initial, const ForcedOptions& options);

inline constexpr double kRunUpTolerance = 1e-6;  // of the largest peak: finer than any plot or sensor

}  // namespace frahm::transient
