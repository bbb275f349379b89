#include "studies/provenance/result_variables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <utility>

namespace frahm::studies {
namespace {

constexpr const char* of_map = "map";
constexpr const char* of_motion = "motion";
constexpr const char* of_crank = "study with a crank";
constexpr const char* of_tuning = "tuning";
constexpr const char* of_front = "trade-off's front";
constexpr const char* of_fit = "identification";
constexpr const char* of_branch = "branch";

constexpr ResultVariable all_variables[] = {
    // /modes, /resonance, /orbits, /histories, /borders
    {"mode", of_map, "number of a mode at the first point of the grid"},
    {"mode_mass", of_map, "number of a mass in the shapes of modes"},
    {"mode_frequency", of_map, "undamped natural frequency of a mode with all friction sliding"},
    {"mode_damping", of_map, "damping ratio of a mode"},
    {"mode_shape_*", of_map, "displacement of each mass in {a mode}, the largest 1"},
    {"curve", of_map, "number of a response curve whose resonance is computed"},
    {"*_resonance_frequency", of_map, "frequency at which {a mass or signal} has its largest amplitude"},
    {"*_resonance_amplitude", of_map,
     "amplitude of {a mass or signal} at its resonance, at the reference order"},
    {"*_half_power_low", of_map,
     "frequency below the resonance of {a mass or signal} at which its amplitude is 1/sqrt(2) of that there"},
    {"*_half_power_high", of_map,
     "frequency above the resonance of {a mass or signal} at which its amplitude is 1/sqrt(2) of that there"},
    {"*_half_power_damping", of_map, "(high - low) / (2 resonance frequency) of {a mass or signal}"},
    {"orbit", of_map, "number of an orbit whose history is kept"},
    {"history", of_map, "number of a motion whose history is kept"},
    {"sample", of_map, "number of a sample of a kept history or of uncertain parameters"},
    {"record", "map, identification", "number of the record"},
    {"row_start", "map, branch", "first sample of a row, whose samples end where the next row's begin"},
    {"border", of_map, "number of a border between regimes"},
    {"element", of_map, "element whose regime changes at a border"},
    {"axis", of_map, "dimension along which a border was crossed"},
    {"regime_below", of_map, "regime of the element on the side of the lower index"},
    {"regime_above", of_map, "regime of the element on the side of the higher index"},
    {"*_force", of_map, "force of {an element} in a kept history"},
    {"*_sliding_velocity", of_map, "relative velocity across {a friction element}"},
    // /statistics, /tornado, [compare]
    {"*_compared", of_map, "{a quantity}, {under the compared law or profile, or for the compared response}"},
    {"*_difference", of_map, "relative difference of {a quantity} {from the compared one}"},
    {"*_mean", of_map, "mean of {a quantity} over the samples"},
    {"*_deviation", of_map, "standard deviation of {a quantity} over the samples"},
    {"*_mean_low", of_map, "lower end of the 95 % interval of the mean of {a quantity} over the samples"},
    {"*_mean_high", of_map, "upper end of the 95 % interval of the mean of {a quantity} over the samples"},
    {"*_q*", of_map, "{q50, the 50 %} quantile of {a quantity} over the samples"},
    {"*_q*_low", of_map,
     "lower end of the 95 % interval of the {q50, the 50 %} quantile of {a quantity} over the samples"},
    {"*_q*_high", of_map,
     "upper end of the 95 % interval of the {q50, the 50 %} quantile of {a quantity} over the samples"},
    {"*_samples", of_map, "number of samples that have a value of {a quantity}"},
    {"*_at_mean", of_map, "{a quantity} at the mean of the samples"},
    {"*_by_*", of_map, "change of {a quantity} by one standard deviation of {a parameter}, to first order"},
    {"*_first_order_deviation", of_map,
     "standard deviation of {a quantity} to first order, from its derivatives at the mean of the samples"},
    {"*_share_*", of_map, "share of {a parameter} in the first-order variance of {a quantity}"},
    // /branches
    {"branch", of_branch, "number of a branch"},
    {"place", of_branch, "number of a point of the branches, which are stored end to end"},
    {"first_end", of_branch, "why the branch ends before its first point"},
    {"last_end", of_branch, "why the branch ends after its last point"},
    {"arclength", of_branch, "length of the scaled branch from its first point"},
    {"stability", of_branch, "whether the orbit is stable"},
    {"special", of_branch, "kind of a special point: fold, branching, period_doubling, ..."},
    {"special_residual", of_branch, "residual of the equation of a special point"},
    {"special_element", of_branch, "element whose event begins or ends at a special point"},
    // /decay, /transient
    {"time", "motion, kept history", "time since {the start}"},
    {"*_displacement", "motion, kept history", "displacement of {a mass or signal, or across an element}"},
    {"*_velocity", "motion, kept history", "velocity of {a mass or signal}"},
    {"*_acceleration", "motion, kept history", "acceleration of {a mass or signal}"},
    {"frequency", of_motion, "frequency of the excitation, in a run-up"},
    {"*_recorded_*", of_motion, "{motion, or force,} of {a support, or on a mass,} by {a record}"},
    {"*_recorded_*_time", of_motion, "times of the samples of {a record}"},
    {"*_dissipated", of_motion, "energy dissipated so far by {an element}"},
    {"*_touch", of_motion, "times from which {a gap} is in contact"},
    {"*_touch_end", of_motion, "times at which the contact of {a gap} ends"},
    {"touch", of_motion, "number of a contact of a gap"},
    {"*_stop_onset", of_motion, "times from which {a friction element} sticks"},
    {"*_release", of_motion, "times at which {a friction element} lets go"},
    {"stop", of_motion, "number of a stop"},
    {"extremum", "decay", "number of a turning point"},
    {"*_extremum", "decay", "displacement of {a mass} at its turning points"},
    {"*_extremum_time", "decay", "times at which the velocity of {a mass} is zero"},
    {"*_log_decrement", "decay",
     "logarithmic decrement of {a mass}: ln abs(x_i / x_(i+2)) of its extrema, a full cycle apart"},
    {"*_rest", "decay", "displacement at which {a mass} rests, or to which it tends"},
    {"*_drift", "decay", "velocity at which {a mass} that no spring holds drifts on in the end"},
    {"stop_time", "decay", "time from which nothing moves any more"},
    {"duration", "decay", "time until which the motion is recorded"},
    {"reference_frequency", "decay", "frequency of the loss factors"},
    // /page
    {"angle", of_crank, "angle of the crank"},
    {"*_motion", of_crank, "displacement of {a support} by its crank"},
    {"*_taylor_*", of_crank,
     "displacement of {a support} by the Taylor series of its crank, cut at order {2}"},
    {"*_taylor_*_error", of_crank,
     "error of the Taylor series of {a support} at order {2}, relative to l_AC"},
    {"height", of_map, "height of each mass of the profile above the base"},
    {"rubbing_elements", of_motion, "number of elements that can stop a motion by friction"},
    {"hysteretic_elements", of_motion, "number of elements whose damping depends on the frequency"},
    {"given_duration", of_motion, "1 if the study says until when the motion is followed, otherwise 0"},
    {"frequency_unit", of_motion, "unit of the excitation frequency in rad/s"},
    {"*_band_from", of_tuning,
     "lower end of the part of the band over which the limit of {a quantity} holds"},
    {"*_band_to", of_tuning, "upper end of the part of the band over which the limit of {a quantity} holds"},
    // /optimum
    {"objective", "tuning, front",
     "objective of the optimum: the worst peak over band and scenarios, mean square or variance"},
    {"constant_objective", of_tuning, "objective of the best constant design"},
    {"path_bound", of_tuning,
     "lower bound on the worst peak of every schedule with these constants, as far as a grid shows"},
    {"certificate_gap", "tuning, front",
     "(objective - bound) / objective: how much the true worst peak may exceed the bound from the active "
     "frequencies; it certifies the worst peak over the band, but the optimum is a local one"},
    {"certificate_width", of_tuning,
     "width along the band; the certificate may miss a peak that is narrower"},
    {"kkt_residual", "tuning, front",
     "residual of the conditions of a local optimum (Karush, Kuhn, Tucker), relative; 0: they are met"},
    {"violation", "tuning, front",
     "largest excess over a limit ([[constraint]]), relative to the limit; 0: all limits are met within "
     "tolerance"},
    {"tolerance", of_tuning, "tolerance of the study for gap and residual"},
    {"outcome", "tuning, front, identification", "how it ended: converged, not_converged, infeasible, ..."},
    {"trade_off", "tuning, front", "limit of {the second quantity} to which the optimum belongs"},
    {"iterations", "tuning, identification", "iterations of the optimisation"},
    {"orbits", of_tuning, "responses that were computed"},
    {"gradients", of_tuning, "derivatives of responses that were computed"},
    {"best_start", "tuning, front", "number of the start whose optimum is reported"},
    {"knots_*", of_tuning, "knots of the schedule of {a design parameter}"},
    {"*_jump_at", of_tuning, "where in the band the schedule of {a design parameter} jumps"},
    {"*_jump_from", of_tuning, "{a design parameter} below the jump of its schedule"},
    {"*_jump_to", of_tuning, "{a design parameter} above the jump of its schedule"},
    {"*_lower", of_tuning, "lower bound of {a design parameter}"},
    {"*_upper", of_tuning, "upper bound of {a design parameter}"},
    {"*_before", of_tuning, "{a design parameter} as the study states it"},
    {"*_max_slope", of_tuning,
     "largest slope, up or down, that the study allows the schedule of {a design parameter}"},
    {"*_at_bound", of_tuning, "whether {a design parameter} lies on a bound"},
    {"*_lower_multiplier", of_tuning,
     "fall of the objective per unit by which the lower bound of {a design parameter} is moved down"},
    {"*_upper_multiplier", of_tuning,
     "fall of the objective per unit by which the upper bound of {a design parameter} is moved up"},
    {"*_constant", of_tuning, "{a design parameter} in the best constant design"},
    {"peak", of_tuning, "number of a maximum of the response at the optimum"},
    {"peak_*", of_tuning, "where in the band a maximum of the response at the optimum is"},
    {"peak_value", of_tuning, "the response at a maximum, weighted"},
    {"peak_scenario", of_tuning, "scenario of a maximum, from 0"},
    {"peak_multiplier", of_tuning, "share of a maximum in determining the optimum"},
    {"peak_record", of_tuning, "record of a maximum, from 0"},
    {"peak_before", of_tuning, "the same peak for the design that the study states"},
    {"*_sensitivity", of_tuning, "derivative of a maximum with respect to {a design parameter} as a whole"},
    {"*_limited", of_tuning, "{a limited quantity} where it is nearest to its limit"},
    {"*_limited_at", of_tuning, "where in the band {a limited quantity} is nearest to its limit"},
    {"*_limited_scenario", of_tuning,
     "scenario in which {a limited quantity} is nearest to its limit, from 0"},
    {"*_lower_limit", of_tuning, "lower limit of {a quantity}"},
    {"*_upper_limit", of_tuning, "upper limit of {a quantity}"},
    {"*_limit_excess", of_tuning, "{a quantity} over its limit, relative to the limit; 0 where it is met"},
    {"*_limit_multiplier", of_tuning,
     "fall of the objective per unit by which the limit of {a quantity} is relaxed"},
    {"excitation_frequency", "tuning, motion", "angular frequency of the excitation {along the band}"},
    {"weight", of_tuning, "factor on the response along the band"},
    {"response_before*", of_tuning,
     "weighted {response} along the band for the design that the study states{}"},
    {"response_after*", of_tuning, "weighted {response} along the band at the optimum{}"},
    {"response_constant*", of_tuning, "weighted {response} along the band of the best constant design{}"},
    {"response_rule*", of_tuning, "weighted {response} along the band of the design by the rules{}"},
    {"worst_before", of_tuning, "objective of the design that the study states"},
    {"worst_after", of_tuning, "objective of the optimum"},
    {"worst_constant", of_tuning, "objective of the best constant design"},
    {"worst_rule", of_tuning, "objective of the design by the rules"},
    {"*_schedule", of_tuning, "schedule of {a design parameter} along the band"},
    {"*_rule", of_tuning, "{a design parameter} by the rule for its schedule, within the bounds"},
    {"*_range", of_tuning, "whether {a column} is within its range"},
    {"*_range_lower", of_tuning, "lower end of the range of {a column}"},
    {"*_range_upper", of_tuning, "upper end of the range of {a column}"},
    {"change", of_tuning, "relative change of one parameter"},
    {"*_detuning", of_tuning, "relative rise of the objective when {one parameter} changes by `change`"},
    {"searched_points", of_tuning,
     "points of the band at the optimum at which other responses were searched for, in all scenarios"},
    {"several_points", of_tuning, "searched points with more than one stable response found"},
    {"not_periodic_points", of_tuning, "searched points with no stable periodic response found"},
    {"round", of_tuning, "number of an exchange of active frequencies"},
    {"round_active", of_tuning, "active frequencies of an exchange"},
    {"round_iterations", of_tuning, "iterations of an exchange"},
    {"round_bound", of_tuning, "objective over the active frequencies"},
    {"round_worst", of_tuning, "true objective of that design"},
    {"round_violation", of_tuning, "violation of that design"},
    {"start", of_tuning, "number of a start, from 0"},
    {"start_*", of_tuning, "{a design parameter} that each start found"},
    {"start_objective", of_tuning, "objective of each start"},
    {"start_kkt_residual", of_tuning, "kkt_residual of each start"},
    {"start_outcome", of_tuning, "outcome of each start"},
    {"map_cells", of_tuning,
     "number of designs in the map of the box from which the search began, each for an equal share of it"},
    {"map_share", of_tuning, "share of the box whose designs have a response"},
    {"map_place", of_tuning, "number of a low place of that map"},
    {"map_objective", of_tuning,
     "objective of the best constants from each low place of that map; NaN where they break a limit"},
    {"dominated", of_front, "whether a lower limit has an objective that is not higher"},
    {"least_trade_off", of_front, "least value of {the second quantity} that was found"},
    {"objective_at_least", of_front, "objective under a limit 0.01 % above `least_trade_off`"},
    {"most_trade_off", of_front, "{the second quantity} of the optimum without a limit on it"},
    {"objective_at_most", of_front, "objective of the optimum without that limit"},
    // /identification
    {"estimate", of_fit, "number of an estimate"},
    {"*_low", of_fit, "lower end of the 95 % interval of {an estimate}"},
    {"*_high", of_fit, "upper end of the 95 % interval of {an estimate}"},
    {"*_standard_error", of_fit, "standard error of {an estimate}: one standard deviation"},
    {"*_degrees_of_freedom", of_fit, "degrees of freedom of the interval of {an estimate}"},
    {"degrees_of_freedom", of_fit, "degrees of freedom of the residuals: data minus unknowns"},
    {"*_covariance", of_fit, "covariance of {an estimate} with each estimate, in the product of their units"},
    {"*_correlation", of_fit, "correlation of {an estimate} with each estimate"},
    {"first_*", of_fit, "{an estimate} of the stage from which a grey box started"},
    {"nrmse", of_fit, "fit quality [%], 100 (1 - norm(y - yhat)/norm(y - mean y)); 100 is a perfect fit"},
    {"*_nrmse", of_fit, "nrmse of {one sensor of a record}"},
    {"*_time", of_fit, "times of the samples or turning points of {a record}"},
    {"*_frequency", of_fit, "frequencies of the rows of {a record}"},
    {"*_measured", of_fit, "{the data of a record} as measured"},
    {"*_fitted", of_fit, "{values} of the model at the data"},
    {"*_residual", of_fit, "measured minus fitted {values}"},
    {"row", of_fit, "number of a row of the method's table"},
    {"damping_ratio", of_fit, "estimate: damping ratio"},
    {"damping_ratio_first_order", of_fit, "estimate: damping ratio, to first order"},
    {"damping_ratio_line", of_fit, "estimate: damping ratio by the fitted line"},
    {"friction_displacement_line", of_fit, "estimate: friction force over stiffness by the fitted line"},
    {"damping_line", of_fit, "estimate: damping by the fitted line"},
    {"friction_force_line", of_fit, "estimate: friction force by the fitted line"},
    {"*_response", of_fit, "responses of the rows of {a record}"},
    {"*_added_mass", of_fit, "masses added in the rows of {a record}"},
    {"zeta", of_fit, "damping ratio of each row, to first order"},
    {"zeta_exact", of_fit, "damping ratio of the viscous mass with the half-power points of each row"},
    {"increase", of_fit, "zeta of each row over that of the first row, minus one"},
    {"offset", of_fit, "estimate: what the sensor shows at rest"},
    {"intercept", of_fit, "estimate: value of a fitted line at zero"},
    {"energy_loss", of_fit, "estimate: energy dissipated in a cycle"},
    {"storage_stiffness", of_fit, "estimate: stiffness in phase with the displacement"},
    {"equivalent_damping", of_fit, "estimate: viscous damping with the same loss in a cycle"},
    {"equivalent_friction", of_fit, "estimate: friction force with the same loss in a cycle"},
    {"label", "data of an identification", "text printed with a row"},
    {"doubtful", "data of an identification", "1 marks a row that is left out"},
};

bool fits(std::string_view pattern, std::string_view name) {
  const std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) return pattern == name;
  const std::string_view head = pattern.substr(0, star), tail = pattern.substr(star + 1);
  if (!name.starts_with(head)) return false;
  for (std::size_t at = head.size(); at <= name.size(); ++at) {
    if (fits(tail, name.substr(at))) return true;
  }
  return false;
}

// The part of a pattern without what any name stands for: "detuning" of "*_detuning".
std::string_view plain_end(std::string_view pattern) {
  return pattern.starts_with("*_") ? pattern.substr(2) : std::string_view();
}

bool is_called(const ResultVariable& word, std::string_view name) {
  return fits(word.name, name) || plain_end(word.name) == name;
}

// A meaning with words in place of its braces, in their order; braces beyond the words keep their own.
std::string filled(std::string_view meaning, const std::vector<std::string>& words) {
  std::string text;
  auto word = words.begin();
  while (true) {
    const std::size_t open = meaning.find('{');
    text += meaning.substr(0, open);
    if (open == std::string_view::npos) return text;
    const std::size_t close = meaning.find('}', open);
    text += word == words.end() ? meaning.substr(open + 1, close - open - 1) : std::string_view(*word++);
    meaning.remove_prefix(close + 1);
  }
}

std::string text_of(const ResultVariable& word) {
  return fmt::format("{}: in results ({}): {}", word.name, word.of, filled(word.meaning, {}));
}

const ResultVariable& row_called(std::string_view row) {
  const auto found = std::ranges::find(all_variables, row, &ResultVariable::name);
  if (found == std::end(all_variables))
    throw std::logic_error(fmt::format("the variable \"{}\" has no row in result_variables.cpp", row));
  return *found;
}

}  // namespace

Named::Named(std::string_view row, const std::vector<std::string>& stars,
             const std::vector<std::string>& words)
    : name_(row), meaning_(filled(row_called(row).meaning, words)) {
  std::size_t at = 0;
  for (const std::string& star : stars) {
    at = name_.find('*', at);
    name_.replace(at, 1, star);
    at += star.size();
  }
}

Named Named::by_study(std::string name, std::string meaning) {
  Named named;
  named.name_ = std::move(name);
  named.meaning_ = std::move(meaning);
  return named;
}

results::Variable variable(const Named& named, const std::string& unit, results::Type type) {
  return {
      .name = named.name(), .unit = unit.empty() ? "1" : unit, .long_name = named.meaning(), .type = type};
}

results::Variable flag_variable(const Named& named, const std::vector<std::string>& meanings) {
  results::Variable flag{.name = named.name(), .long_name = named.meaning(), .type = results::Type::flag};
  flag.flags.push_back({"not_computed", 0});
  for (const std::string& meaning : meanings)
    flag.flags.push_back({meaning, static_cast<int>(flag.flags.size())});
  return flag;
}

std::span<const ResultVariable> result_variables() {
  return all_variables;
}

std::vector<std::string> result_variables_named(std::string_view name) {
  std::vector<std::string> found;
  for (const ResultVariable& each : all_variables) {
    if (name == each.name) found.push_back(text_of(each));
  }
  return found;
}

std::vector<std::string> result_variables_called(std::string_view name, std::size_t shortest) {
  std::size_t longest = shortest;
  for (const ResultVariable& each : all_variables) {
    if (is_called(each, name)) longest = std::max(longest, std::string_view(each.name).size());
  }
  // The name itself too, where a longer pattern ends in it: `nrmse` next to `*_nrmse`.
  std::vector<std::string> found;
  for (const ResultVariable& each : all_variables) {
    const bool is_longest = std::string_view(each.name).size() == longest;
    if (is_called(each, name) && (is_longest || name == each.name)) found.push_back(text_of(each));
  }
  return found;
}

}  // namespace frahm::studies
