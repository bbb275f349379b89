#include "studies/program/refusal_advice.hpp"

#include <fmt/format.h>

#include "engine/fingerprint.hpp"
#include "studies/record/finished_file.hpp"
#include "studies/record/study_changes.hpp"

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

void refuse_another_result(const std::filesystem::path& output, const StudyPlan& plan) {
  const auto kept = fingerprint_of_file(output);
  if (!kept || *kept == plan.fingerprint) return;
  throw engine::ResumeRefused(output, *kept, plan.fingerprint, refusal_advice(changes_since(output, plan)));
}

}  // namespace frahm::studies
