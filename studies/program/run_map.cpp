#include "studies/program/run_map.hpp"

#include <optional>

#include "studies/map/assemble.hpp"
#include "studies/map/known_points.hpp"
#include "studies/map/map_words.hpp"
#include "studies/map/unfit_systems.hpp"
#include "studies/program/growing.hpp"
#include "studies/program/logged_run.hpp"
#include "studies/program/map_table.hpp"
#include "studies/program/study_note.hpp"
#include "studies/provenance/finished_file.hpp"

namespace frahm::studies {

int run_map(const RunCommandOptions& options, Study study, std::ostream& out) {
  engine::RunOptions run = options.run;
  if (run.output.empty()) run.output = default_output(options.study);
  MapPlan plan = plan_map(std::move(study), options.set);
  refuse_unfit_map(plan.study);
  std::optional<KnownPoints> earlier;
  const auto job = [&] {
    if (!options.from.empty()) plan.grown_from = earlier.emplace(plan, options.from).source();
    if (earlier) refuse_loss(plan, *earlier, options.from, run.output);
    // What a stopped run has computed is kept, also where a file that was whole no longer is.
    if (earlier && !has_log_of(run.output, plan)) earlier->check(run.shard.index, run.shard.count);
    return job_of(plan, earlier ? &*earlier : nullptr);
  };
  const auto make_file = [&](const RunFacts& facts, const AssemblyOptions& how,
                             const engine::OutputLock& held) {
    earlier.reset();  // the new file may replace it
    return assemble(plan, facts, how, held).finished;
  };
  const auto tell = [&](std::optional<Effort> effort) {
    return print_map_table(plan, options.study, run.output, effort, out);
  };
  return run_in_logs(options, run, plan,
                     {.job = job,
                      .assemble = make_file,
                      .words = [&](const Study& kept,
                                   const results::MapReader& file) { return words_of_map(plan, kept, file); },
                      .tell_what_stands = [&] { return tell(std::nullopt); },
                      .tell_made = tell},
                     out);
}

}  // namespace frahm::studies
