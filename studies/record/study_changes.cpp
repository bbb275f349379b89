#include "studies/record/study_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "results/map_reader.hpp"
#include "studies/reading/repetition.hpp"
#include "studies/reading/toml_building.hpp"
#include "studies/record/document_changes.hpp"
#include "studies/record/stored_study.hpp"

namespace frahm::studies {
namespace {

bool is_on_axis(const Study& study, std::size_t parameter) {
  if (study.tune() && study.tune()->band && study.tune()->band->parameter == parameter) return true;
  return study.map() && std::ranges::any_of(study.map()->axes, [&](const ParameterAxis& axis) {
           return axis.parameter == parameter;
         });
}

// The study's text as a document, with the numbers that its parameters have in this run. Those on an axis are
// left out: their values are that of the axis.
TomlValue document_of(const Study& study) {
  TomlValue document = with_repetitions(study.source, read_toml(study.source));
  TomlEntry* parameters = entry_of(std::get<TomlTable>(document.content), "parameters");
  if (!parameters || !parameters->value.as<TomlTable>()) return document;
  TomlTable told;
  for (TomlEntry& entry : std::get<TomlTable>(parameters->value.content)) {
    const auto names = study.parameters.names();
    const auto found = std::ranges::find(names, entry.key);
    if (found == names.end()) continue;
    const auto i = static_cast<std::size_t>(found - names.begin());
    if (is_on_axis(study, i)) continue;
    if (const auto* number = std::get_if<double>(&study.parameters.list[i].definition))
      entry.value = toml_parameter(study, i, *number);
    told.push_back(std::move(entry));
  }
  parameters->value.content = std::move(told);
  return document;
}

std::vector<std::string> changes_of_documents(const Study& kept, const Study& now) {
  if (kept.kind() != now.kind())
    return {fmt::format("kind: \"{}\", now \"{}\"", kind_name(kept.kind()), kind_name(now.kind()))};
  return document_changes(document_of(kept), document_of(now));
}

}  // namespace

std::vector<std::string> study_changes(const Study& kept, const Study& now) {
  std::vector<std::string> changes = changes_of_documents(kept, now);
  if (changes.empty())
    changes.emplace_back(
        "nothing in the study itself: the content of a file that it reads, or what this version of frahm "
        "computes");
  return changes;
}

std::vector<std::string> changes_since(const std::filesystem::path& result, const Study& now) {
  try {
    return study_changes(read_stored_study(results::MapReader(result), result).study, now);
  } catch (const StudyError&) {  // its tables may be gone, or it was written by another version
    return {};
  }
}

bool has_same_document(const std::filesystem::path& result, const Study& now) {
  if (!std::filesystem::exists(result)) return false;
  try {
    return changes_of_documents(read_stored_study(results::MapReader(result), result).study, now).empty();
  } catch (const StudyError&) {  // written by another version
    return false;
  }
}

}  // namespace frahm::studies
