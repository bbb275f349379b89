#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "solvers/mechanics/modes.hpp"
#include "studies/program/listing.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// The linear modes of a network at one point: with all friction sliding, and with every contact stuck.
struct ModesAtPoint {
  periodic::LinearModes sliding;
  periodic::LinearModes stuck;  // no modes if nothing can move
  bool friction = false;        // without it the two are the same
  double largest_ratio = 0.0;   // of those in [damping] modal
};

// Throws mechanics::MechanicsError for invalid matrices.
ModesAtPoint modes_at_point(const Study& study, const mechanics::NetworkValues& values);

// Frequencies (rad/s, Hz and rpm, or one number in a dimensionless study), damping ratios, shapes. An excerpt
// has the first twelve modes, with their shapes at eight masses.
void print_modes(const Study& study, const ModesAtPoint& modes, Listing listing, std::ostream& out);

// The values with the parameters as the study states them, and their modes.
mechanics::NetworkValues stated_values(const Study& study);
void print_stated_modes(const Study& study, const ModesAtPoint& modes, Listing listing, std::ostream& out);

}  // namespace frahm::studies
