#pragma once

#include <vector>

#include "solvers/quantities/quantity.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// The quantities that the study asks for, in the order of the record; after those listed, what is always
// recorded. Throws StudyError for an unknown name.
std::vector<periodic::Quantity> output_quantities(const Study& study);

// The variables of the record: these quantities, then those of a comparison. Throws StudyError where two
// names of the record would be the same.
std::vector<periodic::QuantityDescription> output_variables(
    const Study& study, const std::vector<periodic::Quantity>& quantities);

// Throws StudyError where two names of a record of these variables would be the same, and for a page or
// summary that shows what is not recorded.
void check_names_in_file(const Study& study, const std::vector<periodic::QuantityDescription>& variables);

// The name of the quantity that summaries of a sweep show: that of its headline, otherwise the first mass's
// peak.
std::string headline_of(const Study& study);

}  // namespace frahm::studies
