#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>

#include "studies/reading/expression.hpp"

namespace frahm::studies {

// Of metre, kilogram and second. Radians are pure numbers: r theta is a length, v/r an angular frequency.
using Exponents = std::array<double, 3>;

// Nothing: not known, so that any will do.
using ExpressionDimension = std::optional<Exponents>;

// The dimension of an expression's value. of_parameters: of each of the names given to Expression::parse().
//
// A sum, min and max need terms of one dimension, exp log sin cos tan atan and exponents pure numbers.
// Formulas fitted to data hold numbers whose units nobody wrote, as in 26.5104 + 0.4811*I, so
// - a number, or a pure number multiplied by one, has as a term the dimension of the other term;
// - whole numbers, halves and pi are pure numbers as factors, all others of any dimension.
// Throws ExpressionError (wrong_dimension), which names both sides, at the part of the text that does not
// fit.
ExpressionDimension dimension_of(const Expression& expression,
                                 std::span<const ExpressionDimension> of_parameters);

// "a mass (kg)", "a quantity in kg s2".
std::string described(const Exponents& exponents);

bool same(const Exponents& a, const Exponents& b);

}  // namespace frahm::studies
