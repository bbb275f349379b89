#include "studies/program/refusal_advice.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/io_error.hpp"
#include "engine/tile_index.hpp"
#include "studies/program/study_note.hpp"
#include "studies/provenance/finished_file.hpp"
#include "studies/provenance/study_changes.hpp"

namespace frahm::studies {

std::string lines_of_changes(const std::vector<std::string>& changes) {
  constexpr std::size_t most_lines = 8;  // lines; of a study that shares but its name all differs
  std::string text;
  for (std::size_t i = 0; i < changes.size() && i < most_lines; ++i)
    text += fmt::format("  {}\n", changes[i]);
  if (changes.size() > most_lines) text += fmt::format("  and {} more\n", changes.size() - most_lines);
  return text;
}

std::string refusal_advice(const std::vector<std::string>& changes, const std::string& advice) {
  std::string text = lines_of_changes(changes);
  if (!text.empty()) text = "what changed:\n" + text;
  return text + (advice.empty() ? "it is not replaced without --fresh: name another file with -o, or discard "
                                  "this one with --fresh"
                                : advice);
}

void refuse_another_result(const std::filesystem::path& output, const StudyPlan& plan) {
  if (!std::filesystem::exists(output)) return;
  const results::MapReader standing(output);
  const engine::Fingerprint kept = fingerprint_of(standing);
  if (kept == plan.fingerprint) return;
  throw engine::ResumeRefused(output, kept, plan.fingerprint,
                              refusal_advice(changes_since(standing, output, plan)));
}

std::vector<std::string> changes_since_logs(const engine::ResumeRefused& refused, const Study& now,
                                            const std::filesystem::path& output) {
  try {
    return study_changes(study_from_note({output}, refused.kept()).study, now);
  } catch (const engine::IoError&) {
    return {};
  } catch (const StudyError&) {  // its tables are gone
    return {};
  }
}

void make_room_beside(const std::filesystem::path& output, const StudyPlan& plan, bool fresh) {
  const std::vector<std::filesystem::path> logs = engine::find_logs(output);
  if (logs.empty()) return;
  if (fresh) {
    engine::remove_logs(logs);
    remove_study_notes(output);
    return;
  }
  try {
    engine::index_tiles(logs, plan.log_header(), [](std::uint64_t, std::span<const std::byte>) {});
  } catch (const engine::ResumeRefused& refused) {
    // A branch has the physics of its study, in which nothing has changed.
    const auto changes = refused.physics_differs() ? changes_since_logs(refused, plan.study, output)
                                                   : std::vector<std::string>();
    throw engine::ResumeRefused(refused, refusal_advice(changes));
  }
}

}  // namespace frahm::studies
