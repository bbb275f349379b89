#include "studies/program/run_tuning.hpp"

#include <fmt/ostream.h>

#include <iostream>
#include <optional>

#include "results/map_reader.hpp"
#include "studies/program/exit_code.hpp"
#include "studies/program/logged_run.hpp"
#include "studies/program/status_command.hpp"
#include "studies/tuning/assemble_tuning.hpp"
#include "studies/tuning/optimum_columns.hpp"
#include "studies/tuning/outcome_words.hpp"
#include "studies/tuning/tuning_plan.hpp"
#include "studies/tuning/tuning_table.hpp"
#include "studies/tuning/tuning_words.hpp"

namespace frahm::studies {
namespace {

// The exit code of a tuning that was finished before, from the outcomes in its file.
int code_of_file(const std::filesystem::path& file) {
  const results::MapReader result(file);
  const bool is_front = result.has_group(front_group);
  for (const results::Column& column : result.columns(is_front ? front_group : optimum_group)) {
    if (column.variable.name != "outcome") continue;
    for (const double outcome : column.values) {
      if (outcome != 1.0 + static_cast<int>(tuning::Outcome::converged)) return exit_code::not_converged;
    }
  }
  return exit_code::done;
}

}  // namespace

int tell_tuning(const StudyPlan& plan, const TuningResult& result, const std::filesystem::path& file,
                std::ostream& out) {
  print_tuning(plan.study, result, out);
  fmt::print(out, "{:<22}{}\n", "file", file.string());
  int code = exit_code::done;
  for (std::size_t i = 0; i < result.limits(); ++i) {
    const tuning::Optimum& optimum = result.optimum(i);
    if (optimum.outcome == tuning::Outcome::converged) continue;
    code = exit_code::not_converged;
    fmt::print(std::cerr, "{}: {}; the best design so far is in the file\n",
               outcome_words().at(static_cast<std::size_t>(optimum.outcome)), optimum.reason);
  }
  return code;
}

int run_tuning(const RunCommandOptions& options, Study study, std::ostream& out) {
  engine::RunOptions run = options.run;
  if (run.output.empty()) run.output = default_output(options.study);
  const StudyPlan plan = plan_tuning(std::move(study), options.set);
  std::optional<TuningResult> result;
  const auto make_file = [&](const RunFacts& facts, const AssemblyOptions& how,
                             const engine::OutputLock& held) {
    result = assemble_tuning(plan, facts, how, held);
    return result.has_value();
  };
  const auto tell_what_stands = [&] {
    status_command(run.output, out);
    return code_of_file(run.output);
  };
  const auto tell_made = [&](const Effort& effort) {
    const int code = tell_tuning(plan, *result, run.output, out);
    fmt::print(out, "{:<22}{:.2f} s wall, {:.2f} s CPU on {}\n", "time", effort.seconds, effort.cpu_seconds,
               team_text(effort.threads, effort.ranks));
    return code;
  };
  return run_in_logs(
      options, run, plan,
      {.job = [&] { return job_of_tuning(plan); },
       .assemble = make_file,
       .words = [&](const Study& kept, const results::MapReader&) { return words_of_tuning(plan, kept); },
       .tell_what_stands = tell_what_stands,
       .tell_made = tell_made},
      out);
}

}  // namespace frahm::studies
