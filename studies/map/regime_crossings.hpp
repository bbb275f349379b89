#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "solvers/exact/response.hpp"
#include "solvers/quantities/quantity.hpp"

// Where the regime of a Coulomb element changes along a line with the position t from 0 to 1.
namespace frahm::studies {

// The regime of an orbit at one position.
struct RegimePoint {
  periodic::Regime regime = periodic::Regime::not_computed;
  // The shortest stop, or slide between two stops, in a period [rad]; NaN or infinite: none, or not known. It
  // shrinks to zero where the orbit loses a stop, two stops join, or the element no longer moves.
  double briefest = 0.0;
};

// The change from one regime to another; `below` is at smaller t.
struct RegimeCrossing {
  // Within half of crossing_width; or, if stops were seen to shrink to zero, their zero: regimes count stops
  // only from 1e-9 of a period on, which lies farther away where stops grow slowly along the line.
  double at = 0.0;
  periodic::Regime below = periodic::Regime::not_computed, above = periodic::Regime::not_computed;
};

// The regimes on both sides of a crossing were seen at points no farther apart than this.
inline constexpr double crossing_width = 1e-7;

// Whether the element sticks or slides by friction there; false without friction or response.
bool has_regime(periodic::Regime regime);

// The point of an orbit.  element: among the Coulomb elements of the network.
RegimePoint regime_point(periodic::Regime regime, const std::vector<periodic::Stretch>& stretches,
                         std::size_t element);

// The likely position of a crossing, and about its largest error.
struct CrossingForecast {
  double at = 0.0;
  double reach = 0.0;  // > 0
};

// The crossings between the ends of the line, whose regimes `first` and `last` differ, in ascending order:
// none if either end has no regime. If a third regime is met, both parts are searched. Two crossings between
// points of one regime are missed, as are those around a point without a regime (a failed one). probe: the
// point at a position inside, called some ten times per crossing and at most 100 times. forecast: where to
// look first. There are at most 32 crossings, however the regimes change.
std::vector<RegimeCrossing> find_crossings(periodic::Regime first, periodic::Regime last,
                                           const std::function<RegimePoint(double at)>& probe,
                                           const std::optional<CrossingForecast>& forecast = std::nullopt);

}  // namespace frahm::studies
