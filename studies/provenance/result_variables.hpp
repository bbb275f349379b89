#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "results/layout.hpp"

namespace frahm::studies {

// A variable of results that is not a quantity of a response or a motion (results/FORMAT.md). Its row alone
// says what it means: in the file (`long_name`), on the page, and in `frahm explain`.
struct ResultVariable {
  const char* name;  // "*_detuning": the study gives what stands for the *
  const char* of;    // the results that have it: "tuning, front"
  // "largest slope of {a schedule}": in a file the braces hold the name that the study gives.
  const char* meaning;
};

std::span<const ResultVariable> result_variables();

// What a name may be, a line for each: of those whose names fit the ones with the longest. `detuning` is also
// `*_detuning`. shortest: names with fewer letters are left out.
std::vector<std::string> result_variables_called(std::string_view name, std::size_t shortest = 0);
// Those of exactly this name alone.
std::vector<std::string> result_variables_named(std::string_view name);

// The name of a variable and its meaning, by its row.
class Named {
 public:
  // row: its name in the table. Throws std::logic_error if there is no such row: a mistake of ours.
  Named(const char* row) : Named(row, {}, {}) {}
  // "*_detuning" of "k2", which the meaning names too.
  Named(const char* row, const std::string& star) : Named(row, {star}, {star}) {}
  // stars: what stands for each * of the name. words: what stands in the braces of the meaning, in their
  // order; braces beyond them keep their own words.
  Named(std::string_view row, const std::vector<std::string>& stars, const std::vector<std::string>& words);
  // A variable that the study itself names.
  static Named by_study(std::string name, std::string meaning);

  const std::string& name() const { return name_; }
  const std::string& meaning() const { return meaning_; }

 private:
  Named() = default;
  std::string name_, meaning_;
};

// unit: in the form of UDUNITS; "" is 1.
results::Variable variable(const Named& named, const std::string& unit = "1",
                           results::Type type = results::Type::float64);
// Of values 1, 2, ... with these meanings; 0 is not_computed.
results::Variable flag_variable(const Named& named, const std::vector<std::string>& meanings);

}  // namespace frahm::studies
