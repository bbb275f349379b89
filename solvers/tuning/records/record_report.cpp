// What is reported of an exchange over records: how it ended, its design and its peaks.
#include <algorithm>
#include <cmath>

#include "solvers/algebra/no_value.hpp"
#include "solvers/tuning/problem/solver.hpp"
#include "solvers/tuning/records/record_exchange.hpp"
#include "solvers/tuning/records/record_problem.hpp"

namespace frahm::tuning {
namespace {

constexpr double kSolved = 1e-5;  // a KKT residual that is still an optimum's

}  // namespace

Optimum RecordExchange::written() {
  weigh();
  judge();
  const bool known = optimum_.outcome == Outcome::converged;
  write_parameters(known);
  if (best_.found.motions.empty() || !best_.found.failure.empty()) return optimum_;
  optimum_.objective = best_.found.objective;
  write_peaks(known);
  return optimum_;
}

// The motions of the design that is reported once more, with their energies.
void RecordExchange::weigh() {
  if (stop_asked_() || !failure_.empty() || best_.found.motions.empty()) return;
  failure_ = peaks_of(task_, best_.design, stop_asked_, Weighed::yes).failure;
}

void RecordExchange::judge() {
  optimum_.objective = optimum_.certificate_gap = optimum_.kkt_residual = kNone;
  optimum_.constant_objective = optimum_.trade_off = kNone;
  if (stop_asked_()) {
    end(Outcome::stopped, "stopped before the end");
  } else if (!failure_.empty()) {
    end(Outcome::failed, "a motion could not be computed: " + failure_);
  } else if (best_.found.objective == 0.0) {
    optimum_.certificate_gap = optimum_.kkt_residual = 0.0;
    end(Outcome::converged, "nothing moves, so nothing can be reduced");
  } else if (best_.solved.empty()) {
    end(Outcome::not_converged, "no round found a better design than the start");
  } else {
    optimum_.certificate_gap = (best_.found.objective - best_.solution.objective) / best_.found.objective;
    optimum_.kkt_residual = best_.solution.kkt_residual;
    const bool solved = best_.solution.ending == Ending::converged || best_.solution.kkt_residual <= kSolved;
    if (std::abs(optimum_.certificate_gap) <= task_.tolerance && solved)
      end(Outcome::converged, "the certificate gap and the KKT residual are below their tolerances");
    else if (std::abs(optimum_.certificate_gap) <= task_.tolerance)
      end(Outcome::not_converged,
          "the certificate gap is closed, but the conditions of an optimum do not hold: where a contact "
          "just begins to slip a peak has a kink, which may hold the design");
    else
      end(Outcome::not_converged, "the rounds of exchange no longer close the gap: " + best_.solution.reason);
  }
}

void RecordExchange::end(Outcome outcome, std::string reason) {
  optimum_.outcome = outcome;
  optimum_.reason = std::move(reason);
  if (outcome == Outcome::not_converged && !why_none_.empty())
    optimum_.reason += "; a motion has no derivative where the last round ended: " + why_none_;
}

// Multipliers belong to bounds that are met.
void RecordExchange::write_parameters(bool known) {
  constexpr double kMet = 1e-5;  // of the range
  for (std::size_t p = 0; p < task_.parameters.size(); ++p) {
    const DesignParameter& parameter = task_.parameters[p];
    const double near = kMet * (parameter.upper - parameter.lower), x = best_.design[p];
    const AtBound at = x - parameter.lower <= near   ? AtBound::lower
                       : parameter.upper - x <= near ? AtBound::upper
                                                     : AtBound::no;
    const auto multiplier = [&](AtBound bound, const std::vector<double>& all) {
      return !known ? kNone : at == bound && p < all.size() ? all[p] : 0.0;
    };
    optimum_.parameters.push_back(
        {.value = {x},
         .at_bound = {at},
         .lower_multiplier = {multiplier(AtBound::lower, best_.solution.lower_multipliers)},
         .upper_multiplier = {multiplier(AtBound::upper, best_.solution.upper_multipliers)}});
  }
}

// The largest of each motion, with the multipliers of all its times.
void RecordExchange::write_peaks(bool known) {
  std::vector<PeakPlace> places;
  std::vector<double> largest;
  for (const auto& motion : best_.found.motions) {
    places.push_back(motion.front().place);
    largest.push_back(motion.front().value);
  }
  RecordProblem there(task_, places, stop_asked_, best_.design, largest);
  std::vector<double> x = best_.design, values(places.size()), entries(there.jacobian.size());
  for (const Variable& each : std::span(there.variables).subspan(best_.design.size()))
    x.push_back(each.start);
  there.constrain(x, values, entries);
  optimum_.gradients += there.gradients();
  for (std::size_t m = 0; m < places.size(); ++m) {
    const auto first = entries.begin() + static_cast<std::ptrdiff_t>(m * (best_.design.size() + 1));
    Peak peak{.scenario = places[m].scenario,
              .record = places[m].record,
              .at = places[m].time,
              .value = best_.found.motions[m].front().value,
              .multiplier = known ? 0.0 : kNone,
              .sensitivity = {first, first + static_cast<std::ptrdiff_t>(best_.design.size())}};
    for (std::size_t i = 0; known && i < best_.solved.size(); ++i) {
      const bool own = best_.solved[i].scenario == peak.scenario && best_.solved[i].record == peak.record;
      if (own) peak.multiplier += std::max(0.0, best_.solution.constraint_multipliers[i]);
    }
    optimum_.peaks.push_back(std::move(peak));
  }
}

}  // namespace frahm::tuning
