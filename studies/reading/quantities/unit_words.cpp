#include "studies/reading/quantities/unit_words.hpp"

#include <fmt/format.h>

namespace frahm::studies {

bool is_pure_number(const std::string& unit) {
  return unit.empty() || unit == "1";
}

std::string with_unit(const std::string& number, const std::string& unit) {
  return is_pure_number(unit) ? number : fmt::format("{} {}", number, unit);
}

std::string with_unit(double number, const std::string& unit) {
  return with_unit(fmt::format("{}", number), unit);
}

std::string in_brackets(const std::string& name, const std::string& unit) {
  return is_pure_number(unit) ? name : fmt::format("{} [{}]", name, unit);
}

}  // namespace frahm::studies
