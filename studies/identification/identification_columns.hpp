#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "results/layout.hpp"
#include "studies/identification/identification_result.hpp"

// The record of an identification (results/FORMAT.md, /identification) and a table of it.
namespace frahm::studies {

std::vector<results::Column> identification_columns(const Study& study, const IdentificationResult& result);
// Method, names of the records, notes.
std::vector<results::Text> identification_texts(const Study& study, const IdentificationResult& result);

// The records and parameters of a study, before anything is identified.
void print_identification_choice(const Study& study, std::ostream& out);
// Estimates with their intervals, correlations, fit quality, notes.
void print_identification(const Study& study, const IdentificationResult& result, std::ostream& out);

}  // namespace frahm::studies
