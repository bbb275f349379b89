#include "studies/program/refusal_advice.hpp"

#include <fmt/format.h>

namespace frahm::studies {

std::string refusal_advice(const std::vector<std::string>& changes, const std::string& advice) {
  constexpr std::size_t most_told = 8;  // lines; of a study that shares but its name all differs
  std::string text;
  for (std::size_t i = 0; i < changes.size() && i < most_told; ++i) text += fmt::format("  {}\n", changes[i]);
  if (changes.size() > most_told) text += fmt::format("  and {} more\n", changes.size() - most_told);
  if (!text.empty()) text = "what changed:\n" + text;
  return text + (advice.empty()
                     ? "it is not replaced unasked: name another file with -o, or discard what is there "
                       "with --fresh"
                     : advice);
}

}  // namespace frahm::studies
