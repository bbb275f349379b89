#include "studies/tuning/tuning_sample.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include "studies/tuning/tuning_plan.hpp"
#include "studies/tuning/tuning_result.hpp"
#include "studies/tuning/tuning_task.hpp"

namespace frahm::studies {
namespace {

using Clock = std::chrono::steady_clock;

// Responses that the tuning of one curve takes, counted on the studies of this folder: 1800 to 2900 for
// constants, 18,000 to 96,000 for a schedule; the upper ends leave room for rounds that do not converge.
constexpr double kLeastOfConstants = 1500.0, kMostOfConstants = 8000.0;
constexpr double kLeastOfSchedule = 12'000.0, kMostOfSchedule = 100'000.0;
// A global search before looks at so many designs for each parameter and one more, about 100 responses each.
constexpr double kOfGlobalSearch = 400.0 * 100.0;
// A map before takes about this for each curve, and then tunes constants from up to four of its places.
constexpr double kOfMap = 6000.0, kMostPlaces = 4.0;
// The ends of a trade-off's front are problems too: without the limit, of the least value, under it.
constexpr double kEndsOfFront = 3.0;
// The further problems of a trade-off, each from the optimum before, over the mean of the first ones.
constexpr double kLessOfOthers = 0.6, kMoreOfOthers = 1.6;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// The curves over the band that each problem looks at: the objective, each side of each limit and the
// response that a schedule has to stay below, in each scenario.
double curves_of(const TuneChoice& tune) {
  double sides = 1.0 + (tune.trade_off ? 1.0 : 0.0) + (tune.dominate_constant ? 1.0 : 0.0);
  for (const LimitChoice& limit : tune.limits)
    sides += (std::isfinite(limit.lower) ? 1.0 : 0.0) + (std::isfinite(limit.upper) ? 1.0 : 0.0);
  return sides * std::max(1.0, static_cast<double>(tune.scenarios.size()));
}

// For each record and scenario: one for each round, most of which few starts need; more where the samples
// above a quantile are chosen again.
void expect_motions(const TuneChoice& tune, TuningSample& sample) {
  const double motions = static_cast<double>(tune.peaks->records.size()) * curves_of(tune);
  sample.least_responses = 4.0 * motions;
  sample.most_responses = (tune.peaks->goal.share < 1.0 ? 60.0 : 20.0) * motions;
}

// The range of responses that a start takes, from those of its problems that the sample ended.
void expect_responses(const TuneChoice& tune, tuning::Start start, const std::vector<tuning::Optimum>& optima,
                      TuningSample& sample) {
  const double problems =
      tune.trade_off ? static_cast<double>(tune.trade_off->limits.size()) + kEndsOfFront : 1.0;
  const auto ended = static_cast<double>(optima.size()) - 1.0;  // the last one was stopped
  if (ended > 0.0) {
    double responses = 0.0;
    for (std::size_t i = 0; i + 1 < optima.size(); ++i) responses += static_cast<double>(optima[i].orbits);
    sample.least_responses = kLessOfOthers * problems * responses / ended;
    sample.most_responses = kMoreOfOthers * problems * responses / ended;
    return;
  }
  const bool is_global = start == tuning::Start::global;
  const double search = is_global ? kOfGlobalSearch * static_cast<double>(tune.designs.size() + 1) : 0.0;
  if (tune.peaks) return expect_motions(tune, sample);
  const double curves = problems * curves_of(tune);
  sample.least_responses = curves * (tune.has_schedule() ? kLeastOfSchedule : kLeastOfConstants);
  sample.most_responses = curves * (tune.has_schedule() ? kMostOfSchedule : kMostOfConstants) + search;
  if (start != tuning::Start::map) return;
  sample.least_responses += curves * kOfMap;
  sample.most_responses += curves * (kOfMap + kMostPlaces * kMostOfConstants);
}

void predict(TuningSample& sample) {
  const double each = sample.seconds / static_cast<double>(std::max<std::uint64_t>(1, sample.responses));
  sample.least_seconds = std::max(sample.seconds, sample.least_responses * each);
  sample.most_seconds = std::max(sample.least_seconds, sample.most_responses * each);
}

}  // namespace

TuningSample sample_tuning(const StudyPlan& plan, double seconds) {
  const auto start = Clock::now();
  bool was_stopped = false;
  const engine::StopAsked stop = [&] {
    was_stopped = was_stopped || seconds_since(start) > seconds;
    return was_stopped;
  };
  const tuning::Task task = tuning_task(plan.study);
  StartResult first{.number = 0, .optima = tune_start(plan.study, task, 0, stop)};
  TuningSample sample{.seconds = seconds_since(start), .is_whole = !was_stopped, .why_no_design = {}};
  for (const tuning::Optimum& optimum : first.optima) sample.responses += optimum.orbits;
  if (was_stopped) {
    expect_responses(*plan.study.tune(), task.start, first.optima, sample);
    predict(sample);
    return sample;
  }
  if (const tuning::Optimum& optimum = first.optima.back(); std::isnan(optimum.objective))
    sample.why_no_design = optimum.reason;
  sample.least_seconds = sample.most_seconds = sample.seconds;
  const auto assessment = Clock::now();
  tuning_result(plan.study, {std::move(first)}, [] { return false; });
  sample.assessment_seconds = seconds_since(assessment);
  return sample;
}

}  // namespace frahm::studies
