#include "studies/tuning/tuning_plan.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <stdexcept>
#include <utility>

#include "solvers/mechanics/linear_system.hpp"
#include "studies/tuning/optimum_check.hpp"
#include "studies/tuning/optimum_columns.hpp"
#include "studies/tuning/optimum_entry.hpp"
#include "studies/tuning/tuning_task.hpp"

namespace frahm::studies {
namespace {

using Count = std::atomic<std::uint64_t>;

// The same, counted.
tuning::NetworkAt counted(tuning::NetworkAt network_at, Count& count) {
  return [network_at = std::move(network_at), &count](auto&&... arguments) {
    count.fetch_add(1, std::memory_order_relaxed);
    network_at(std::forward<decltype(arguments)>(arguments)...);
  };
}

std::vector<tuning::Optimum> tune_counted(const Study& study, const tuning::Task& task, std::uint64_t start,
                                          const engine::StopAsked& stop_asked, Count& count) {
  try {
    if (!study.tune()->peaks) return tuning::tune(task, start, stop_asked);
    tuning::RecordTask over_records = record_task(study);
    over_records.network_at = counted(std::move(over_records.network_at), count);
    return {tuning::tune_over_records(over_records, start, stop_asked)};
  } catch (const mechanics::MechanicsError& error) {
    throw StudyError(rules::not_computed, "{}", study.source.name + ": " + error.what());
  }
}

void compute_start(const Study& study, const tuning::Task& task, std::uint64_t start,
                   const engine::StopAsked& stop_asked, Count& count, engine::Bytes& out) {
  const std::vector<tuning::Optimum> optima = tune_counted(study, task, start, stop_asked, count);
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
  check_names_in_file(study);
  StudyPlan plan = plan_without_map(std::move(study), std::move(set));
  plan.tiles = plan.study.tune()->starts;
  return plan;
}

std::vector<tuning::Optimum> tune_start(const Study& study, const tuning::Task& task, std::size_t start,
                                        const engine::StopAsked& stop_asked) {
  Count count = 0;
  return tune_counted(study, task, start, stop_asked, count);
}

engine::Job job_of_tuning(const StudyPlan& plan) {
  const auto count = std::make_shared<Count>(0);  // by all kernels
  const auto make_kernel = [&plan, count](const engine::StopAsked& stop_asked) -> engine::Kernel {
    tuning::Task made = tuning_task(plan.study);
    made.network_at = counted(std::move(made.network_at), *count);
    // Shared, as an engine::Kernel has to be copyable.
    auto task = std::make_shared<const tuning::Task>(std::move(made));
    return [&plan, task, count, stop_asked](std::uint64_t tile, engine::Bytes& out) {
      compute_start(plan.study, *task, tile, stop_asked, *count, out);
    };
  };
  return {
      .tiles = plan.tiles,
      .fingerprint = plan.fingerprint,
      .make_kernel = make_kernel,
      .points = [](std::uint64_t) { return std::uint64_t{1}; },
      .failed = {},
      .check = [&plan](std::uint64_t, std::span<const std::byte> entry) { check_start(plan.study, entry); },
      .evaluations = [count] { return count->load(); },
      .counted = "starts"};
}

}  // namespace frahm::studies
