#pragma once

#include <cmath>
#include <functional>
#include <optional>

#include "solvers/branches/corrector.hpp"

namespace frahm::periodic {

// The part of a branch between two places, by the arclength s from the first along its tangent. The places
// must outlive it.
class PartOfBranch {
 public:
  PartOfBranch(BranchMap& map, const BranchPlace& from, const BranchPlace& to)
      : map_(map), from_(from), to_(to) {}

  const BranchPlace& from() const { return from_; }
  const BranchPlace& to() const { return to_; }
  BranchMap& map() const { return map_; }
  double at(const BranchPlace& place) const { return from_.tangent.dot(place.y - from_.y); }
  // Where the plane across the chord between two places that are known, at this share of it, meets the
  // branch.
  std::optional<BranchPlace> place(double share, const BranchPlace& a, const BranchPlace& b) const;
  // Where none is found there, another one between them.
  std::optional<BranchPlace> place_near(double share, const BranchPlace& a, const BranchPlace& b) const;

 private:
  BranchMap& map_;
  const BranchPlace& from_;
  const BranchPlace& to_;
};

// For a place, what is to be zero.
using PlaceFunction = std::function<double(const BranchPlace&)>;

struct BranchRoot {
  static constexpr double kJump = 1e-6;     // what is left of an equation that a jump crosses is larger
  static constexpr double kClosed = 1e-12;  // a bracket
  static constexpr double kNarrow = 1e-7;   // one that could not be closed further, next to an event

  BranchPlace place;
  double value = 0.0;      // of the function there
  double width = 0.0;      // of the bracket
  bool has_event = false;  // within the bracket
  // The function jumps across zero, within the bracket.
  bool is_jump() const { return has_event && width <= kNarrow && std::abs(value) > kJump; }
  // Next to where another branch crosses, tangents are known to fewer digits.
  bool is_solved() const { return is_jump() || std::abs(value) <= 10.0 * kJump; }
};

// The root of a function that has different signs at both ends.
BranchRoot root(const PartOfBranch& part, const PlaceFunction& function);

}  // namespace frahm::periodic
