#pragma once

#include <vector>

#include "solvers/mechanics/network.hpp"
#include "solvers/transient/motion.hpp"

// Free vibration from given initial values: exact, with every kind of damping and with Coulomb friction.
//
// One mass with x'' + 2 zeta omega_n x' + omega_n^2 x + (F/m) Sgn(x') = 0 and zeta < 1 turns every
// pi / omega_d, at |x_{i+1}| = beta |x_i| - x_f (1 + beta), beta = exp(-pi zeta/s), s = sqrt(1 - zeta^2),
// x_f = F/k, and rests at the first |x_i| <= x_f. With zeta >= 1 it creeps towards x_f and never arrives.
//
// Masses may be free (mechanics::FreeMasses): dampers and friction bring them to rest where they do,
// otherwise they drift on.
namespace frahm::transient {

struct DecayOptions {
  // [s]; 0: until rest, otherwise until the energy norm has fallen to kDecayed of its start, otherwise
  // kMostPeriods or kStepsByDefault, whichever comes first. Must be given where has_no_end().
  double duration = 0.0;
  int samples = 0;  // of the history, 0: none
  Watch watch = {};
};

// A displacement a millionth of the first: below what any measurement of a decay resolves.
inline constexpr double kDecayed = 1e-6;
// Periods of the lowest mode after which a motion without an end is cut off: undamped, or of zeta < 0.002.
inline constexpr double kMostPeriods = 1000.0;

// Steps of the fastest motion after which a decay without a given duration is cut off: a second or two of
// work for one mass. A stiff or overdamped system reaches this limit first.
inline constexpr double kStepsByDefault = 1e6;
// Steps beyond a given duration, at most, in which the motion's end is sought: a tenth of a second or so.
inline constexpr double kStepsBeyond = 1e5;
// Part of the energy norm at the start: a smaller rest counts as zero and has no extrema any more.
inline constexpr double kGone = 1e-100;

enum class DecayEnd {
  at_rest,   // stopped by friction
  creeping,  // it tends to a position that friction holds; with zeta < 1 it arrives, by less than rounding
             // beyond it
  decayed,   // no friction slides any more, and the energy norm has fallen to kDecayed
  cut_off,   // none of these, as far as it has been followed
  failed,
};

// For a mass or a signal.
struct DecayOfMass {
  std::vector<Extremum> extrema;
  // ln |x_i / x_{i+2}|, a full cycle apart; NaN where there is no x_{i+2}, or one of the two is zero, or
  // where free masses have no place about which they swing. Viscous damping alone: 2 pi zeta/s, the same for
  // all i. Friction makes it grow from cycle to cycle, as it takes the same 4 x_f from each.
  std::vector<double> log_decrement;
  // The position where it rests or to which it tends [m]. NaN: not known, as the motion failed or was
  // cut off, or it drifts on; but of a motion cut off where all modes are damped and nothing else acts it is.
  double rest = 0.0;
  double drift = 0.0;  // velocity at which a free mass drifts on in the end [m/s]; NaN: not known
};

struct FreeDecay {
  DecayEnd end = DecayEnd::failed;
  std::string reason;      // why it failed; empty otherwise
  double duration = 0.0;   // [s] as given, or found
  double stop_time = 0.0;  // [s]; NaN: it does not come to rest within the duration
  // At the duration, relative to the start: the energy norm of the distance from where the motion tends to as
  // its contacts stick and slide then, or from its steady drift. NaN: nothing moved at the start.
  double remainder = 0.0;
  bool has_free_masses = false;
  double hysteretic_omega = 0.0;    // omega_h [rad/s] that was used; NaN where nothing oscillates
  std::vector<DecayOfMass> masses;  // then the signals
  EnergyBudget energy;              // to the duration; of one found at rest, until nothing changes any more
  Samples history;
};

// Whether a decay has no end of its own: no spring makes the masses oscillate, and no damper or friction
// brings them to rest, so that nothing tells how long to follow it.  Throws mechanics::MechanicsError for
// values without a meaning.
bool has_no_end(const mechanics::Network& network, const mechanics::NetworkValues& values);

// values: of the network without excitation; its omega is not used. hysteretic_omega [rad/s]: 0 or NaN means
// the lowest undamped natural frequency.  Throws mechanics::MechanicsError for values without a meaning, and
// where a duration is missing.
//
// A given duration of more steps than the trajectory lasts (10 million) fails.
//
// A motion that ends more gently than kCreeping (turning_points.hpp) counts as one that creeps.
FreeDecay free_decay(const mechanics::Network& network, mechanics::NetworkValues values,
                     const InitialState& initial, const DecayOptions& options);

}  // namespace frahm::transient
