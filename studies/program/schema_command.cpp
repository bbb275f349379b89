#include "studies/program/schema_command.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <string_view>

#include "studies/program/exit_code.hpp"
#include "studies/reading/element_keys.hpp"
#include "studies/reading/study_keys.hpp"

namespace frahm::studies {
namespace {

using Json = nlohmann::ordered_json;

// Of a list of tables.
Json repetition_schema() {
  return {{"type", "object"}, {"description", "writes the table out for each: { i = [1, 60] }"}};
}

Json section_schema(const std::string& path);

Json list_of(Json item) {
  return {{"type", "array"}, {"items", std::move(item)}, {"minItems", 1}};
}

Json any_value() {
  return {{"$ref", "#/$defs/value"}};
}

// Where it has a section of its own that is what it may be as a table.
Json any_form(const std::string& path) {
  const auto is_in = [&](const StudyKey& each) { return each.section == path; };
  if (std::ranges::none_of(study_keys(), is_in)) return Json::object();
  const Json no_table = {{"not", {{"type", "object"}}}};
  return {{"anyOf", Json::array({no_table, section_schema(path)})}};
}

Json form_of(const StudyKey& key) {
  const std::string path = *key.section ? std::string(key.section) + "." + key.key : key.key;
  switch (key.form) {
    case KeyForm::value:
      return any_value();
    case KeyForm::values:
      return list_of(any_value());
    case KeyForm::number:
      return {{"type", "number"}};
    case KeyForm::integer:
      return {{"type", "integer"}};
    case KeyForm::boolean:
      return {{"type", "boolean"}};
    case KeyForm::text:
      return {{"type", "string"}, {"minLength", 1}};
    case KeyForm::texts:
      return list_of({{"type", "string"}});
    case KeyForm::choice:
    case KeyForm::element_type:
      return {{"enum", words_of(key)}};
    case KeyForm::table:
      return section_schema(path);
    case KeyForm::tables:
      return list_of(section_schema(path));
    case KeyForm::names:
      return {{"type", "object"}};
    case KeyForm::any:
      return any_form(path);
  }
  return {};
}

bool is_list(const std::string& path) {
  return written_section(path).starts_with("[[");
}

// Whether a section has a key when its decider is `word`.
bool is_of(const StudyKey& key, const StudyKey& decider, const std::string& word) {
  if (decider.form == KeyForm::element_type)
    return is_of_every_type(key.key) || std::ranges::count(keys_of_type(word), key.key) > 0;
  return std::string_view(key.owners.decider) != decider.key || has(key, word);
}

// The keys that a section does not have when its decider is `word`.
Json refused_keys(const std::string& path, const StudyKey& decider, const std::string& word) {
  Json refused = Json::object();
  for (const StudyKey& key : study_keys()) {
    if (key.section == path && !is_of(key, decider, word)) refused[key.key] = false;
  }
  return refused;
}

bool decides(const StudyKey& key) {
  return key.form == KeyForm::choice || key.form == KeyForm::element_type;
}

Json if_then(const StudyKey& decider, const std::string& word, Json then) {
  const Json is_so = {{"properties", {{decider.key, {{"const", word}}}}}, {"required", {decider.key}}};
  return {{"if", is_so}, {"then", {{"properties", std::move(then)}}}};
}

// If a key of a section is some word, the section has none of the keys of its other forms.
Json rules_of_forms(const std::string& path) {
  Json rules = Json::array();
  for (const StudyKey& decider : study_keys()) {
    if (decider.section != path || !decides(decider)) continue;
    for (const std::string& word : words_of(decider)) {
      if (Json refused = refused_keys(path, decider, word); !refused.empty())
        rules.push_back(if_then(decider, word, std::move(refused)));
    }
  }
  return rules;
}

// The kind of a study decides about its sections, and about keys in them.
Json rules_of_kinds() {
  Json rules = Json::array();
  const StudyKey& kind = study_key("study", "kind");
  for (const std::string& word : words_of(kind)) {
    Json refused = refused_keys("", kind, word);
    for (const StudyKey& section : study_keys()) {
      if (*section.section || refused.contains(section.key) || section.form != KeyForm::table) continue;
      if (Json keys = refused_keys(section.key, kind, word); !keys.empty())
        refused[section.key] = {{"properties", std::move(keys)}};
    }
    Json rule = if_then(kind, word, std::move(refused));
    rule["if"] = {{"properties", {{"study", std::move(rule["if"])}}}};
    rules.push_back(std::move(rule));
  }
  return rules;
}

Json section_schema(const std::string& path) {
  Json keys = Json::object();
  for (const StudyKey& key : study_keys()) {
    if (key.section != path) continue;
    Json form = form_of(key);
    form["description"] = key.meaning;
    keys[key.key] = std::move(form);
  }
  if (is_list(path)) keys["repeat"] = repetition_schema();
  Json schema = {{"type", "object"}, {"properties", std::move(keys)}, {"additionalProperties", false}};
  if (Json rules = rules_of_forms(path); !rules.empty()) schema["allOf"] = std::move(rules);
  return schema;
}

// A number of a study: plain, an expression, or with its unit.
Json value_schema() {
  Json with_unit = section_schema("{ value, unit }");
  with_unit["required"] = {"value"};
  return {{"anyOf", {{{"type", "number"}}, {{"type", "string"}, {"minLength", 1}}, with_unit}}};
}

}  // namespace

int schema_command(std::ostream& out) {
  Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "Study of frahm"}};
  schema.update(section_schema(""));
  schema["required"] = {"study"};
  schema["properties"]["study"]["required"] = {"schema", "kind"};
  schema["allOf"] = rules_of_kinds();
  schema["$defs"] = {{"value", value_schema()}};
  out << schema.dump(2) << '\n';
  return exit_code::done;
}

}  // namespace frahm::studies
