#include "studies/program/assist_command.hpp"

#include <optional>

#include "engine/assist.hpp"
#include "studies/map/known_points.hpp"
#include "studies/map/map_plan.hpp"
#include "studies/reading/settings.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/tuning/tuning_plan.hpp"

namespace frahm::studies {

int assist_command(const RunCommandOptions& options) {
  Study study = read_study_with(options.study, options.set);
  engine::RunOptions run = options.run;
  if (run.output.empty()) run.output = default_output(options.study);
  if (study.map()) {
    MapPlan plan = plan_map(std::move(study), options.set);
    std::optional<KnownPoints> earlier;
    if (!options.from.empty()) plan.grown_from = earlier.emplace(plan, options.from).source();
    return engine::assist(job_of(plan, earlier ? &*earlier : nullptr), run);
  }
  if (study.kind() == StudyKind::tune) {
    const StudyPlan plan = plan_tuning(std::move(study), options.set);
    return engine::assist(job_of_tuning(plan), run);
  }
  return engine::wait_for_end(*run.ranks);
}

}  // namespace frahm::studies
