#pragma once

#include <optional>

#include "studies/reading/expression.hpp"
#include "studies/reading/parameters.hpp"
#include "studies/reading/units.hpp"

namespace frahm::studies {

// What a factor of a direction is, as far as its units tell: a rotation times a length [m/rad] is a length, a
// translation over a length an angle.
enum class FactorDimension { unknown, number, length, per_length };

// Nothing for any other dimension.
std::optional<FactorDimension> dimension_of(const Unit& unit);

// Parameters without a unit count as pure numbers, but then a product without a length is of unknown
// dimension.
std::optional<FactorDimension> dimension_of(const Expression& factor, const Parameters& parameters);

}  // namespace frahm::studies
