#include "studies/provenance/study_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "results/report/page_data.hpp"
#include "studies/provenance/document_changes.hpp"
#include "studies/provenance/document_facts.hpp"
#include "studies/provenance/finished_file.hpp"
#include "studies/provenance/provenance.hpp"
#include "studies/provenance/stored_study.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {
namespace {

// For two studies that are the same apart from rounding: the axes that have another unit, and other numbers.
std::vector<std::string> changed_roundings(const Study& kept, const Study& now,
                                           const TomlValue& kept_document, const TomlValue& document) {
  std::vector<std::string> changes;
  const bool have_axes = kept.map() && now.map() && kept.map()->axes.size() == now.map()->axes.size();
  for (std::size_t a = 0; have_axes && a < now.map()->axes.size(); ++a) {
    const ParameterAxis &before = kept.map()->axes[a], &after = now.map()->axes[a];
    if (before.unit == after.unit || before.si_values == after.si_values) continue;
    changes.push_back(
        change_of_unit(fmt::format("axis \"{}\": its unit", now.parameters.list[after.parameter].name),
                       before.unit.empty() ? "SI" : before.unit, after.unit.empty() ? "SI" : after.unit));
  }
  for (std::string& change : rounding_changes(kept_document, document))
    if (!change.starts_with("axis ")) changes.push_back(std::move(change));
  return changes;
}

// None where the studies say the same.
std::vector<std::string> changes_between(const Study& kept, const Study& now) {
  if (kept.kind() != now.kind())
    return {fmt::format("kind: \"{}\", now \"{}\"", kind_name(kept.kind()), kind_name(now.kind()))};
  const TomlValue kept_document = document_of(kept), document = document_of(now);
  const std::vector<std::string> changes = document_changes(kept_document, document);
  return changes.empty() ? changed_roundings(kept, now, kept_document, document) : changes;
}

constexpr const char* nothing_found =
    "no key by itself: a unit that another key inherits, the content of a file that the study reads, or what "
    "this "
    "version of frahm computes";

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// The courses of two branches, or that one of two results is a branch.
std::vector<std::string> changes_of_branch(const results::MapReader& result, const StudyPlan& now) {
  const ResultKind kind = kind_of(result);
  const bool is_branch = !now.course.empty();
  if (kind == ResultKind::branch && !is_branch)
    return {fmt::format("a branch, now {}", kind_noun(now.study.kind()))};
  if (kind == ResultKind::map && is_branch) return {"a sweep, now a branch"};
  std::vector<std::string> changes;
  const std::vector<std::string> before = lines_of(provenance_text(result, branch_course_text)),
                                 after = lines_of(now.course);
  for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i)
    if (before[i] != after[i]) changes.push_back(fmt::format("{}, now {}", before[i], after[i]));
  return changes;
}

}  // namespace

std::vector<std::string> study_changes(const Study& kept, const Study& now) {
  std::vector<std::string> changes = changes_between(kept, now);
  if (changes.empty()) changes.emplace_back(nothing_found);
  return changes;
}

std::vector<std::string> changes_since(const results::MapReader& result, const std::filesystem::path& file,
                                       const StudyPlan& now) {
  std::vector<std::string> changes = changes_of_branch(result, now);
  try {
    for (std::string& change : changes_between(read_stored_study(result, file).study, now.study))
      changes.push_back(std::move(change));
  } catch (const StudyError& error) {  // its tables are gone or changed, or another version wrote it
    changes.emplace_back(error.what());
  }
  if (changes.empty()) changes.emplace_back(nothing_found);
  return changes;
}

OtherWords other_words(const results::MapReader& result, const std::filesystem::path& file,
                       const StudyPlan& now) {
  const bool is_the_same = provenance_text(result, "study") == now.study.source.text &&
                           provenance_text(result, "overrides") == overrides_text(now.set);
  const bool has_page = result.has_group(results::page_group);
  if (is_the_same && has_page) return {};
  OtherWords words{.kept = is_the_same ? now.study : read_stored_study(result, file).study, .changes = {}};
  words.changes = word_changes(document_of(*words.kept), document_of(now.study));
  if (!has_page) words.changes.emplace_back("what the report shows of the study: new");
  return words;
}

}  // namespace frahm::studies
