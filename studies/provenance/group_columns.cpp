#include "studies/provenance/group_columns.hpp"

namespace frahm::studies {

void GroupColumns::add(const std::string& name, const std::string& unit, const std::string& long_name,
                       const std::string& dimension, std::vector<double> values, results::Type type) {
  columns_.push_back(
      {.variable = {.name = name, .unit = unit.empty() ? "1" : unit, .long_name = long_name, .type = type},
       .dimension = dimension,
       .values = std::move(values)});
}

void GroupColumns::add_number(const std::string& name, const std::string& unit, const std::string& long_name,
                              double value) {
  add(name, unit, long_name, "", {value});
}

void GroupColumns::add_count(const std::string& name, const std::string& long_name,
                             const std::string& dimension, std::vector<double> values) {
  add(name, "1", long_name, dimension, std::move(values), results::Type::int32);
}

void GroupColumns::add_flag(const std::string& name, const std::string& long_name,
                            const std::string& dimension, const std::vector<std::string>& meanings,
                            std::vector<double> values) {
  std::vector<results::Flag> flags{{"not_computed", 0}};
  for (const std::string& meaning : meanings) flags.push_back({meaning, static_cast<int>(flags.size())});
  columns_.push_back(
      {.variable = {.name = name, .long_name = long_name, .type = results::Type::flag, .flags = flags},
       .dimension = dimension,
       .values = std::move(values)});
}

}  // namespace frahm::studies
