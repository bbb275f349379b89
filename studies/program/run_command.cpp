#include "studies/program/run_command.hpp"

#include <fmt/format.h>

#include "engine/stop_signals.hpp"
#include "studies/program/run_at_once.hpp"
#include "studies/program/run_map.hpp"
#include "studies/program/run_tuning.hpp"
#include "studies/reading/settings.hpp"

namespace frahm::studies {

std::filesystem::path default_output(const std::filesystem::path& study) {
  return study.stem().string() + ".h5";
}

int run_command(const RunCommandOptions& options, std::ostream& out) {
  engine::let_failed_writes_return();
  return run_study(options, read_study_with(options.study, options.set), out);
}

int run_study(const RunCommandOptions& options, Study study, std::ostream& out) {
  if (study.map()) return run_map(options, std::move(study), out);
  if (!options.from.empty())
    throw StudyError(rules::other_kind, "{}: {} has no points to reuse from {}: --from is for maps",
                     study.source.name, kind_noun(study.kind()), options.from.string());
  if (study.kind() == StudyKind::tune) return run_tuning(options, std::move(study), out);
  return run_at_once(options, std::move(study), out);
}

}  // namespace frahm::studies
