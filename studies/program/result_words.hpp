#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace frahm::studies {

// A variable of result files that is no quantity of a response (see FORMAT.md).
struct ResultWord {
  const char* name;  // "*_detuning": of any name before it
  const char* of;    // where it is: "tuning"
  const char* meaning;
};

std::span<const ResultWord> result_words();

// What a name may be, a line for each: of those whose names fit the ones with the longest. `detuning` is also
// `*_detuning`.
std::vector<std::string> result_words_called(std::string_view name);
// Those of exactly this name alone.
std::vector<std::string> result_words_named(std::string_view name);

}  // namespace frahm::studies
