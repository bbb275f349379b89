#pragma once

#include <optional>
#include <span>
#include <vector>

#include "solvers/quantities/quantity.hpp"
#include "studies/reading/study/study.hpp"

// [compare]: the same points under another friction law or crank profile, or another of several responses,
// next to the study's own.
namespace frahm::studies {

// Whether the study or what it is compared with follows smooth laws.
bool meets_smooth_laws(const Study& study);

// The functions below need a study with a comparison. The network and the values of the other response:
mechanics::Network compared_network(const Study& study);
StudyValues compared_values(const Study& study);
periodic::OrbitsWanted compared_orbits(const Study& study);

// The quantities of the other response: the compared ones, then the status.
std::vector<periodic::Quantity> compared_quantities(const Study& study);

// The variables a comparison adds to the record: `X_compared` and `X_difference` of each quantity X, then
// `status_compared`.
std::vector<periodic::QuantityDescription> compared_variables(const Study& study);

// By which a compared quantity may be distinguished from nothing: of a mean, which is what positive and
// negative parts leave of each other, the root mean square of the same motion.
std::optional<periodic::Quantity> size_of_compared(const periodic::Quantity& quantity);

// Values of the variables.  own: of the quantities X in the study's response; sizes: by which they are
// distinguished from nothing, 0 where there is none; other: of compared_quantities().  X_difference = |X -
// X_compared| / |X|, NaN where either is missing or X is zero or no more than rounding of its size.
void compare(std::span<const double> own, std::span<const double> sizes, std::span<const double> other,
             std::span<double> variables);

}  // namespace frahm::studies
