#pragma once

#include <string>

#include "studies/reading/quantities/expression.hpp"
#include "studies/reading/quantities/expression_dimension.hpp"
#include "studies/reading/quantities/parameters.hpp"
#include "studies/reading/quantities/units.hpp"
#include "studies/reading/study/study_context.hpp"
#include "studies/reading/text/study_source.hpp"

// The dimensions of expressions.
namespace frahm::studies {

WantedDimension wanted_by_key(Quantity quantity);
WantedDimension wanted_by_label(const Unit& unit);

// The dimension of a formula of lengths and ratios, while it is read. Numbers without a unit are ratios in
// it, but without a length they may be lengths: then nothing is known. Throws StudyError for mixed
// dimensions.
ExpressionDimension dimension_of_geometry(const StudyContext& context, const Parameters& parameters,
                                          const Expression& expression, const std::string& where,
                                          Position position);

// Refuses an expression in [parameters], or a noted one, that mixes dimensions or has the wrong one; once all
// units are known.
void check_dimensions(const StudyContext& context, const Parameters& parameters);

}  // namespace frahm::studies
