#pragma once

#include <iosfwd>

#include "studies/motion/motion_columns.hpp"

// The energy budget of a motion: in its record, and as a short table.
namespace frahm::studies {

// Adds <element>_energy, <element>_energy_share of elements that dissipate, damping_energy and its share of a
// structure that does; initial_energy, final_energy, energy_balance, and of a transient energy_input.
void add_energies(const Study& study, const transient::EnergyBudget& energy, MotionColumns& columns);

void print_energies(const Study& study, const transient::EnergyBudget& energy, std::ostream& out);

}  // namespace frahm::studies
