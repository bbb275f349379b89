#pragma once

#include <span>
#include <vector>

#include "solvers/tuning/optimum.hpp"
#include "studies/reading/study.hpp"

// The values of a tuning's design parameters, and with them of all parameters of its study.
namespace frahm::studies {

// For each design parameter its value, or its values at the knots of its schedule [SI].
using DesignValues = std::vector<std::vector<double>>;

DesignValues design_values(const tuning::Optimum& optimum);

// A design parameter at a value of the band parameter [SI]: linear between the knots of a schedule.
double value_at(const DesignChoice& design, std::span<const double> values, double band);

// SI values of all parameters as a scenario of the study sets them; derived ones are not completed.
std::vector<double> parameters_in_scenario(const Study& study, std::size_t scenario);

// The same for a design at a value of the band parameter [SI], completed.
std::vector<double> parameters_of(const Study& study, const DesignValues& design, std::size_t scenario,
                                  double band);

// For each design parameter the schedule that its rule gives in the untuned study, clipped to the bounds; an
// empty function without a rule. study: must outlive them.
std::vector<tuning::Rule> rules_of(const Study& study);

// The names of the scenarios; "study" where there are none.
std::vector<std::string> scenario_names(const Study& study);

}  // namespace frahm::studies
