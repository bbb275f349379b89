#include "studies/program/report_content.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <iostream>

#include "solvers/quantities/quantity.hpp"
#include "studies/page/page_groups.hpp"
#include "studies/reading/text/name_pattern.hpp"

namespace frahm::studies {
namespace {

using Names = std::vector<std::string>;

void check_quantities(const Names& asked, const Names& recorded) {
  for (const std::string& name : asked) {
    if (std::ranges::any_of(recorded, [&](const std::string& each) { return matches(name, each); })) continue;
    throw StudyError(rules::wrong_option, "--quantities: the result has no quantity \"{}\"{}", name,
                     recorded.empty() ? ", as it has no map" : hint_of_unmatched(name, recorded));
  }
}

// A browser holds some gigabytes of numbers; Node.js reads all digits of them as one text of half a gigabyte
// at most.
void check_size(const results::MapLayout& layout, std::size_t quantities, bool all_digits) {
  const double most_numbers = all_digits ? 4e7 : 2e8;
  double points = 1.0;
  for (const results::Axis& axis : layout.axes) points *= static_cast<double>(axis.size);
  if (points * static_cast<double>(quantities) <= most_numbers) return;
  throw StudyError(rules::too_large,
                   "the report would hold {} quantities at {:.4g} points; {} takes at most {:.0e} numbers: "
                   "name fewer with --quantities, or sweep only a part of the map for it",
                   quantities, points, all_digits ? "Node.js" : "a browser", most_numbers);
}

// What is shown of a file of an earlier version: what any network might mark, or all.
Names shown_by_name(const Names& recorded) {
  Names shown;
  for (const std::string& name : recorded)
    if (periodic::is_shown(name)) shown.push_back(name);
  return shown.empty() ? recorded : shown;
}

Names shown_quantities(const results::MapReader& result, const Names& asked) {
  Names recorded;
  for (const results::Variable& variable : result.layout().variables) recorded.push_back(variable.name);
  check_quantities(asked, recorded);
  Names chosen = asked;
  if (asked.empty()) chosen = results::page_list(result, shown_text).value_or(shown_by_name(recorded));
  for (const std::string& name : results::page_list(result, always_shown_text).value_or(Names{}))
    chosen.push_back(name);
  return matching(chosen, recorded);
}

}  // namespace

results::PageContent page_content(const results::MapReader& result, const std::filesystem::path& file,
                                  const std::vector<std::string>& quantities, bool all_digits) {
  if (!result.has_group(results::page_group))
    fmt::print(
        std::cerr,
        "frahm: {} is of an earlier version, which did not write what the report shows of its study, so "
        "this is left out; frahm run STUDY adds it, and computes no map or tuning again\n",
        file.string());
  const Names shown = shown_quantities(result, quantities);
  check_size(result.layout(), shown.size(), all_digits);
  return {.file = file.filename().string(), .variables = shown, .all_digits = all_digits};
}

}  // namespace frahm::studies
