#include "studies/tuning/tuning_plan.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>

#include "solvers/mechanics/linear_system.hpp"
#include "studies/tuning/optimum_check.hpp"
#include "studies/tuning/optimum_record.hpp"
#include "studies/tuning/tuning_record.hpp"
#include "studies/tuning/tuning_task.hpp"

namespace frahm::studies {
namespace {

void compute_start(const Study& study, const tuning::Task& task, std::uint64_t start,
                   const engine::StopAsked& stop_asked, engine::Bytes& out) {
  const std::vector<tuning::Optimum> optima = tune_start(study, task, start, stop_asked);
  const bool stopped = std::any_of(optima.begin(), optima.end(), [](const tuning::Optimum& optimum) {
    return optimum.outcome == tuning::Outcome::stopped;
  });
  // A stop during the work may have cut a step short without the outcome `stopped`.
  if (stopped || stop_asked()) throw engine::GivenUp{};
  if (optima.empty()) throw std::logic_error("a start of a tuning has no optimum");
  encode(optima, out);
}

}  // namespace

StudyPlan plan_tuning(Study study, std::vector<std::string> set) {
  check_record_names(study);
  StudyPlan plan = plan_without_map(std::move(study), std::move(set));
  plan.tiles = plan.study.tune()->starts;
  return plan;
}

std::vector<tuning::Optimum> tune_start(const Study& study, const tuning::Task& task, std::size_t start,
                                        const engine::StopAsked& stop_asked) {
  try {
    if (study.tune()->peaks) return {tuning::tune_over_records(record_task(study), start, stop_asked)};
    return tuning::tune(task, start, stop_asked);
  } catch (const mechanics::MechanicsError& error) {
    throw StudyError(rules::not_computed, "{}", study.source.name + ": " + error.what());
  }
}

engine::Job job_of_tuning(const StudyPlan& plan) {
  const auto make_kernel = [&plan](const engine::StopAsked& stop_asked) -> engine::Kernel {
    // Shared, as an engine::Kernel has to be copyable.
    auto task = std::make_shared<const tuning::Task>(tuning_task(plan.study));
    return [&plan, task, stop_asked](std::uint64_t tile, engine::Bytes& out) {
      compute_start(plan.study, *task, tile, stop_asked, out);
    };
  };
  return {.tiles = plan.tiles,
          .fingerprint = plan.fingerprint,
          .make_kernel = make_kernel,
          .points = [](std::uint64_t) { return std::uint64_t{1}; },
          .failed = {},
          .check = [&plan](std::uint64_t,
                           std::span<const std::byte> record) { check_start(plan.study, record); }};
}

}  // namespace frahm::studies
