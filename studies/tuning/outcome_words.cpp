#include "studies/tuning/outcome_words.hpp"

namespace frahm::studies {

const std::vector<std::string>& outcome_words() {
  static const std::vector<std::string> words{"converged", "not_converged", "infeasible",
                                              "unbounded", "failed",        "stopped"};
  return words;
}

std::vector<double> outcome_flags(const std::vector<tuning::Outcome>& outcomes) {
  std::vector<double> values;
  for (const tuning::Outcome outcome : outcomes) values.push_back(1.0 + static_cast<int>(outcome));
  return values;
}

}  // namespace frahm::studies
