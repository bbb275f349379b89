#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "results/layout.hpp"
#include "solvers/transient/forced_motion.hpp"
#include "solvers/transient/free_decay.hpp"
#include "studies/reading/study.hpp"

// One motion from given initial values: the solver's answer to a study of kind "decay" or "transient", its
// record (results/FORMAT.md) and a short table of it.
namespace frahm::studies {

// A value as the study states it, in SI.
double stated(const Study& study, const StudyValue& value);

// The numbers of the network as the study states them. In a decay hysteretic_omega is its
// reference_frequency, or else the lowest undamped natural frequency. Throws StudyError for a network that
// cannot move.
mechanics::NetworkValues motion_values(const Study& study);

transient::InitialState initial_state(const Study& study);

// Throws StudyError for invalid values, and if the motion cannot be completed; passes on what `watch` throws.
transient::FreeDecay solve_decay(const Study& study, const transient::Watch& watch = {});
std::vector<results::Column> decay_columns(const Study& study, const transient::FreeDecay& decay);
void print_decay(const Study& study, const transient::FreeDecay& decay, std::ostream& out);

// Duration [s], samples, sweep and records (those of the study, the first of an axis) of a transient. Throws StudyError for a sweep that goes nowhere.
transient::ForcedOptions forced_options(const Study& study);

// Throws StudyError as solve_decay().
transient::ForcedMotion solve_transient(const Study& study, const transient::Watch& watch = {});
std::vector<results::Column> transient_columns(const Study& study, const transient::ForcedMotion& motion);
void print_transient(const Study& study, const transient::ForcedMotion& motion, std::ostream& out);

}  // namespace frahm::studies
