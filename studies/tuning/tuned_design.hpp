#pragma once

#include <span>
#include <vector>

#include "solvers/tuning/optimum.hpp"
#include "studies/reading/study.hpp"

// What a tuning's design parameters are worth, and with them all parameters of its study.
namespace frahm::studies {

// Of each design parameter its value, or those at the knots of its schedule [SI].
using DesignValues = std::vector<std::vector<double>>;

DesignValues design_values(const tuning::Optimum& optimum);

// A design parameter at a place of the band [SI]: linear between the knots of a schedule.
double value_at(const DesignChoice& design, std::span<const double> values, double band);

// SI values of all parameters as a scenario of the study sets them; derived ones are not completed.
std::vector<double> parameters_in_scenario(const Study& study, std::size_t scenario);

// The same of a design at a place of the band [SI], completed.
std::vector<double> parameters_of(const Study& study, const DesignValues& design, std::size_t scenario,
                                  double band);

// Of each design parameter the schedule that its rule gives for the study as it stands, before anything is
// tuned, clipped to the bounds; an empty function where it has no rule. study: must outlive them.
std::vector<tuning::Rule> rules_of(const Study& study);

// The names of the scenarios; "study" where there are none.
std::vector<std::string> scenario_names(const Study& study);

}  // namespace frahm::studies
