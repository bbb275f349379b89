#include "studies/program/run_motion.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include "engine/fingerprint.hpp"
#include "results/map_writer.hpp"
#include "studies/map/finished_file.hpp"
#include "studies/map/map_record.hpp"
#include "studies/motion/motion_record.hpp"
#include "studies/program/exit_code.hpp"

namespace frahm::studies {
namespace {

void refuse_sharing(const RunCommandOptions& options, const StudyFile& study) {
  if (options.run.shard.count <= 1) return;
  throw StudyError(fmt::format("{}: a {} is one motion, which an array of tasks cannot share",
                               study.source.name, kind_name(study.kind)));
}

void refuse_another_study(const MapPlan& plan, const std::filesystem::path& output) {
  const auto kept = fingerprint_of_file(output);
  if (!kept || *kept == plan.fingerprint) return;
  throw engine::ResumeRefused(output, {*kept, 1}, {plan.fingerprint, 1});
}

void write_file(const MapPlan& plan, const RunRecord& record, const std::filesystem::path& output,
                const std::vector<results::Column>& columns) {
  results::MapWriter writer(output, map_layout(plan, record));
  writer.write_columns(std::string(kind_name(plan.study.kind)), columns);
  writer.write_texts("provenance", provenance(plan, record, {}));
  writer.finish();
}

}  // namespace

int run_motion(const RunCommandOptions& options, StudyFile study, std::ostream& out) {
  refuse_sharing(options, study);
  const RunRecord record{.command = options.command, .threads = 1, .started = utc_now()};
  const MapPlan plan = plan_motion(std::move(study), options.set);
  const std::filesystem::path output =
      options.run.output.empty() ? default_output(options.study) : options.run.output;
  if (!options.run.fresh) refuse_another_study(plan, output);

  if (plan.study.kind == StudyKind::decay) {
    const transient::FreeDecay decay = solve_decay(plan.study);
    write_file(plan, record, output, decay_columns(plan.study, decay));
    print_decay(plan.study, decay, out);
  } else {
    const transient::ForcedMotion motion = solve_transient(plan.study);
    write_file(plan, record, output, transient_columns(plan.study, motion));
    print_transient(plan.study, motion, out);
  }
  fmt::print(out, "\n{}\n", output.string());
  return exit_code::done;
}

}  // namespace frahm::studies
