#pragma once

#include <vector>

#include "solvers/periodic/quantity.hpp"
#include "studies/study_file.hpp"

namespace frahm::studies {

// The quantities that the study asks for, in the order of the record. Throws StudyError for a name that no
// quantity has, and where two variables of the record would have the same name.
std::vector<periodic::Quantity> output_quantities(const StudyFile& study);

}  // namespace frahm::studies
