#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "solvers/mechanics/network.hpp"
#include "solvers/quantities/quantity.hpp"

// A branch of periodic orbits: the curve that they form as one parameter changes, stable and unstable ones
// alike, through the folds where it turns back. It is followed by its arclength (Keller, in Rabinowitz (ed.),
// Applications of Bifurcation Theory, 1977, pp. 359-384).
namespace frahm::periodic {

// The numbers of the network at a value of the parameter, and their derivative by it.
struct ValuesAlong {
  std::function<mechanics::NetworkValues(double parameter)> at, derivative;
};

struct BranchPoint {
  double parameter = 0.0;
  double arclength = 0.0;          // from the first point, of the scaled curve (BranchMap)
  std::vector<double> quantities;  // those asked for
  double floquet_radius = 0.0;     // of the orbit's whole period; NaN where an event only just happens
  bool stable = false;
  int multiple = 1;          // of the excitation's period, that the orbit takes
  double residual = 0.0;     // of the periodic condition, relative, energy norm
  bool is_balanced = false;  // false: its energies do not balance, and its quantities are missing
};

enum class SpecialKind {
  fold,             // the parameter turns back: dp/ds = 0
  branching,        // a multiplier passes +1 and the parameter goes on: another branch crosses, as where a
                    // symmetric orbit gives way to a pair that is not
  period_doubling,  // a multiplier passes -1
  torus,            // a pair of complex multipliers passes the unit circle
  stability_jump,   // a multiplier jumps across the unit circle where an event begins
  grazing,          // an event begins or ends to happen: a stop is only just touched, a contact only just
                    // stops or lets go; or two events change their order
  jump,             // where the branch ends: an event begins that throws the motion elsewhere
  corner,           // a grazing where the map has a kink and the parameter turns back: dp/ds jumps across 0
};
const char* kind_name(SpecialKind kind);  // "fold", "period_doubling"

struct SpecialPoint {
  SpecialKind kind = SpecialKind::fold;
  BranchPoint at;
  std::size_t next = 0;  // index of the point of the branch after it; their number beyond the last
  // For a grazing, a jump, and of a corner where it is known: whose event it is, index in Network::elements.
  std::optional<std::size_t> element{};
  // For the equation that makes it special, 1: dp/ds of the scaled curve; a multiplier's modulus less 1; the
  // distance of a bend's guard from zero, relative. Of a contact's event and of jumps the width of the
  // bracket on the scaled curve.
  double residual = 0.0;
};

// Why a branch ends.
enum class BranchEnd {
  range,   // of the parameter
  points,  // as many as were asked for
  closed,
  origin,  // it comes back into the orbits of half its period, from which it branches off
  jump,    // the map jumps there: no orbit next to the last one continues it
  joined,  // it goes on as a branch that was followed before
  rule,    // beyond it the values break a rule
  lost,
  unbounded,  // towards an undamped resonance
  family,     // a multiple of the frequency is an undamped resonance: any free motion there may be added
};
const char* end_name(BranchEnd end);  // "range"
const char* end_sentence(BranchEnd end);

struct Branch {
  std::vector<BranchPoint> points;    // along the curve
  std::vector<SpecialPoint> special;  // along the curve
  BranchEnd first_end{}, last_end{};  // before its first point and after its last; closed: these are the same
  std::string reason;                 // why there is none; empty where there is
};

// Calls with each point and special point (null: a point) in their order along the curve.
void go_along(const Branch& branch,
              const std::function<void(const BranchPoint& at, const SpecialPoint* special)>& call);

struct BranchWanted {
  double low = 0.0, high = 0.0;  // range of the parameter, low < high; its length scales the steps
  double start = 0.0;            // where the first orbit is searched, within the range
  int most_points = 2000;        // in each direction
  int multiple = 0;              // of the excitation's period; 0: that of the orbit found first
  double largest_step = 0.02;    // of the scaled curve: in the parameter alone a part of its range
};

// Called with each point as it is found.
using BranchProgress = std::function<void(const BranchPoint&)>;

// The branch of the periodic orbit that is found at `wanted.start`, both ways from there until it leaves the
// range, closes or takes too many points. Elements of the exact law only.
// Throws mechanics::MechanicsError for a network that cannot move, or values at the start that break a rule.
Branch follow_branch(const mechanics::Network& network, const std::vector<Quantity>& quantities,
                     const ValuesAlong& values, const BranchWanted& wanted,
                     const BranchProgress& progress = {});

}  // namespace frahm::periodic
