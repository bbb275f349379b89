#include "studies/reading/settings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

#include "studies/reading/map/grid_check.hpp"
#include "studies/reading/parse_study.hpp"
#include "studies/reading/study/assignment.hpp"

namespace frahm::studies {

Study read_study_with(const std::filesystem::path& path, const std::vector<std::string>& set) {
  return with_settings(read_study(path), set);
}

Study with_settings(Study study, const std::vector<std::string>& set, std::string_view option) {
  if (set.empty()) return study;
  const std::vector<Assignment> assignments =
      parse_assignments(study, option, fmt::format("{}", fmt::join(set, ",")));
  return with_parameters(std::move(study), assignments);
}

std::vector<double> parameters_at(const Study& study, const std::vector<std::string>& at,
                                  std::string_view option) {
  std::vector<double> parameters = study.parameters.nominal();
  if (!at.empty()) {
    for (const Assignment& assignment :
         parse_assignments(study, option, fmt::format("{}", fmt::join(at, ",")))) {
      parameters[assignment.parameter] = assignment.value;
    }
  }
  check_point(study, parameters);
  return parameters;
}

}  // namespace frahm::studies
