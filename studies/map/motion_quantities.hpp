#pragma once

#include <vector>

#include "solvers/transient/motion_quantity.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// The quantities that a map of motions asks for, in the order of the record; the status, where it is not
// listed, is the last. Throws StudyError for an unknown name.
std::vector<transient::MotionQuantity> motion_quantities(const Study& study);

// The variables of the record: these quantities. Throws StudyError where two names of the record would be the
// same.
std::vector<periodic::QuantityDescription> motion_variables(
    const Study& study, const std::vector<transient::MotionQuantity>& quantities);

}  // namespace frahm::studies
