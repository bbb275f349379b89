#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "solvers/tuning/optimum.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// One start and the optima found from it: one, or one for each limit of the trade-off.
struct StartResult {
  std::uint64_t number = 0;
  std::vector<tuning::Optimum> optima;
};

// The result of a tuning.
struct TuningResult {
  std::vector<StartResult> starts;   // ascending in number, at least one
  std::vector<std::size_t> best;     // the start chosen for each limit of the trade-off: index in `starts`
  tuning::Assessment assessment;     // of optimum(); none over records
  std::vector<tuning::Peak> before;  // over records: the peaks of the study as it is stated

  std::size_t limits() const { return best.size(); }
  const tuning::Optimum& optimum(std::size_t limit) const { return starts[best[limit]].optima[limit]; }
  // The last one of the trade-off, which the record has in full.
  const tuning::Optimum& optimum() const { return optimum(limits() - 1); }
};

// Which of several optima is best: a converged one first, then the least objective, then the first. Of
// designs that break their limits the least violation counts. At least one.
std::size_t best_of(const std::vector<const tuning::Optimum*>& optima);

// Chooses among the starts and assesses the optimum. Once stop_asked is true it ends early and its
// assessment is not whole. Throws StudyError for an invalid task.
TuningResult tuning_result(const Study& study, std::vector<StartResult> starts,
                           const std::function<bool()>& stop_asked);

// For a trade-off: whether another point of the front has an objective no higher under a lower limit, so that
// this one's limit gains nothing.
bool is_dominated(const TuningResult& result, std::size_t limit);

// Whether an optimum has a design, and so a response.
bool has_design(const Study& study, const tuning::Optimum& optimum);

}  // namespace frahm::studies
