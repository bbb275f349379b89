#include "studies/reading/data_files/wanted_columns.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "studies/reading/text/spelling.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {
namespace {

WantedColumn read_one(const TomlSection& record, const TomlEntry& entry) {
  const std::string where = fmt::format("{}: columns: {}", record.where(), entry.key);
  WantedColumn wanted{entry.key, std::nullopt, "", entry.value.position};
  const auto* number = entry.value.as<std::int64_t>();
  if (!number && !entry.value.as<std::string>()) {
    throw record.source().error_at(rules::wrong_type, entry.value.position,
                                   "{}: expected the number of a column, from 1, or its name, "
                                   "found {}",
                                   where, described(entry.value));
  }
  if (!number) {
    wanted.name = read_text(record.source(), where, entry.value);
    return wanted;
  }
  if (*number < 1) {
    throw record.source().error_at(rules::out_of_range, entry.value.position,
                                   "{}: {} is out of range: columns are counted from 1", where, *number);
  }
  wanted.number = static_cast<std::size_t>(*number);
  return wanted;
}

}  // namespace

std::vector<WantedColumn> read_wanted(const TomlSection& record, const std::vector<RecordForm>& forms) {
  const TomlValue* columns = record.find("columns");
  if (!columns) return {};
  const auto* entries = columns->as<TomlTable>();
  if (!entries || entries->empty())
    record.fail(rules::wrong_type, "columns",
                "expected a table such as {{ time = 1, displacement = \"x\" }}, "
                "found {}",
                entries ? "an empty table" : described(*columns));
  const std::vector<std::string> roles = role_names(forms);
  std::vector<WantedColumn> wanted;
  for (const TomlEntry& entry : *entries) {
    if (std::find(roles.begin(), roles.end(), entry.key) == roles.end()) {
      throw record.source().error_at(rules::unknown_name, entry.position,
                                     "{}: columns: \"{}\" is not a column that the method reads{}",
                                     record.where(), entry.key, suggestion(entry.key, roles));
    }
    wanted.push_back(read_one(record, entry));
  }
  return wanted;
}

const RecordForm& form_of_wanted(const TomlSection& record, const std::vector<RecordForm>& forms,
                                 const std::vector<WantedColumn>& wanted) {
  std::vector<std::string> names;
  for (const WantedColumn& each : wanted) names.push_back(each.role);
  const RecordForm& form = form_of(forms, names);
  for (const Role& role : form.roles) {
    if (!role.required || std::find(names.begin(), names.end(), role.name) != names.end()) continue;
    record.fail(rules::beyond_schema(rules::missing_key), "columns", "\"{}\" is missing; the columns are {}",
                role.name, described(form));
  }
  for (const WantedColumn& each : wanted) {
    const bool beside = each.role == doubtful_role || (each.role == label_role && !form.is_trace);
    if (form.find(each.role) || beside) continue;
    throw record.source().error_at(rules::beyond_schema(rules::key_without_use), each.position,
                                   "{}: columns: \"{}\" cannot be combined with {}", record.where(),
                                   each.role, described(form));
  }
  return form;
}

}  // namespace frahm::studies
