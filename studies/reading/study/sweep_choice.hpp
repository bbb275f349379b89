#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "solvers/mechanics/network.hpp"
#include "solvers/orbits/orbits_wanted.hpp"
#include "solvers/quantities/quantity.hpp"
#include "studies/reading/study/map_choice.hpp"
#include "studies/reading/study/profile.hpp"

// The options of a study of kind "sweep".
namespace frahm::studies {

// Branches of responses along an axis, through rows of the map.
struct BranchChoice {
  std::size_t axis = 0;  // index in MapChoice::axes; alone in its dimension
  std::vector<std::vector<Assignment>> at =
      {};  // the rows: those with the values of one of these; empty: all
};

// Whether a number is a value of an axis, but for the rounding of units.
bool is_on_axis(double value, double of_axis);
// The elements that may begin to stick, to stop or to touch, the sliders of an iwan element as one: indices
// in Network::elements.
std::vector<std::size_t> elements_with_events(const mechanics::Network& network);

// A second response at the same points: another friction law, the cranks' motion cut at another order, or
// another of several responses.
struct Comparison {
  int taylor_order = 0;                                  // of every crank: 1, 2 or 4; 0: the law differs
  mechanics::ForceLaw law = mechanics::ForceLaw::exact;  // of every coulomb element
  StudyValue slope;                                      // of the arctan law
  std::optional<periodic::OrbitsWanted::Show> show;      // the law is then that of the study
  std::vector<periodic::Quantity> quantities;            // real-valued, at least one
};

// The axes of a map of periodic responses and what is recorded of its points.
struct SweepChoice : MapChoice {
  bool general_path = false;             // every orbit by shooting, also where nothing sticks
  bool borders = false;                  // whether borders of regimes are solved; exact law only
  std::optional<BranchChoice> branches;  // exact law only
  std::vector<std::size_t> resonances;   // coordinates whose resonance is sought along the frequency axis
  periodic::OrbitsWanted orbits;         // of a system that may have several responses
  std::optional<Profile> profile;        // of the report's page
  std::optional<Comparison> comparison;

  // The dimension along which the excitation frequency changes, which runs innermost in the computation; if
  // there are several, the last one along which the masses and elements stay the same, otherwise the last.
  std::optional<std::size_t> frequency_dimension;

  // Whether it, or what it is compared with, sweeps the frequency: each point of a row then follows from the
  // one before it.
  bool sweeps_frequency() const;

  // The values that are expressions of parameters, next to those of its coordinates.
  std::vector<const StudyValue*> values() const;
};

}  // namespace frahm::studies
