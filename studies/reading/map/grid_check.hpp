#pragma once

#include <span>
#include <string_view>

#include "studies/reading/study/study.hpp"

// Values at all points of a study.
namespace frahm::studies {

// Every value must be finite and in its range on the whole grid and at the orbits listed. A value is checked
// at all points of the dimensions it depends on or, if these are too many, at their corners.
void check_grid(const Study& study);

// Gives each crank the even orders for its largest crank/rod on the grid and at the orbits listed.
void set_crank_orders(Study& study);
// Adds the orders needed at one more point (SI values of all parameters, completed).
void add_crank_orders_at(Study& study, std::span<const double> parameters);

// Throws StudyError for a point (SI values of all parameters; derived ones are recomputed) at which a value
// is not finite or out of range: its position in the study, the value, the parameters and the rule.
// origin: who sets the parameters so, `scenario "rough"`; "" if the message need not say.
void check_point(const Study& study, std::span<double> parameters, std::string_view origin = "");

// Gives each crank the even orders that its crank/rod needs at a point; these may be more than on the grid.
void set_crank_orders_at(Study& study, std::span<double> parameters);

}  // namespace frahm::studies
