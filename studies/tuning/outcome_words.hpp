#pragma once

#include <string>
#include <vector>

#include "solvers/tuning/optimum.hpp"

namespace frahm::studies {

// How a tuning ended in words, in the order of tuning::Outcome.
const std::vector<std::string>& outcome_words();

// Its values as the flag of a record, of which 0 stands for not computed.
std::vector<double> outcome_flags(const std::vector<tuning::Outcome>& outcomes);

}  // namespace frahm::studies
