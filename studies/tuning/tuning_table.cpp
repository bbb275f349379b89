#include "studies/tuning/tuning_table.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "solvers/algebra/no_value.hpp"
#include "studies/reading/quantities/unit_words.hpp"
#include "studies/tuning/outcome_words.hpp"
#include "studies/tuning/tuned_design.hpp"
#include "studies/tuning/tuning_about.hpp"

namespace frahm::studies {
namespace {

using tuning::Optimum;

std::string eight_digits(double value, const std::string& unit) {
  return with_unit(fmt::format("{:.8g}", value), unit);
}

// The bound at which a parameter lies and, if it limits the optimum, the gain of moving it by one unit.
std::string bound_words(const tuning::TunedParameter& tuned, double factor) {
  if (tuned.at_bound[0] == tuning::AtBound::no) return "";
  const bool lower = tuned.at_bound[0] == tuning::AtBound::lower;
  const double multiplier = (lower ? tuned.lower_multiplier : tuned.upper_multiplier)[0] * factor;
  return fmt::format("  {} bound{}", lower ? "lower" : "upper",
                     multiplier > 0.0 ? fmt::format(", {:.4g} a unit", multiplier) : "");
}

std::string percent(double part, const char* form) {
  return std::isnan(part) ? "-" : fmt::format(fmt::runtime(form), 100.0 * part);
}

void print_constant(const TuningAbout& about, std::size_t i, std::ostream& out) {
  const auto& [choice, name, unit] = about.designs[i];
  const double factor = choice.unit.si_factor;
  const tuning::TunedParameter& tuned = about.optimum.parameters[i];
  const double before = about.study.parameters.nominal()[choice.parameter];
  fmt::print(out, "{:<22}{:>16.10g}{:>14.6g}{:>12.6g}{:>12.6g}", in_brackets(name, unit),
             tuned.value[0] / factor, before / factor, choice.lower / factor, choice.upper / factor);
  fmt::print(out, "{}\n", bound_words(tuned, factor));
}

void print_schedule(const TuningAbout& about, std::size_t i, std::ostream& out) {
  const auto& [choice, name, unit] = about.designs[i];
  const double factor = choice.unit.si_factor;
  const tuning::TunedParameter& tuned = about.optimum.parameters[i];
  const auto [least, most] = std::minmax_element(tuned.value.begin(), tuned.value.end());
  const double before = about.study.parameters.nominal()[choice.parameter];
  fmt::print(out, "{:<22}{:>16}{:>14.6g}{:>12.6g}{:>12.6g}", in_brackets(name, unit),
             fmt::format("{:.5g} .. {:.5g}", *least / factor, *most / factor), before / factor,
             choice.lower / factor, choice.upper / factor);
  const auto between = std::ranges::count(tuned.at_bound, tuning::AtBound::no);
  fmt::print(out, "  {} knots over {}, {} on bounds\n", choice.knots.size(), about.band,
             std::ssize(tuned.at_bound) - between);
  if (const auto jump = jump_of(choice, {tuned.value, tuned.knots})) {
    const double at = about.spoken_band(jump->at);
    fmt::print(out, "  {:<20}{:>16}  from {:.5g} to {:.5g}\n", "  jumps at " + about.band,
               eight_digits(at, about.band_unit), jump->from / factor, jump->to / factor);
  }
}

void print_design(const TuningAbout& about, std::ostream& out) {
  fmt::print(out, "\n{:<22}{:>16}{:>14}{:>12}{:>12}  lies on\n", "parameter", "optimum", "before", "lower",
             "upper");
  for (std::size_t i = 0; i < about.designs.size(); ++i) {
    about.designs[i].choice.is_scheduled() ? print_schedule(about, i, out) : print_constant(about, i, out);
  }
}

// "; peaks narrower than 3e-08 rad/s may be missed"
std::string unseen_words(const TuningAbout& about) {
  const auto width = about.least_width_seen();
  if (!width) return "";
  return fmt::format("; peaks narrower than {} may be missed",
                     with_unit(fmt::format("{:.1g}", *width), about.band_unit));
}

void print_objective(const TuningAbout& about, std::ostream& out) {
  const Optimum& optimum = about.optimum;
  const std::string unit = objective_unit(about.study);
  fmt::print(out, "\n{:<24}{}\n", "objective", eight_digits(optimum.objective, unit));
  for (const tuning::Curve& curve : about.result.assessment.curves) {
    if (curve.name == "after" || !about.tune.band) continue;
    const bool minimax = about.tune.objective == tuning::Objective::minimax;
    fmt::print(out, "  {}, {:<8}  {}\n", minimax ? "worst peak" : "objective ", curve.name,
               eight_digits(curve.worst, unit));
  }
  if (about.tune.has_schedule())
    fmt::print(out, "  the best constant     {}\n", eight_digits(optimum.constant_objective, unit));
  if (!std::isnan(optimum.path_bound))
    fmt::print(out,
               "  lower bound           {} for every schedule with these constants, as far as a grid shows\n",
               eight_digits(optimum.path_bound, unit));
  if (!std::isnan(optimum.certificate_gap))
    fmt::print(out, "{:<24}{:.3g} (relative){}\n", "certificate gap", optimum.certificate_gap,
               unseen_words(about));
  if (!std::isnan(optimum.kkt_residual))
    fmt::print(out, "{:<24}{:.3g}\n", "KKT residual", optimum.kkt_residual);
  if (optimum.violation > 0.0) fmt::print(out, "{:<24}{:.3g}\n", "violation", optimum.violation);
}

void print_search(const TuningAbout& about, std::ostream& out) {
  const std::string limits_of_it = not_proved(about.study);
  if (limits_of_it.empty()) return;
  const tuning::SearchedPoints& searched = about.result.assessment.searched;
  fmt::print(
      out,
      "\n{:<24}of {} points of the band at the optimum, {} have several stable responses, {} have none\n",
      "responses", searched.points, searched.several, searched.not_periodic);
  fmt::print(out, "{:<24}{}\n", "not proved", limits_of_it);
}

// For a tuning over records: every motion's peak, before and after.
void print_motions(const TuningAbout& about, std::ostream& out) {
  const auto names = scenario_names(about.study);
  const bool sampled = !about.tune.drawn.empty();  // of samples those that hold the design are enough
  fmt::print(out, "\n{:<28}{:>18}{:>14}{:>12}{:>10}\n", "record",
             in_brackets(about.tune.quantity_name, quantity_unit(about.study)), "before",
             in_brackets("at", about.band_unit), "share");
  for (std::size_t i = 0; i < about.optimum.peaks.size(); ++i) {
    const tuning::Peak& peak = about.optimum.peaks[i];
    if (sampled && !(peak.multiplier > 0.0)) continue;
    fmt::print(out, "{:<28}{:>18.8g}{:>14.6g}{:>12.6g}{:>10.4f}{}\n",
               about.tune.peaks->records.at(peak.record), peak.value,
               i < about.result.before.size() ? about.result.before[i].value : kNone, peak.at,
               peak.multiplier, about.tune.scenarios.empty() ? "" : "  " + names.at(peak.scenario));
  }
}

void print_peaks(const TuningAbout& about, std::ostream& out) {
  if (about.tune.peaks) return print_motions(about, out);
  const auto is_active = [](const tuning::Peak& peak) { return peak.multiplier > 0.0; };
  if (std::none_of(about.optimum.peaks.begin(), about.optimum.peaks.end(), is_active)) return;
  const auto names = scenario_names(about.study);
  const std::string quantity = in_brackets(about.tune.quantity_name, quantity_unit(about.study));
  const std::size_t width = std::max<std::size_t>(18, quantity.size() + 2);
  fmt::print(out, "\nactive peaks\n{:>18}{:>{}}{:>10}\n", in_brackets(about.band, about.band_unit), quantity,
             width, "share");
  for (const tuning::Peak& peak : about.optimum.peaks) {
    if (!is_active(peak)) continue;
    fmt::print(out, "{:>18.8g}{:>{}.8g}{:>10.4f}{}\n", about.spoken_band(peak.at), peak.value, width,
               peak.multiplier, about.tune.scenarios.empty() ? "" : "  " + names.at(peak.scenario));
  }
}

void print_limits(const TuningAbout& about, std::ostream& out) {
  const std::vector<NamedLimit> limits = named_limits(about.study, about.optimum.trade_off);
  if (limits.empty() || about.optimum.limits.size() != limits.size()) return;
  fmt::print(out, "\n{:<34}{:>14}{:>12}{:>12}{:>14}\n", "limit", "value", "lower", "upper", "multiplier");
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const auto& [name, unit, lower, upper] = limits[i];
    const double factor = unit.si_factor;
    const auto bound = [&](double value) {
      return std::isfinite(value) ? fmt::format("{:.6g}", value / factor) : std::string("-");
    };
    const tuning::LimitState& state = about.optimum.limits[i];
    fmt::print(out, "{:<34}{:>14.6g}{:>12}{:>12}{:>14.4g}{}\n", in_brackets(name, unit.text),
               state.value / factor, bound(lower), bound(upper), state.multiplier * factor,
               state.excess > 0.0 ? fmt::format("  broken by {:.4g} %", 100.0 * state.excess) : "");
  }
}

void print_detuning(const TuningAbout& about, std::ostream& out) {
  const tuning::Detuning& detuning = about.result.assessment.detuning;
  if (detuning.change.empty() || detuning.growth.size() != about.designs.size()) return;
  fmt::print(out, "\n{:<22}", "objective grows at");
  for (const double change : detuning.change) fmt::print(out, "{:>10}", percent(change, "{:+.0f} %"));
  fmt::print(out, "\n");
  for (std::size_t i = 0; i < about.designs.size(); ++i) {
    fmt::print(out, "{:<22}", about.designs[i].name);
    for (const double growth : detuning.growth[i]) fmt::print(out, "{:>10}", percent(growth, "{:+.2f} %"));
    fmt::print(out, "\n");
  }
}

void print_front(const TuningAbout& about, std::ostream& out) {
  if (!about.tune.trade_off) return;
  const TradeOffChoice& trade_off = *about.tune.trade_off;
  fmt::print(out, "\ntrade-off\n{:>34}{:>18}{:>16}\n",
             in_brackets(trade_off.name + " at most", trade_off.unit.text),
             in_brackets("objective", objective_unit(about.study)), "outcome");
  const auto print_point = [&](double limit, double objective, const std::string& outcome) {
    fmt::print(out, "{:>34.6g}{:>18.8g}{:>16}\n", limit / trade_off.unit.si_factor, objective, outcome);
  };
  std::vector<std::string> dominated;
  for (std::size_t i = 0; i < about.result.limits(); ++i) {
    const Optimum& optimum = about.result.optimum(i);
    if (is_dominated(about.result, i))
      dominated.push_back(fmt::format("{:.6g}", optimum.trade_off / trade_off.unit.si_factor));
    else
      print_point(optimum.trade_off, optimum.objective,
                  outcome_words().at(static_cast<std::size_t>(optimum.outcome)));
  }
  if (!dominated.empty())
    fmt::print(out, "{:>34}  a lower limit is as good\n", fmt::format("{}", fmt::join(dominated, ", ")));
  const tuning::FrontEnds& ends = about.optimum.ends;
  if (!std::isnan(ends.most)) print_point(ends.most, ends.objective_at_most, "without limit");
  if (!std::isnan(ends.least)) print_point(ends.least, ends.objective_at_least, "least");
}

// "121 designs, 100 % of the box: 2 low places, objectives 3.1 .. 4.2"
void print_map(const TuningAbout& about, std::ostream& out) {
  const tuning::DesignsSeen& seen = about.optimum.seen;
  if (seen.cells == 0) return;
  fmt::print(out, "{:<22}{} designs, {:.4g} % of the box: {} place{} polished", "map", seen.cells,
             100.0 * seen.share, seen.polished.size(), seen.polished.size() == 1 ? "" : "s");
  std::vector<double> known = seen.polished;
  std::erase_if(known, [](double objective) { return std::isnan(objective); });
  if (known.size() > 1) {
    const auto [least, most] = std::ranges::minmax(known);
    fmt::print(out, ", objectives {:.8g} .. {:.8g}", least, most);
  }
  fmt::print(out, "\n");
}

void print_effort(const TuningAbout& about, std::ostream& out) {
  std::size_t converged = 0;
  std::vector<double> objectives;
  std::uint64_t orbits = 0, gradients = 0;
  for (const StartResult& start : about.result.starts) {
    const Optimum& last = start.optima[about.result.limits() - 1];
    converged += last.outcome == tuning::Outcome::converged;
    if (!std::isnan(last.objective)) objectives.push_back(last.objective);
    for (const Optimum& optimum : start.optima) {
      orbits += optimum.orbits;
      gradients += optimum.gradients;
    }
  }
  fmt::print(out, "\n");
  if (about.result.starts.size() > 1 && !objectives.empty()) {
    const auto [least, most] = std::minmax_element(objectives.begin(), objectives.end());
    fmt::print(out, "{:<22}{}: {} converged, objectives {:.8g} .. {:.8g}; the best is start {}\n", "starts",
               about.result.starts.size(), converged, *least, *most,
               about.result.starts[about.result.best.back()].number);
  }
  print_map(about, out);
  fmt::print(out, "{:<22}{} responses, {} gradients, {} iterations, {} rounds of exchange\n", "effort",
             orbits, gradients, about.optimum.iterations, about.optimum.rounds.size());
  fmt::print(out, "{:<22}{}: {}\n", "outcome",
             outcome_words().at(static_cast<std::size_t>(about.optimum.outcome)), about.optimum.reason);
}

// "omega = 15 .. 35 rad/s"
std::string band_words(const Study& study) {
  const BandChoice& band = *study.tune()->band;
  const double factor = band.unit.si_factor;
  return fmt::format("{} = {:.6g} .. {}", study.parameters.list[band.parameter].name,
                     band.range.from / factor, eight_digits(band.range.to / factor, band.unit.text));
}

}  // namespace

void print_task(const Study& study, std::ostream& out) {
  const TuneChoice& tune = *study.tune();
  const bool is_mean = tune.peaks && tune.peaks->goal.objective == tuning::RecordObjective::mean_peak;
  const char* how = is_mean                                            ? "least mean"
                    : tune.objective == tuning::Objective::minimax     ? "least worst"
                    : tune.objective == tuning::Objective::mean_square ? "least mean square of"
                                                                       : "least variance of";
  fmt::print(out, "{:<22}{} {}", "tuned for", how, tune.quantity_name);
  const bool is_of_noise = tune.objective == tuning::Objective::variance;
  if (tune.band && !is_of_noise) fmt::print(out, " over {}", band_words(study));
  if (tune.peaks)
    fmt::print(out, " over {} record{} of {:.6g} s", tune.peaks->records.size(),
               tune.peaks->records.size() == 1 ? "" : "s", tune.peaks->duration);
  if (is_of_noise) fmt::print(out, " under white noise, {}", noise_words(study));
  fmt::print(out, "\n");
  if (tune.band && is_of_noise) fmt::print(out, "{:<22}{}\n", "limits hold over", band_words(study));
  if (!tune.drawn.empty())
    fmt::print(out, "{:<22}{}{}\n", "samples", tune.drawn,
               tune.peaks && tune.peaks->goal.share < 1.0
                   ? fmt::format(", of which the share {} counts", tune.peaks->goal.share)
                   : "");
  else if (!tune.scenarios.empty())
    fmt::print(out, "{:<22}{}\n", "scenarios", fmt::join(scenario_names(study), ", "));
}

void print_tuning(const Study& study, const TuningResult& result, std::ostream& out) {
  const TuningAbout about(study, result);
  if (!study.title.empty()) fmt::print(out, "{}\n", study.title);
  print_task(study, out);
  if (has_design(study, about.optimum)) print_design(about, out);
  print_objective(about, out);
  print_front(about, out);
  print_peaks(about, out);
  print_limits(about, out);
  print_detuning(about, out);
  print_search(about, out);
  print_effort(about, out);
}

}  // namespace frahm::studies
