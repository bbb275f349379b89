#include "studies/tuning/outcome_words.hpp"
#include "studies/tuning/tuning_about.hpp"

namespace frahm::studies {
namespace {

void add_front_ends(const TuningAbout& about, GroupColumns& columns) {
  const TradeOffChoice& trade_off = *about.tune.trade_off;
  const tuning::FrontEnds& ends = about.optimum.ends;
  const double factor = trade_off.unit.si_factor;
  const std::string objective = objective_unit(about.study);
  columns.add_number({"least_trade_off", {}, {trade_off.name}}, trade_off.unit.text, ends.least / factor);
  columns.add_number("objective_at_least", objective, ends.objective_at_least);
  columns.add_number({"most_trade_off", {}, {trade_off.name}}, trade_off.unit.text, ends.most / factor);
  columns.add_number("objective_at_most", objective, ends.objective_at_most);
}

}  // namespace

std::vector<results::Column> front_columns(const Study& study, const TuningResult& result) {
  if (!study.tune()->trade_off) return {};
  const TuningAbout about(study, result);
  const TradeOffChoice& trade_off = *study.tune()->trade_off;
  std::vector<const tuning::Optimum*> optima;
  for (std::size_t i = 0; i < result.limits(); ++i) optima.push_back(&result.optimum(i));
  const auto of_each = [&](double tuning::Optimum::*number, double factor = 1.0) {
    std::vector<double> values;
    for (const tuning::Optimum* optimum : optima) values.push_back(optimum->*number / factor);
    return values;
  };
  std::vector<double> starts, dominated;
  std::vector<tuning::Outcome> outcomes;
  for (std::size_t i = 0; i < result.limits(); ++i) {
    outcomes.push_back(optima[i]->outcome);
    starts.push_back(static_cast<double>(result.starts[result.best[i]].number));
    dominated.push_back(is_dominated(result, i) ? 2.0 : 1.0);
  }
  GroupColumns columns;
  using tuning::Optimum;
  columns.add({"trade_off", {}, {trade_off.name}}, trade_off.unit.text, "trade_off",
              of_each(&Optimum::trade_off, trade_off.unit.si_factor));
  columns.add("objective", objective_unit(study), "trade_off", of_each(&Optimum::objective));
  columns.add("certificate_gap", "1", "trade_off", of_each(&Optimum::certificate_gap));
  columns.add("kkt_residual", "1", "trade_off", of_each(&Optimum::kkt_residual));
  columns.add("violation", "1", "trade_off", of_each(&Optimum::violation));
  columns.add_flag("outcome", "trade_off", outcome_words(), outcome_flags(outcomes));
  columns.add_count("best_start", "trade_off", starts);
  columns.add_flag("dominated", "trade_off", {"no", "yes"}, dominated);
  add_front_ends(about, columns);
  const NamedKnot under_limit = [](const std::string& knot, const std::string& what) {
    return Named::by_study(knot, what + " under that limit");
  };
  add_designs(about, under_limit, "trade_off", optima, columns);
  return columns.take();
}

}  // namespace frahm::studies
