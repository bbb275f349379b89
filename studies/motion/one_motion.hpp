#pragma once

#include <cstddef>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include "results/layout.hpp"
#include "solvers/transient/forced_motion.hpp"
#include "solvers/transient/free_decay.hpp"
#include "studies/reading/study/study.hpp"

// One motion from given initial values: the solver's answer to a study of kind "decay" or "transient", its
// record (results/FORMAT.md) and a short table of it.
namespace frahm::studies {

// A value as the study states it, in SI.
double stated(const Study& study, const StudyValue& value);

// The numbers of the network as the study states them. In a decay hysteretic_omega is its
// reference_frequency, otherwise the lowest undamped natural frequency. Throws StudyError for a network that
// cannot move.
mechanics::NetworkValues motion_values(const Study& study);

transient::InitialState initial_state(const Study& study);
// The same at SI values of all parameters, completed.
transient::InitialState initial_state(const Study& study, std::span<const double> parameters);

// Throws StudyError for a decay that has no end of its own, as nothing oscillates and nothing stops it, and
// no duration; passes on mechanics::MechanicsError.
void check_duration(const Study& study, const mechanics::NetworkValues& values);

// Throws StudyError for invalid values, and if the motion cannot be completed; passes on what `watch` throws.
transient::FreeDecay solve_decay(const Study& study, const transient::Watch& watch = {});
std::vector<results::Column> decay_columns(const Study& study, const transient::FreeDecay& decay);
void print_decay(const Study& study, const transient::FreeDecay& decay, std::ostream& out);

// Duration [s], samples and sweep of a transient. Throws StudyError for a sweep that goes nowhere.
transient::ForcedOptions forced_options(const Study& study);
// The same at SI values of all parameters, completed.
transient::ForcedOptions forced_options(const Study& study, std::span<const double> parameters);

// Throws StudyError as solve_decay().
transient::ForcedMotion solve_transient(const Study& study, const transient::Watch& watch = {});

// The motion at a point of a map: at SI values of all parameters, completed, under one of the records of its
// axis, 0 where it has none. It may have failed. options: of forced_options(), with what is wanted of it.
// Throws mechanics::MechanicsError for values without a meaning, and StudyError as forced_options().
transient::ForcedMotion motion_at(const Study& study, std::span<const double> parameters, std::size_t record,
                                  const transient::ForcedOptions& options);
std::vector<results::Column> transient_columns(const Study& study, const transient::ForcedMotion& motion);
void print_transient(const Study& study, const transient::ForcedMotion& motion, std::ostream& out);

}  // namespace frahm::studies
