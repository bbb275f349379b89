#pragma once

#include <optional>
#include <span>
#include <vector>

#include "solvers/tuning/optimum.hpp"
#include "studies/reading/study/study.hpp"

// The values of a tuning's design parameters, and with them of all parameters of its study.
namespace frahm::studies {

// A design parameter that is tuned: its value, or its values at the knots of its schedule [SI].
struct DesignCourse {
  std::vector<double> values;
  std::vector<double> knots;  // empty: one constant
};
using DesignValues = std::vector<DesignCourse>;  // for each design parameter

// Where a schedule jumps [SI of the band], and the values on both sides [SI].
struct Jump {
  double at = 0.0, from = 0.0, to = 0.0;
};
// Nothing for a parameter that may not jump, or that was not tuned.
std::optional<Jump> jump_of(const DesignChoice& choice, const DesignCourse& course);

DesignValues design_values(const tuning::Optimum& optimum);

// A design parameter at a value of the band parameter [SI]: linear between the knots of a schedule.
double value_at(const DesignCourse& course, double band);

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
