#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>

#include "studies/reading/quantities/expression.hpp"
#include "studies/reading/quantities/units.hpp"

namespace frahm::studies {

// Exponents of metre, kilogram and second. Radians are pure numbers: r theta is a length, v/r an angular
// frequency.
using Exponents = std::array<double, 3>;

// Nothing: not known, so that any will do.
using ExpressionDimension = std::optional<Exponents>;

// What a number without a unit is as a factor, unless it is a whole number, a half or pi: in a formula fitted
// to data of any dimension, in one of geometry a pure number. Likewise a parameter of no known dimension.
enum class PlainFactor { any_dimension, pure_number };

// The dimension of an expression's value. of_parameters: of each of the names given to Expression::parse().
//
// A sum, min and max need terms of one dimension, exp log sin cos tan atan and exponents pure numbers.
// Formulas fitted to data hold numbers whose units nobody wrote, as in 26.5104 + 0.4811*I, so
// - a number, or a pure number multiplied by one, has as a term the dimension of the other term;
// - whole numbers, halves and pi are pure numbers as factors, all others what `plain` says.
// Throws ExpressionError (wrong_dimension), which names both sides, at the part of the text that does not
// fit.
ExpressionDimension dimension_of(const Expression& expression,
                                 std::span<const ExpressionDimension> of_parameters,
                                 PlainFactor plain = PlainFactor::any_dimension);

// "a mass (kg)", "a quantity in kg s2".
std::string described(const Exponents& exponents);

Exponents exponents_of(const Unit& unit);
bool same(const Exponents& a, const Exponents& b);

}  // namespace frahm::studies
