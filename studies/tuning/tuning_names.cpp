#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "solvers/algebra/no_value.hpp"
#include "solvers/transient/motion_quantity.hpp"
#include "studies/tuning/tuned_design.hpp"
#include "studies/tuning/tuning_about.hpp"

namespace frahm::studies {
namespace {

std::string squared(const std::string& unit) {
  return unit == "1" ? unit : fmt::format("({})2", unit);
}

std::string start_text(const TuneChoice& tune, const tuning::Optimum& optimum) {
  if (optimum.seen.cells > 0) return "map";
  switch (tune.start) {
    case tuning::Start::given:
      return "given";
    case tuning::Start::map:
      return "map";
    case tuning::Start::global:
      return std::string("nlopt ") + tuning::name(tune.global_solver);
    case tuning::Start::many:
      break;
  }
  return fmt::format("{}", tune.starts);
}

const char* objective_name(const TuneChoice& tune) {
  if (tune.peaks)
    return tune.peaks->goal.objective == tuning::RecordObjective::worst_peak ? "worst_peak" : "mean_peak";
  switch (tune.objective) {
    case tuning::Objective::minimax:
      return "minimax";
    case tuning::Objective::mean_square:
      return "mean_square";
    case tuning::Objective::variance:
      break;
  }
  return "variance";
}

}  // namespace

TuningAbout::TuningAbout(const Study& of_study, const TuningResult& of_result)
    : study(of_study), tune(*of_study.tune()), result(of_result), optimum(of_result.optimum()) {
  for (const DesignChoice& design : tune.designs) {
    const std::string& unit = design.unit.text;
    designs.push_back({design, study.parameters.list[design.parameter].name, unit.empty() ? "1" : unit});
  }
  if (tune.peaks) {
    band = "time";
    band_unit = study.dimensionless ? "1" : "s";
  }
  if (!tune.band) return;
  band = study.parameters.list[tune.band->parameter].name;
  if (!tune.band->unit.text.empty()) band_unit = tune.band->unit.text;
}

namespace {

tuning::Optimum example_of_optimum(const Study& study) {
  const TuneChoice& tune = *study.tune();
  const std::size_t designs = tune.designs.size();
  tuning::Optimum optimum;
  for (const DesignChoice& design : tune.designs) {
    const std::vector<double> ones(design.count(), 1.0);
    optimum.parameters.push_back(
        {.value = ones, .at_bound = {}, .lower_multiplier = ones, .upper_multiplier = ones});
  }
  if (tune.has_schedule()) optimum.constant.assign(designs, 1.0);
  optimum.trade_off = 1.0;
  optimum.ends = {.least = 1.0, .objective_at_least = 1.0, .most = 1.0, .objective_at_most = 1.0};
  optimum.limits.assign(named_limits(study, 1.0).size(), {.value = 1.0, .at = 1.0, .multiplier = 1.0});
  optimum.peaks.push_back({.at = 1.0, .value = 1.0, .sensitivity = std::vector<double>(designs, 1.0)});
  optimum.rounds.emplace_back();
  if (!tune.peaks) optimum.seen = {.cells = 1, .share = 1.0, .polished = {1.0}};
  return optimum;
}

}  // namespace

TuningResult example_of(const Study& study) {
  const TuneChoice& tune = *study.tune();
  TuningResult result{
      .starts = {{0, {example_of_optimum(study)}}}, .best = {0}, .assessment = {}, .before = {}};
  if (tune.peaks) {
    result.before.emplace_back();
    return result;
  }
  tuning::Assessment& assessment = result.assessment;
  if (tune.band) assessment.band = {tune.band->range.from};
  const std::vector<std::vector<double>> curve(scenario_names(study).size(), {1.0});
  for (const char* name : {"before", "after", "constant", "rule"})
    assessment.curves.push_back({name, curve, 1.0});
  assessment.detuning = {{1.0}, std::vector<std::vector<double>>(tune.designs.size(), {1.0})};
  return result;
}

std::vector<NamedLimit> named_limits(const Study& study, double trade_off) {
  std::map<std::string, int> seen;
  const auto named = [&](const std::string& quantity) {
    const int number = ++seen[quantity];
    return number == 1 ? quantity : fmt::format("{}_{}", quantity, number);
  };
  std::vector<NamedLimit> limits;
  for (const LimitChoice& limit : study.tune()->limits)
    limits.push_back({named(limit.name), limit.unit, limit.lower, limit.upper});
  if (const auto& choice = study.tune()->trade_off)
    limits.push_back({named(choice->name), choice->unit, -kInfinity, trade_off});
  return limits;
}

std::string quantity_unit(const Study& study) {
  if (const auto& peaks = study.tune()->peaks)
    return transient::describe(peaks->quantity, study.network, study.dimensionless).unit;
  return periodic::describe(study.tune()->quantity, study.network, study.dimensionless).unit;
}

std::string objective_unit(const Study& study) {
  const std::string unit = quantity_unit(study);
  return study.tune()->objective == tuning::Objective::minimax ? unit : squared(unit);
}

std::string noise_words(const Study& study) {
  const tuning::Noise& noise = study.tune()->noise;
  const bool force = noise.kind == tuning::NoiseKind::force_on;
  const auto& nodes = force ? study.network.masses : study.network.prescribed;
  return fmt::format("{} {}", force ? "a force on" : "the acceleration of", nodes[noise.node]);
}

namespace {

// The white noise of a variance, and the reference of the motion.
void add_noise(const Study& study, std::vector<results::Text>& texts) {
  const tuning::Noise& noise = study.tune()->noise;
  const bool force = noise.kind == tuning::NoiseKind::force_on;
  const std::string unit = study.dimensionless ? "" : force ? " N2 per rad s-1" : " (m s-2)2 per rad s-1";
  texts.emplace_back("noise", noise_words(study));
  texts.emplace_back("noise_density", fmt::format("{}{}", noise.intensity, unit));
  if (!force && study.tune()->quantity.measure != periodic::Measure::stroke)
    texts.emplace_back("relative_to", study.network.prescribed[noise.node]);
}

}  // namespace

std::string not_proved(const Study& study) {
  if (study.tune()->peaks || !tuning::may_take_several_orbits(study.network)) return "";
  return fmt::format(
      "at each frequency examined, the worst is that of the stable responses found from {} starts and from "
      "responses near it, and where none was found, that of the motions followed; it is not proved that none "
      "was missed, nor that the response does not jump between these frequencies",
      study.orbits_wanted().starts);
}

std::vector<results::Text> optimum_texts(const Study& study, const TuningResult& result) {
  const TuneChoice& tune = *study.tune();
  const TuningAbout about(study, result);
  std::vector<std::string> designs, limits;
  for (const NamedDesign& design : about.designs) designs.push_back(design.name);
  for (const NamedLimit& limit : named_limits(study, 0.0)) limits.push_back(limit.name);
  std::vector<results::Text> texts = {{"reason", about.optimum.reason},
                                      {"objective_kind", objective_name(tune)},
                                      {"quantity", tune.quantity_name},
                                      {"band_parameter", about.band},
                                      {"parameters", fmt::format("{}", fmt::join(designs, ","))},
                                      {"scenarios", fmt::format("{}", fmt::join(scenario_names(study), ","))},
                                      {"limits", fmt::format("{}", fmt::join(limits, ","))},
                                      {"solver", tuning::name(tune.solver)},
                                      {"start", start_text(tune, about.optimum)}};
  if (tune.objective == tuning::Objective::variance) add_noise(study, texts);
  if (tune.peaks) texts.emplace_back("records", fmt::format("{}", fmt::join(tune.peaks->records, ",")));
  if (!tune.drawn.empty()) texts.emplace_back("samples", tune.drawn);
  if (tune.peaks && tune.peaks->goal.share < 1.0)
    texts.emplace_back("quantile", fmt::format("{}", tune.peaks->goal.share));
  if (tune.dominate_constant) texts.emplace_back("dominate", "constant");
  if (const std::string limits_of_it = not_proved(study); !limits_of_it.empty())
    texts.emplace_back("not_proved", limits_of_it);
  return texts;
}

void check_names_in_file(const Study& study) {
  const TuningResult example = example_of(study);
  try {
    results::check(optimum_columns(study, example));
    results::check(front_columns(study, example));
  } catch (const std::invalid_argument& error) {
    throw StudyError(rules::name_taken,
                     "{}: the record of this tuning would need the same name twice; rename a parameter, a "
                     "column or a scenario: {}",
                     study.source.name, error.what());
  }
}

}  // namespace frahm::studies
