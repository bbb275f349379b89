#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_values.hpp"
#include "studies/reading/text/rules.hpp"

namespace frahm::studies {

// What is wrong with the values of an element beside each other, at one point (SI values of all parameters,
// completed): of a table that does not rise or pass through the origin, of a static force below the force.
struct ElementProblem {
  Rule rule;
  const StudyValue* value = nullptr;  // at which it is told
  std::string found, must;
};
std::optional<ElementProblem> element_problem(const Study& study, std::size_t element,
                                              std::span<const double> parameters);

}  // namespace frahm::studies
