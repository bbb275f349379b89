#include "studies/program/schema_command.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <string_view>

#include "studies/program/exit_code.hpp"
#include "studies/reading/keys/element_keys.hpp"
#include "studies/reading/keys/key_groups.hpp"
#include "studies/reading/keys/study_keys.hpp"

// JSON Schema from the table of keys: https://json-schema.org/draft/2020-12.
namespace frahm::studies {
namespace {

using Json = nlohmann::ordered_json;

// Names, in which a repetition may write a number: "floor{i}".
constexpr const char* name_pattern = R"(^[A-Za-z]([A-Za-z0-9_]|\{[^{}]*\})*$)";
constexpr const char* name_or_star = R"(^([A-Za-z]([A-Za-z0-9_]|\{[^{}]*\})*|.*\*.*)$)";

Json section_schema(const std::string& path);

// For a list of tables.
Json repetition_schema() {
  const Json number = {{"type", "integer"}, {"minimum", -1'000'000}, {"maximum", 1'000'000}};
  const Json range = {{"type", "array"}, {"items", number}, {"minItems", 2}, {"maxItems", 3}};
  return {{"type", "object"},
          {"description", "makes a table for each value of the index: { i = [1, 60] }"},
          {"additionalProperties", range},
          {"minProperties", 1}};
}

Json number_schema(const char* type, const Limits& limits) {
  Json schema = {{"type", type}};
  if (std::isfinite(limits.least)) schema[limits.above ? "exclusiveMinimum" : "minimum"] = limits.least;
  if (std::isfinite(limits.most)) schema[limits.below ? "exclusiveMaximum" : "maximum"] = limits.most;
  if (!limits.or_another) return schema;
  return {{"anyOf", {schema, {{"const", limits.another}}}}};
}

Json list_of(Json item, const Length& length) {
  Json list = {{"type", "array"}, {"items", std::move(item)}, {"minItems", length.least}};
  if (length.most < Length{}.most) list["maxItems"] = length.most;
  return list;
}

// A number of a study: plain, with its unit, or, but for a plain value, an expression.
Json value_schema(bool is_plain, const Limits& limits) {
  Json with_unit = section_schema("{ value, unit }");
  with_unit["properties"]["value"].update(number_schema("number", limits));
  Json forms = {number_schema("number", limits), with_unit};
  if (!is_plain) forms.push_back({{"type", "string"}, {"minLength", 1}});
  return {{"anyOf", forms}};
}

std::string name_of_value(bool is_plain, const Limits& limits) {
  const std::string name = is_plain ? "plain_value" : "value";
  return limits.least != 0.0 ? name : (limits.above ? "positive_" : "not_negative_") + name;
}

Json value_reference(bool is_plain, const Limits& limits) {
  return {{"$ref", "#/$defs/" + name_of_value(is_plain, limits)}};
}

Json name_schema() {
  return {{"type", "string"}, {"pattern", name_pattern}};
}

// In a table that may be repeated its index may stand for a number: order = "{n}".
Json or_index(const StudyKey& key, const Json& number) {
  if (!written_section(key.section).starts_with("[[")) return number;
  return {{"anyOf", {number, {{"type", "string"}, {"pattern", R"(^\{[^{}]+\}$)"}}}}};
}

Json form_of(const StudyKey& key, KeyForm form);

Json settings_schema(const StudyKey& key) {
  Json schema = {{"type", "object"},
                 {"propertyNames", {{"pattern", name_pattern}}},
                 {"additionalProperties", form_of(key, key.inside)}};
  if (key.length.least > 0) schema["minProperties"] = key.length.least;
  return schema;
}

Json form_of(const StudyKey& key, KeyForm form) {
  switch (form) {
    case KeyForm::value:
      return value_reference(false, key.limits);
    case KeyForm::values:
      return list_of(value_reference(false, key.limits), key.length);
    case KeyForm::pairs:
      return list_of(list_of(value_reference(false, key.limits), {2, 2}), key.length);
    case KeyForm::plain_value:
      return value_reference(true, key.limits);
    case KeyForm::plain_pairs:
      return list_of(list_of(value_reference(true, key.limits), {2, 2}), key.length);
    case KeyForm::column:
      return {{"anyOf", {form_of(key, KeyForm::integer), form_of(key, KeyForm::text)}}};
    case KeyForm::parameter:
      return {{"anyOf", {value_reference(false, {}), section_schema("{ table, of }")}}};
    case KeyForm::number:
      return or_index(key, number_schema("number", key.limits));
    case KeyForm::numbers:
      return list_of(number_schema("number", key.limits), key.length);
    case KeyForm::integer:
      return or_index(key, number_schema("integer", key.limits));
    case KeyForm::boolean:
      return {{"type", "boolean"}};
    case KeyForm::text:
    case KeyForm::expression:
    case KeyForm::file:
      return {{"type", "string"}, {"minLength", 1}};
    case KeyForm::texts:
    case KeyForm::files:
      return list_of({{"type", "string"}, {"minLength", 1}}, key.length);
    case KeyForm::name:
      return name_schema();
    case KeyForm::names:
      return list_of(name_schema(), key.length);
    case KeyForm::patterns:
      return list_of({{"type", "string"}, {"pattern", name_or_star}}, key.length);
    case KeyForm::choice:
    case KeyForm::element_type:
      return {{"enum", words_of(key)}};
    case KeyForm::table:
      return section_schema(*key.section_of_other ? key.section_of_other : path_of(key));
    case KeyForm::tables:
      return list_of(section_schema(path_of(key)), {needs(key, "") ? 1U : 0U});
    case KeyForm::settings:
      return settings_schema(key);
    case KeyForm::list_of_settings:
      return list_of(settings_schema(key), key.length);
  }
  return {};
}

Json forms_of(const StudyKey& key) {
  if (!key.has_other) return form_of(key, key.form);
  return {{"anyOf", {form_of(key, key.form), form_of(key, key.other)}}};
}

// What a rule adds to a section.
class Addition {
 public:
  void refuse(const std::string& key) { properties_[key] = false; }
  void require(const std::string& key) { required_.push_back(key); }
  void keep(const std::string& key, Json schema) { properties_[key] = std::move(schema); }
  void also(Json schema) { all_.push_back(std::move(schema)); }

  Json schema() const {
    Json result = Json::object();
    if (!properties_.empty()) result["properties"] = properties_;
    if (!required_.empty()) result["required"] = required_;
    if (!all_.empty()) result["allOf"] = all_;
    return result;
  }

 private:
  Json properties_ = Json::object(), required_ = Json::array(), all_ = Json::array();
};

// A key is there; an empty list says nothing.
Json has_key(const std::string& key) {
  return {{"required", {key}}, {"properties", {{key, {{"minItems", 1}}}}}};
}

Json none_of(const Json& schemas) {
  return {{"not", {{"anyOf", schemas}}}};
}

Json group_schema(const KeyGroup& group) {
  Json each = Json::array(), pairs = Json::array();
  const std::vector<std::string> keys = separated(group.keys);
  for (std::size_t i = 0; i < keys.size(); ++i) {
    each.push_back(has_key(keys[i]));
    for (std::size_t j = 0; j < i; ++j) pairs.push_back({{"required", {keys[j], keys[i]}}});
  }
  switch (group.rule) {
    case Together::one:
      return {{"oneOf", each}};
    case Together::at_most_one:
      return none_of(pairs);
    case Together::at_least_one:
      return {{"anyOf", each}};
    case Together::all_or_none:
      return {{"anyOf", {{{"required", keys}}, none_of(each)}}};
    case Together::not_without:
      return {{"dependentRequired", {{keys.front(), {keys.back()}}}}};
  }
  return {};
}

// What holds in a section, and in those inside it, once a decider has a word; without a decider the word is a
// form of the section.
Json addition_of(const std::string& path, std::string_view decider, const std::string& word) {
  Addition addition;
  for (const StudyKey& key : study_keys()) {
    if (key.section != path) continue;
    const bool is_decided = *key.owners.of != '\0' && key.owners.decider == decider;
    if (is_decided && !has_by(key.owners, decider, word)) {
      addition.refuse(key.key);
      continue;
    }
    if (has_by(key.need.of, decider, word) || (is_decided && key.need.always)) {
      addition.require(key.key);
      if (key.form == KeyForm::tables) addition.also({{"properties", {{key.key, {{"minItems", 1}}}}}});
    }
    if (decider.empty() && words_of(key, word).size() < words_of(key).size())
      addition.keep(key.key, {{"enum", words_of(key, word)}});
    Json below = addition_of(path_of(key), decider, word);
    if (below.empty()) continue;
    addition.keep(key.key, key.form == KeyForm::tables ? Json{{"items", below}} : below);
  }
  for (const KeyGroup& group : key_groups()) {
    if (group.section == path && has_by(group.of, decider, word)) addition.also(group_schema(group));
  }
  return addition.schema();
}

// A form of a type of element: its keys, the ranges of its values and no other key.
Json element_schema(const std::string& type, const ElementForm& form) {
  Addition addition;
  for (const StudyKey& key : study_keys()) {
    const auto is_in = [&](const std::vector<std::string>& keys) {
      return std::ranges::find(keys, key.key) != keys.end();
    };
    if (std::string_view(key.section) != "element" || is_of_every_type(key.key)) continue;
    if (is_in(form.needed)) addition.require(key.key);
    if (!is_in(form.needed) && !is_in(form.optional)) addition.refuse(key.key);
    StudyKey ranged = key;
    switch (range_of_type(type, key.key)) {
      case mechanics::Range::finite:
        continue;
      case mechanics::Range::not_negative:
        ranged.limits = not_negative;
        break;
      case mechanics::Range::positive:
        ranged.limits = positive;
        break;
    }
    if (is_in(form.needed) || is_in(form.optional)) addition.keep(key.key, forms_of(ranged));
  }
  if (*form.decider) addition.keep(form.decider, {{"const", form.word}});
  return addition.schema();
}

Json addition_of_type(const std::string& type) {
  Json forms = Json::array();
  for (const ElementForm& form : forms_of_type(type)) forms.push_back(element_schema(type, form));
  return forms.size() == 1 ? forms.front() : Json{{"anyOf", forms}};
}

// A decider that is left out has its first word.
Json decides(const StudyKey& decider, const std::string& word) {
  Json is_so = {{"properties", {{decider.key, {{"const", word}}}}}};
  if (decider.need.always || word != words_of(decider).front()) is_so["required"] = {decider.key};
  return is_so;
}

Json rules_of_deciders(const std::string& path) {
  Json rules = Json::array();
  for (const StudyKey& decider : study_keys()) {
    if (decider.section != path) continue;
    for (const std::string& word : words_of(decider)) {
      const bool is_type = decider.form == KeyForm::element_type;
      Json then = is_type ? addition_of_type(word) : addition_of(path, decider.key, word);
      if (!then.empty()) rules.push_back({{"if", decides(decider, word)}, {"then", std::move(then)}});
    }
  }
  return rules;
}

// Whether a mark is there: a key of the section, or "excitation.record" from the whole study.
Json mark_schema(const SectionForm& form) {
  Json any = Json::array();
  for (const std::string& mark : separated(form.marks)) {
    const std::size_t dot = mark.find('.');
    if (dot != std::string::npos) {
      const std::string section = mark.substr(0, dot);
      any.push_back({{"properties", {{section, has_key(mark.substr(dot + 1))}}}, {"required", {section}}});
      continue;
    }
    Json is_there = has_key(mark);
    if (form.is_text) is_there["properties"] = {{mark, {{"type", "string"}}}};
    any.push_back(std::move(is_there));
  }
  return {{"anyOf", any}};
}

bool is_decided_outside(const std::string& section) {
  return std::ranges::any_of(section_forms(), [&](const SectionForm& form) {
    return form.section == section && std::string_view(form.marks).find('.') != std::string_view::npos;
  });
}

// The forms of a section that its keys tell, one after the other. wrap: to where the marks are looked for.
template <class Wrap>
Json rule_of_forms(const std::string& section, const Wrap& wrap) {
  Json rule = Json::object();
  Json* place = &rule;
  for (const SectionForm& form : section_forms()) {
    if (form.section != section) continue;
    Json then = wrap(addition_of(section, "", form.form));
    if (*form.marks == '\0') {
      *place = std::move(then);
      continue;
    }
    *place = {{"if", mark_schema(form)}, {"then", std::move(then)}, {"else", Json::object()}};
    place = &(*place)["else"];
  }
  return rule;
}

// The kind of a study decides about its sections, and about keys in them.
Json rules_of_study() {
  Json rules = Json::array();
  const StudyKey& kind = study_key("study", "kind");
  for (const std::string& word : words_of(kind)) {
    const Json is_so = {{"properties", {{"study", decides(kind, word)}}}};
    rules.push_back({{"if", is_so}, {"then", addition_of("", kind.key, word)}});
  }
  for (const StudyKey& section : study_keys()) {
    if (*section.section || !is_decided_outside(section.key)) continue;
    rules.push_back(rule_of_forms(section.key, [&](const Json& addition) {
      return Json{{"properties", {{section.key, addition}}}};
    }));
  }
  return rules;
}

Json default_json(const StudyKey& key) {
  const double number = *key.by_default;
  if (key.form == KeyForm::boolean) return number != 0.0;
  if (key.form == KeyForm::choice) return key.words[static_cast<std::size_t>(number)].word;
  return key.form == KeyForm::integer ? Json(static_cast<std::int64_t>(number)) : Json(number);
}

Json section_schema(const std::string& path) {
  Json keys = Json::object(), required = Json::array();
  for (const StudyKey& key : study_keys()) {
    if (key.section != path) continue;
    Json form = forms_of(key);
    form["description"] = key.meaning;
    if (key.by_default) form["default"] = default_json(key);
    keys[key.key] = std::move(form);
    if (needs(key, "")) required.push_back(key.key);
  }
  if (written_section(path).starts_with("[[")) keys["repeat"] = repetition_schema();
  Json schema = {{"type", "object"}, {"properties", std::move(keys)}, {"additionalProperties", false}};
  if (!required.empty()) schema["required"] = std::move(required);
  Json rules = rules_of_deciders(path);
  for (const KeyGroup& group : key_groups()) {
    if (group.section == path && *group.of.of == '\0') rules.push_back(group_schema(group));
  }
  if (!is_decided_outside(path)) {
    if (Json rule = rule_of_forms(path, [](Json addition) { return addition; }); !rule.empty())
      rules.push_back(std::move(rule));
  }
  if (path.empty()) rules = rules_of_study();
  if (!rules.empty()) schema["allOf"] = std::move(rules);
  return schema;
}

Json definitions() {
  Json all = Json::object();
  for (const bool is_plain : {false, true}) {
    for (const Limits& limits : {Limits{}, not_negative, positive})
      all[name_of_value(is_plain, limits)] = value_schema(is_plain, limits);
  }
  return all;
}

}  // namespace

int schema_command(std::ostream& out) {
  Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "Study of frahm"}};
  schema.update(section_schema(""));
  schema["$defs"] = definitions();
  out << schema.dump(2) << '\n';
  return exit_code::done;
}

}  // namespace frahm::studies
