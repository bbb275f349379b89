#include "results/report/page_data.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>
#include <stdexcept>

#include "results/box.hpp"
#include "results/report/page_numbers.hpp"

namespace frahm::results {
namespace {

using Json = nlohmann::ordered_json;

constexpr int page_format = 1;
constexpr const char* provenance_group = "provenance";
constexpr const char* branches_group = "branches";
constexpr const char* statistics_group = "statistics";
constexpr const char* tornado_group = "tornado";

const char* kind_of(Type type) {
  switch (type) {
    case Type::float64:
    case Type::float32:
      return "float";
    case Type::int64:
    case Type::int32:
      return "count";
    case Type::flag:
      break;
  }
  return "flag";
}

Json described(const Variable& variable) {
  Json json{{"name", variable.name}, {"unit", variable.unit}, {"long_name", variable.long_name}};
  json["kind"] = kind_of(variable.type);
  if (variable.type != Type::flag) return json;
  json["flags"] = Json::array();
  for (const Flag& flag : variable.flags) json["flags"].push_back({flag.value, flag.meaning});
  return json;
}

Json axis_json(const Axis& axis) {
  Json json{{"name", axis.name}, {"size", axis.size}, {"coordinates", Json::array()}};
  for (const Coordinate& coordinate : axis.coordinates) {
    json["coordinates"].push_back({{"name", coordinate.name},
                                   {"unit", coordinate.unit},
                                   {"long_name", coordinate.long_name},
                                   {"values", coordinate.values}});
    if (!coordinate.names.empty()) json["coordinates"].back()["names"] = coordinate.names;
  }
  return json;
}

// The longest axis: along it neighbours are most alike.
std::size_t longest(const Shape& shape) {
  return static_cast<std::size_t>(std::max_element(shape.begin(), shape.end()) - shape.begin());
}

LineShape lines_along(const Shape& shape, std::size_t axis) {
  return {shape[axis], product(std::span(shape).subspan(axis + 1))};
}

using Carried = std::map<std::string, std::string>;  // levels -> the variable that has them in the page

// Writes values to six digits. Levels equal to those of an earlier variable are replaced by its name:
// suspension and main mass, say, may move alike.
void put_levels(Json& json, const Variable& variable, std::span<const double> values, const Shape& shape,
                Carried& carried) {
  const bool whole = variable.type == Type::flag || variable.type == Type::int32;
  const PackedLevels packed =
      pack_levels(values, lines_along(shape, longest(shape)), whole ? Spacing::whole : Spacing::six_digits);
  json["scale"] = packed.logarithmic ? "log" : "linear";
  json["low"] = packed.low;
  json["step"] = packed.step;
  const auto [carrier, is_new] = carried.try_emplace(packed.levels, variable.name);
  if (is_new) {
    json["levels"] = packed.levels;
  } else {
    json["levels_of"] = carrier->second;
  }
}

Json variable_json(const MapReader& result, std::size_t v, bool all_digits, Carried& carried) {
  const Variable& variable = result.layout().variables[v];
  const Shape shape = shape_of(result.layout());
  const std::vector<double> values = result.read(v, Shape(shape.size(), 0), shape);
  Json json = described(variable);
  if (all_digits) {
    json["values"] = packed_numbers(values);
  } else {
    put_levels(json, variable, values, shape, carried);
  }
  return json;
}

std::size_t index_of(const MapLayout& layout, const std::string& name) {
  const auto found = std::find_if(layout.variables.begin(), layout.variables.end(),
                                  [&](const Variable& variable) { return variable.name == name; });
  if (found != layout.variables.end()) return static_cast<std::size_t>(found - layout.variables.begin());
  throw std::invalid_argument(fmt::format("the map has no quantity \"{}\"", name));
}

std::optional<std::string> page_text(const MapReader& result, const std::string& name) {
  if (!result.has_group(page_group)) return std::nullopt;
  const std::vector<Text> texts = result.texts(page_group);
  const auto found = std::ranges::find(texts, name, &Text::first);
  return found == texts.end() ? std::nullopt : std::optional(found->second);
}

// The coordinates of the map that are the study's own parameters; of an earlier file those of the axes.
std::vector<std::string> parameters_of(const MapReader& result) {
  if (auto parameters = page_list(result, parameters_text)) return *parameters;
  std::vector<std::string> names;
  for (const Axis& axis : result.layout().axes) names.push_back(axis.name);
  return names;
}

Json map_json(const MapReader& result, const PageContent& content) {
  const std::vector<std::string>& chosen = content.variables;
  const MapLayout& layout = result.layout();
  Json json{
      {"axes", Json::array()}, {"along", longest(shape_of(layout))}, {"parameters", parameters_of(result)}};
  const auto samples = std::ranges::find(layout.axes, page_text(result, samples_text), &Axis::name);
  if (samples != layout.axes.end()) json["samples"] = samples - layout.axes.begin();
  for (const Axis& axis : layout.axes) json["axes"].push_back(axis_json(axis));
  json["variables"] = json["left_out"] = Json::array();
  Carried carried;
  for (const std::string& name : chosen)
    json["variables"].push_back(variable_json(result, index_of(layout, name), content.all_digits, carried));
  for (const Variable& variable : layout.variables) {
    if (std::find(chosen.begin(), chosen.end(), variable.name) == chosen.end())
      json["left_out"].push_back(described(variable));
  }
  return json;
}

Json column_json(const Column& column) {
  Json json = described(column.variable);
  json["dimension"] = column.dimension;
  json["values"] = packed_numbers(column.values);
  return json;
}

Json texts_json(const std::vector<Text>& texts) {
  Json json = Json::object();
  for (const auto& [name, text] : texts) json[name] = text;
  return json;
}

Json group_json(const std::vector<Text>& texts, const std::vector<Column>& columns) {
  Json json{{"texts", texts_json(texts)}, {"columns", Json::array()}};
  for (const Column& column : columns) json["columns"].push_back(column_json(column));
  return json;
}

// The map's quantity that a number of /statistics or /tornado is of: "main_peak_time" of
// "main_peak_time_q95".
std::string quantity_of(const Column& column, const MapLayout& layout) {
  std::string longest_name;
  for (const Variable& variable : layout.variables) {
    if (column.variable.name.starts_with(variable.name + "_") && variable.name.size() > longest_name.size())
      longest_name = variable.name;
  }
  return longest_name;
}

// Without the quantities of the map that the page leaves out.
std::vector<Column> shown_columns(const MapReader& result, const PageContent& content,
                                  const std::string& group) {
  std::vector<Column> columns = result.columns(group);
  const MapLayout& layout = result.layout();
  const auto is_left_out = [&](const std::string& name) {
    return std::ranges::find(layout.variables, name, &Variable::name) != layout.variables.end() &&
           std::ranges::find(content.variables, name) == content.variables.end();
  };
  if (group == branches_group) {
    std::erase_if(columns, [&](const Column& column) {
      return is_left_out(column.variable.name) && column.dimension != "branch";
    });
  } else if (group == statistics_group || group == tornado_group) {
    std::erase_if(columns, [&](const Column& column) { return is_left_out(quantity_of(column, layout)); });
  }
  return columns;
}

// Every group of the file except the provenance, by its path; those in /page without it.
Json groups_json(const MapReader& result, const PageContent& content) {
  const std::string in_page = std::string(page_group) + "/";
  Json json = Json::object();
  for (const std::string& name : result.groups()) {
    if (name == provenance_group || name == page_group) continue;
    json[name.starts_with(in_page) ? name.substr(in_page.size()) : name] =
        group_json(result.texts(name), shown_columns(result, content, name));
  }
  return json;
}

std::string without_markup(const std::string& text) {
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      escaped += "\\u003c";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

}  // namespace

std::optional<std::vector<std::string>> page_list(const MapReader& result, const std::string& text) {
  const std::optional<std::string> joined = page_text(result, text);
  if (!joined) return std::nullopt;
  std::vector<std::string> names;
  std::istringstream stream(*joined);
  for (std::string name; std::getline(stream, name, ',');) names.push_back(name);
  return names;
}

std::string page_data(const MapReader& result, const PageContent& content) {
  const MapLayout& layout = result.layout();
  Json json{{"format", page_format},
            {"file", content.file},
            {"title", layout.title},
            {"source", layout.source},
            {"history", layout.history}};
  json["map"] = layout.axes.empty() ? Json() : map_json(result, content);
  json["groups"] = groups_json(result, content);
  json["provenance"] = texts_json(result.texts(provenance_group));
  return without_markup(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace frahm::results
