#pragma once

#include <string>
#include <vector>

#include "solvers/tuning/optimum.hpp"

namespace frahm::studies {

// The words for the outcome of a tuning, in the order of tuning::Outcome.
const std::vector<std::string>& outcome_words();

// The outcomes as flags of a record, where 0 means not computed.
std::vector<double> outcome_flags(const std::vector<tuning::Outcome>& outcomes);

}  // namespace frahm::studies
