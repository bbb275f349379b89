#include "studies/program/check_tuning.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <string>

#include "engine/progress.hpp"
#include "engine/team.hpp"
#include "studies/program/array_job.hpp"
#include "studies/program/exit_code.hpp"
#include "studies/program/memory_use.hpp"
#include "studies/program/modes_table.hpp"
#include "studies/program/readable_size.hpp"
#include "studies/reading/study/series_text.hpp"
#include "studies/tuning/tuning_plan.hpp"
#include "studies/tuning/tuning_sample.hpp"
#include "studies/tuning/tuning_table.hpp"

namespace frahm::studies {
namespace {

void print_design_range(const Study& study, const DesignChoice& design, std::ostream& out) {
  const double factor = design.unit.si_factor;
  const bool has_unit = !design.unit.text.empty() && design.unit.text != "1";
  fmt::print(out, "{:<22}{:.6g} .. {:.6g}{}{}, from {:.6g}", study.parameters.list[design.parameter].name,
             design.lower / factor, design.upper / factor, has_unit ? " " : "",
             has_unit ? design.unit.text : "", study.parameters.nominal()[design.parameter] / factor);
  if (design.is_scheduled()) fmt::print(out, ", scheduled at {} knots", design.knots.size());
  fmt::print(out, "{}\n", design.rule ? ", next to a rule" : "");
}

std::string rough_time(double seconds) {
  return seconds < 9.95 ? fmt::format("{:.2g} s", seconds) : engine::readable_time(seconds);
}

// A thread computes whole starts, so that some threads may wait for the last.
void print_prediction(const TuningSample& sample, const MemoryUse& memory, std::uint64_t starts,
                      int wanted_threads, std::ostream& out) {
  const int threads = engine::team_size(wanted_threads, starts);
  const auto team = static_cast<std::uint64_t>(threads);
  const std::uint64_t whole_turns = (starts + team - 1) / team;
  const auto turns = static_cast<double>(whole_turns);
  const std::string least = rough_time(turns * sample.least_seconds + sample.assessment_seconds);
  const std::string most = rough_time(turns * sample.most_seconds + sample.assessment_seconds);
  fmt::print(out, "{:<22}about {}{}{} on {} thread{} of this machine", "time", least,
             least == most ? "" : " to ", least == most ? "" : most, threads, threads == 1 ? "" : "s");
  if (sample.is_whole) {
    fmt::print(out, " (the first start took {:.2g} s)\n", sample.seconds);
  } else {
    fmt::print(out, " ({:.3g} responses/s on one; a start takes about {:.2g} to {:.2g})\n",
               static_cast<double>(sample.responses) / sample.seconds, sample.least_responses,
               sample.most_responses);
  }
  fmt::print(out, "{:<22}about {}\n", "memory", readable_size(memory.of_run(threads)));
}

void print_heading(const Study& study, const TuningSample& sample, std::ostream& out) {
  if (!sample.why_no_design.empty()) {
    fmt::print(out, "{} can be read, but its first start finds no design: {}\n\n", study.source.name,
               sample.why_no_design);
    return;
  }
  fmt::print(out, "{} is a valid study{}{}\n\n", study.source.name, study.title.empty() ? "" : ": ",
             study.title);
}

// Other designs may have modes where the one that the study states has none.
void print_modes_before(const Study& study, Listing listing, std::ostream& out) {
  try {
    print_stated_modes(study, modes_at_point(study, stated_values(study)), listing, out);
  } catch (const mechanics::MechanicsError& error) {
    fmt::print(out, "The design of the study has no modes: {}\n", error.what());
  }
}

}  // namespace

int check_tuning(const CheckOptions& options, Study read, std::ostream& out) {
  constexpr double sample_seconds = 2.0;
  const StudyPlan plan = plan_tuning(std::move(read), options.set);
  const Study& study = plan.study;
  const MemoryUse memory;
  const TuningSample sample = sample_tuning(plan, sample_seconds);
  print_heading(study, sample, out);
  print_task(study, out);
  for (const std::string& text : series_texts(study.values)) fmt::print(out, "{:<22}{}\n", "series", text);
  std::size_t variables = 0;
  for (const DesignChoice& design : study.tune()->designs) {
    print_design_range(study, design, out);
    variables += design.is_scheduled() ? design.knots.size() : 1;
  }
  fmt::print(out, "{:<22}{}\n{:<22}{}\n{:<22}{}\n", "variables", variables, "limits",
             study.tune()->limits.size() + (study.tune()->trade_off ? 1 : 0), "starts", plan.tiles);
  print_prediction(sample, memory, plan.tiles, options.threads, out);
  fmt::print(out, "\n");
  print_modes_before(study, options.listing(), out);
  if (plan.tiles > 1) {
    const auto starts = static_cast<double>(plan.tiles);
    print_array_job({.study = options.study,
                     .set = options.set,
                     .noun = "tuning",
                     .tiles = plan.tiles,
                     .core_seconds = starts * sample.most_seconds,
                     .most_tasks = options.max_array > 0 ? options.max_array : most_array_tasks()},
                    out);
  }
  return sample.why_no_design.empty() ? exit_code::done : exit_code::not_converged;
}

}  // namespace frahm::studies
