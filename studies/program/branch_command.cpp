#include "studies/program/branch_command.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <iomanip>
#include <iostream>
#include <map>

#include "engine/output_lock.hpp"
#include "results/map_writer.hpp"
#include "solvers/branches/branch.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "studies/map/branch_group.hpp"
#include "studies/map/branch_rows.hpp"
#include "studies/map/output_quantities.hpp"
#include "studies/page/finish_result.hpp"
#include "studies/program/branch_table.hpp"
#include "studies/program/exit_code.hpp"
#include "studies/program/refusal_advice.hpp"
#include "studies/program/whole_file.hpp"
#include "studies/provenance/fingerprint.hpp"
#include "studies/provenance/finished_file.hpp"
#include "studies/provenance/provenance.hpp"
#include "studies/reading/map/grid_check.hpp"
#include "studies/reading/settings.hpp"
#include "studies/reading/study/assignment.hpp"
#include "studies/reading/study/named_parameter.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_units.hpp"
#include "studies/reading/system/unfit_elements.hpp"

namespace frahm::studies {
namespace {

std::size_t parameter_along(const Study& study, const std::string& name) {
  if (const auto refusal = why_not_a_number(study.parameters, name, "a branch needs one that is a number"))
    throw StudyError(refusal->rule, "--along {}: {}", name, refusal->text);
  return *study.parameters.find(name);
}

bool is_result(const std::filesystem::path& output) {
  return output.extension() == ".h5";
}

void check_options(const Study& study, const BranchCommandOptions& options) {
  if (study.kind() != StudyKind::sweep) {
    throw StudyError(rules::other_kind, "{}: {} has no branches; only the responses of a sweep have them",
                     study.source.name, kind_noun(study.kind()));
  }
  refuse_smooth_laws(study, "a branch");
  if (options.output == "-") {
    throw StudyError(rules::wrong_option,
                     "--output \"-\": the special points go to standard output; name a file");
  }
  if (options.fresh && !(options.output && is_result(*options.output)))
    throw StudyError(rules::wrong_option, "--fresh: it needs a result, --output FILE.h5");
}

// An end of the range [SI]: as the option says, otherwise that of the parameter's axis.
double end_of_range(const Study& study, std::size_t parameter, const char* option,
                    const std::optional<std::string>& given, bool is_upper) {
  const std::string& name = study.parameters.list[parameter].name;
  if (given) return parse_assignments(study, option, name + "=" + *given).front().value;
  if (const auto* axis = of_parameter(study.map()->axes, parameter))
    return is_upper ? std::ranges::max(axis->si_values) : std::ranges::min(axis->si_values);
  throw StudyError(rules::wrong_option, "--along {}: it is not an axis of the study, so give {}", name,
                   option);
}

// Where the first response is searched [SI]: where --at puts the parameter, otherwise at the start of the
// range.
double start_of(const Study& study, std::size_t parameter, const BranchCommandOptions& options, double low,
                double high) {
  double start = low;
  for (const std::string& text : options.at) {
    for (const Assignment& each : parse_assignments(study, "--at", text))
      if (each.parameter == parameter) start = each.value;
  }
  if (start >= low && start <= high) return start;
  throw StudyError(rules::out_of_range, "--at {} = {}: must be within the range of the branch, {} to {}",
                   study.parameters.list[parameter].name, spoken_text(study, parameter, start),
                   spoken_text(study, parameter, low), spoken_text(study, parameter, high));
}

// A line that says how far the branch is, on a terminal.
class Counter {
 public:
  Counter(const Study& study, std::size_t parameter, engine::ProgressStyle style)
      : study_(study), parameter_(parameter), form_(engine::progress_form(style)) {}
  ~Counter() {
    if (has_printed_) std::cerr << '\r' << std::setw(kWidth) << "" << '\r';
  }
  void operator()(const periodic::BranchPoint& point) {
    ++points_;
    const auto now = std::chrono::steady_clock::now();
    const bool on_terminal =
        form_ == engine::ProgressForm::bar || form_ == engine::ProgressForm::coloured_bar;
    if (!on_terminal || now < next_) return;
    next_ = now + std::chrono::milliseconds(100);
    has_printed_ = true;
    const SpokenValue value = spoken_value(study_, parameter_, point.parameter);
    const std::string text = fmt::format("{} points, {} = {:.6g} {}", points_,
                                         study_.parameters.list[parameter_].name, value.value, value.unit);
    fmt::print(std::cerr, "\r{:{}}", text, kWidth);
    std::cerr.flush();
  }

 private:
  static constexpr int kWidth = 60;
  const Study& study_;
  std::size_t parameter_;
  engine::ProgressForm form_;
  std::size_t points_ = 0;
  bool has_printed_ = false;
  std::chrono::steady_clock::time_point next_ =
      std::chrono::steady_clock::now() + std::chrono::milliseconds(500);
};

periodic::BranchWanted wanted_branch(const Study& study, std::size_t along,
                                     const BranchCommandOptions& options) {
  periodic::BranchWanted wanted;
  wanted.low = end_of_range(study, along, "--from", options.from, false);
  wanted.high = end_of_range(study, along, "--to", options.to, true);
  if (!(wanted.low < wanted.high))
    throw StudyError(rules::wrong_order, "--from {}: must be below --to, {}",
                     spoken_text(study, along, wanted.low), spoken_text(study, along, wanted.high));
  wanted.start = start_of(study, along, options, wanted.low, wanted.high);
  wanted.most_points = options.steps;
  wanted.multiple = options.multiple;
  return wanted;
}

void check_place(const BranchCommandOptions& options) {
  if (!options.output) return;
  if (is_result(*options.output))
    check_result_place(*options.output, options.study, options.fresh);
  else
    check_output_is_not_input(*options.output, options.study);
}

// Where a branch begins: the axes next to it, what --at gives and the parameter followed, by their names.
// parameters: SI.
std::string beginning_of(const Study& study, const BranchCommandOptions& options, std::size_t along,
                         std::span<const double> parameters) {
  std::vector<std::size_t> named = axis_parameters_beside(study, along);
  for (const std::string& text : options.at)
    for (const Assignment& each : parse_assignments(study, "--at", text)) named.push_back(each.parameter);
  std::map<std::string, std::string> by_name{
      {study.parameters.list[along].name, spoken_text(study, along, parameters[along])}};
  for (const std::size_t i : named)
    by_name[study.parameters.list[i].name] = spoken_text(study, i, parameters[i]);
  std::vector<std::string> values;
  for (const auto& [name, value] : by_name) values.push_back(fmt::format("{} = {}", name, value));
  return fmt::format("begun at {}", fmt::join(values, ", "));
}

// A line for each choice of a branch, for who reads them.  parameters: SI, where it begins.
std::string course_of(const Study& study, const BranchCommandOptions& options, std::size_t along,
                      std::span<const double> parameters, const periodic::BranchWanted& wanted) {
  const std::string period = wanted.multiple == 0
                                 ? "that of the response found first"
                                 : fmt::format("{} times that of the excitation", wanted.multiple);
  return fmt::format("along {} from {} to {}\n{}\nat most {} points each way\nperiod: {}",
                     study.parameters.list[along].name, spoken_text(study, along, wanted.low),
                     spoken_text(study, along, wanted.high), beginning_of(study, options, along, parameters),
                     wanted.most_points, period);
}

// All of a branch's course that its points depend on, exactly.  parameters: SI, where it begins.
std::string exact_course(const Study& study, std::size_t along, std::span<const double> parameters,
                         const periodic::BranchWanted& wanted) {
  std::map<std::string, double> by_name;
  for (std::size_t i = 0; i < parameters.size(); ++i) by_name[study.parameters.list[i].name] = parameters[i];
  std::string begin;
  for (const auto& [name, value] : by_name) begin += fmt::format(" {} {}", name, value);
  return fmt::format("along {} from {} to {}, {} points each way of {} periods, begun at{}",
                     study.parameters.list[along].name, wanted.low, wanted.high, wanted.most_points,
                     wanted.multiple, begin);
}

// For the same physics as the map of its study, for other points.  parameters: SI, of the branch.
StudyPlan plan_of_branch(const Study& study, const BranchCommandOptions& options, std::size_t along,
                         std::vector<double> parameters, const periodic::BranchWanted& wanted) {
  const std::vector<periodic::Quantity> recorded = output_quantities(study);
  const auto variables = output_variables(study, recorded);  // of a comparison too, after these
  std::vector<std::string> names;
  for (std::size_t q = 0; q < recorded.size(); ++q) names.push_back(variables[q].name);
  parameters[along] = wanted.start;
  const std::string exact = exact_course(study, along, parameters, wanted);
  return {.study = study,
          .set = options.set,
          .fingerprint = branch_fingerprint(fingerprint(study, {}, names), exact),
          .course = course_of(study, options, along, parameters, wanted)};
}

// A result that has this branch alone.  parameters: SI, of the branch.
void write_result(const BranchCommandOptions& options, const StudyPlan& plan, std::size_t along,
                  std::span<const double> parameters, const std::vector<periodic::Quantity>& quantities,
                  const periodic::Branch& branch, const std::string& started) {
  const Study& study = plan.study;
  const RunFacts run{.command = options.command, .threads = 1, .started = started};
  const results::MapLayout layout = file_layout(plan, run);
  results::MapWriter writer(*options.output, layout);
  BranchGroup(study, along, axis_parameters_beside(study, along), quantities, writer)
      .append(parameters, branch);
  finish_result(writer, plan, layout, run);
}

}  // namespace

int branch_command(const BranchCommandOptions& options, std::ostream& out) {
  Study study = read_study_with(options.study, options.set);
  check_options(study, options);
  check_place(options);
  const std::string started = utc_now();
  const std::size_t along = parameter_along(study, options.along);
  const periodic::BranchWanted wanted = wanted_branch(study, along, options);
  std::vector<double> parameters = parameters_at(study, options.at);
  for (const double place : {wanted.low, wanted.high, wanted.start}) {
    parameters[along] = place;
    check_point(study, parameters);
    set_crank_orders_at(study, parameters);
  }
  const StudyPlan plan = plan_of_branch(study, options, along, parameters, wanted);
  std::optional<engine::OutputLock> lock;
  if (options.output && is_result(*options.output)) {
    lock.emplace(*options.output);
    if (!options.fresh) refuse_another_result(*options.output, plan);
    make_room_beside(*options.output, plan, options.fresh);
  }
  const std::vector<periodic::Quantity> quantities = branch_quantities(study);
  periodic::Branch branch;
  try {
    Counter counter(study, along, options.progress);
    branch = periodic::follow_branch(study.network, quantities, values_along(study, parameters, along),
                                     wanted, std::ref(counter));
  } catch (const mechanics::MechanicsError& error) {
    throw StudyError(rules::not_computed, "{}: {}", study.source.name, error.what());
  }
  const BranchTable table(study, along, quantities);
  if (!branch.reason.empty()) {
    table.print_failure(wanted.start, branch.reason, out);
    return exit_code::some_failed;
  }
  if (options.output && is_result(*options.output))
    write_result(options, plan, along, parameters, quantities, branch, started);
  else if (options.output)
    write_whole_file(*options.output, table.csv(branch), Replaces::own_table);
  table.print(branch, out);
  return exit_code::done;
}

}  // namespace frahm::studies
