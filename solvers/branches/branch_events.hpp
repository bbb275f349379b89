#pragma once

#include <vector>

#include "solvers/mechanics/linear_system.hpp"
#include "solvers/orbits/orbit.hpp"

// The events of a passage by their number: first of the bends, then of the contacts. Where a number changes
// along a branch, an event begins or ends to happen.
namespace frahm::periodic {

inline constexpr int kAnySize = Eigen::Dynamic;
using AnyOrbit = Orbit<kAnySize, kAnySize>;
using AnyPassage = Passage<kAnySize, kAnySize>;
using AnyFlow = Flow<kAnySize, kAnySize>;

// Which bend or contact changes its state, in the order of time. The passage belongs to the flow as it is
// set.
std::vector<std::size_t> list_events(const AnyFlow& flow, const AnyPassage& passage);
// How often each does.
std::vector<int> count_events(const AnyFlow& flow, const AnyPassage& passage);
// The least distance from zero of an extreme of bend j's guards over an orbit, relative to the guard's size.
double distance_from_bend(const AnyFlow& flow, const AnyOrbit& orbit, Eigen::Index j);
// Whose event it is: index in Network::elements.
std::size_t element_of_event(const mechanics::Assembly& assembly, std::size_t event);

}  // namespace frahm::periodic
