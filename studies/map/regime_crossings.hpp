#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "solvers/exact/response.hpp"
#include "solvers/quantities/quantity.hpp"

// Where the regime of a Coulomb element changes along a line, its place on which is t from 0 to 1.
namespace frahm::studies {

// What an orbit tells at one place.
struct RegimePoint {
  periodic::Regime regime = periodic::Regime::not_computed;
  // The shortest stop, or slide between two stops, in a period [rad]; NaN or infinite: none, or not known. It
  // shrinks to nothing where the orbit loses a stop, two stops join, or the element no longer moves.
  double briefest = 0.0;
};

// The change from one regime to another; `below` is at smaller t.
struct RegimeCrossing {
  // To half of crossing_width, or where stops were seen to shrink to nothing, there: regimes count stops from
  // 1e-9 of a period on, which is farther from it where stops grow slowly along the line.
  double at = 0.0;
  periodic::Regime below = periodic::Regime::not_computed, above = periodic::Regime::not_computed;
};

// Between points so far apart, and no farther, the regimes on both sides of a crossing were seen.
inline constexpr double crossing_width = 1e-7;

// Whether the element sticks or slides by friction there; false without friction or response.
bool has_regime(periodic::Regime regime);

// The point of an orbit.  element: among the Coulomb elements of the network.
RegimePoint regime_point(periodic::Regime regime, const std::vector<periodic::Stretch>& stretches,
                         std::size_t element);

// Where a crossing is likely to be, and about how far from it at most.
struct CrossingForecast {
  double at = 0.0;
  double reach = 0.0;  // > 0
};

// The crossings between two places whose regimes, first and last, differ, in ascending order: none if either
// end has no regime. Wherever a regime is met that is neither of the two, both parts are searched; pairs of
// crossings between points of one regime are not seen, and where a place without a regime (a failed one) is
// met those around it are not. probe: the point at a place inside. forecast: where to look first.  It is
// asked some ten times a crossing, at most 100 times, and there are at most 32 crossings, however the regimes
// change.
std::vector<RegimeCrossing> find_crossings(periodic::Regime first, periodic::Regime last,
                                           const std::function<RegimePoint(double at)>& probe,
                                           const std::optional<CrossingForecast>& forecast = std::nullopt);

}  // namespace frahm::studies
