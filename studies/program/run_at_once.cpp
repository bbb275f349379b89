#include "studies/program/run_at_once.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <iostream>
#include <stdexcept>
#include <string>

#include "engine/io_error.hpp"
#include "engine/output_lock.hpp"
#include "engine/stop_request.hpp"
#include "results/map_writer.hpp"
#include "studies/identification/identification_columns.hpp"
#include "studies/motion/one_motion.hpp"
#include "studies/page/finish_result.hpp"
#include "studies/program/exit_code.hpp"
#include "studies/program/refusal_advice.hpp"
#include "studies/provenance/finished_file.hpp"
#include "studies/provenance/provenance.hpp"

namespace frahm::studies {
namespace {

// The reason of a stop.
struct Stopped {
  std::string reason;
};

// Throws Stopped on a signal, or when the time budget is used up.
transient::Watch watch_for_stop(const engine::StopRequest& stop) {
  return [&stop] {
    if (stop.asked()) throw Stopped{stop.reason()};
  };
}

void refuse_sharing(const RunCommandOptions& options, const Study& study) {
  if (options.run.shard.count <= 1) return;
  throw StudyError(rules::other_kind,
                   "{}: {} is a single piece of work, which an array of tasks cannot share",
                   study.source.name, kind_noun(study.kind()));
}

// An identification must not replace a file that it reads.
void refuse_own_data(const Study& study, const std::filesystem::path& output) {
  if (!study.identify()) return;
  std::error_code ignored;  // a missing file is no data file
  for (const std::filesystem::path& file : study.identify()->files) {
    if (std::filesystem::equivalent(output, file, ignored))
      throw engine::IoError(output, "is a file that the study reads; name another for the result with -o");
  }
}

void write_file(const StudyPlan& plan, const RunFacts& facts, const std::filesystem::path& output,
                const results::GroupContent& group) {
  const results::MapLayout layout = file_layout(plan, facts);
  results::MapWriter writer(output, layout);
  writer.write_group(group);
  finish_result(writer, plan, layout, facts);
}

// Returns the exit code.
int compute(const StudyPlan& plan, const RunFacts& facts, const std::filesystem::path& output,
            const transient::Watch& watch, std::ostream& out) {
  const Study& study = plan.study;
  const std::string group(kind_name(study.kind()));
  switch (study.kind()) {
    case StudyKind::identify: {
      const IdentificationResult result = identify(study, watch);
      write_file(plan, facts, output,
                 {.path = identification_group,
                  .columns = identification_columns(study, result),
                  .texts = identification_texts(study, result)});
      print_identification(study, result, out);
      return result.fit.converged ? exit_code::done : exit_code::not_converged;
    }
    case StudyKind::decay: {
      const transient::FreeDecay decay = solve_decay(study, watch);
      write_file(plan, facts, output, {.path = group, .columns = decay_columns(study, decay)});
      print_decay(study, decay, out);
      return exit_code::done;
    }
    case StudyKind::transient: {
      const transient::ForcedMotion motion = solve_transient(study, watch);
      write_file(plan, facts, output, {.path = group, .columns = transient_columns(study, motion)});
      print_transient(study, motion, out);
      return exit_code::done;
    }
    case StudyKind::sweep:
    case StudyKind::tune:
      break;
  }
  throw std::logic_error(fmt::format("{} is not a single piece of work", kind_noun(study.kind())));
}

}  // namespace

int run_at_once(const RunCommandOptions& options, Study study, std::ostream& out) {
  refuse_sharing(options, study);
  const RunFacts facts{.command = options.command, .threads = 1, .started = utc_now()};
  const StudyPlan plan = plan_without_map(std::move(study), options.set);
  const std::filesystem::path output =
      options.run.output.empty() ? default_output(options.study) : options.run.output;
  refuse_own_data(plan.study, output);
  check_result_place(output, options.study, options.run.fresh);
  const engine::OutputLock lock(output);
  if (!options.run.fresh) refuse_another_result(output, plan);
  make_room_beside(output, plan, options.run.fresh);

  int code = exit_code::done;
  try {
    const engine::StopRequest stop(options.run.time_budget,
                                   std::chrono::steady_clock::now() - options.run.begun,
                                   options.run.called_off);
    code = compute(plan, facts, output, watch_for_stop(stop), out);
  } catch (const Stopped& stopped) {
    fmt::print(std::cerr, "{}: nothing is kept of a single piece of work, which starts again\n",
               stopped.reason);
    return exit_code::stopped;
  }
  fmt::print(out, "\n{}\n", output.string());
  return code;
}

}  // namespace frahm::studies
