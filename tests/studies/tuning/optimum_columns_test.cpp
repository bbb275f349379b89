#include "studies/tuning/optimum_columns.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "studies/provenance/study_plan.hpp"
#include "studies/reading/parse_study.hpp"
#include "studies/reading/quantities/units.hpp"
#include "studies/tuning/tuning_plan.hpp"
#include "tests/studies/small_tunings.hpp"
#include "tests/study_path.hpp"

namespace optimum_columns_test {
namespace {

using namespace frahm;
using namespace frahm::studies;
using namespace small_tunings;
constexpr double rounding = 1e-14;  // a few roundings of double arithmetic

Study parse(const std::string& text) {
  return parse_study(text, "tuning.toml");
}

// A rig in engineer's units with a schedule over rpm.
const std::string rig =
    "[study]\nschema = 1\nkind = \"tune\"\n"
    "[parameters]\nn = { value = 250, unit = \"rpm\" }\nI = 6\nk = { value = 11, unit = \"kN/m\" }\n"
    "[[mass]]\nname = \"main\"\nmass = 102.66\n[[mass]]\nname = \"tmd\"\nmass = 12.82\n"
    "[[element]]\nname = \"spring\"\ntype = \"spring\"\nbetween = [\"ground\", \"main\"]\nstiffness = 57e3\n"
    "[[element]]\nname = \"tmd_spring\"\ntype = \"spring\"\nbetween = [\"main\", \"tmd\"]\nstiffness = "
    "\"k\"\n"
    "[[element]]\nname = \"inerter\"\ntype = \"inerter\"\nbetween = [\"main\", \"tmd\"]\ninertance = \"I\"\n"
    "[excitation]\nfrequency = \"n\"\n[[excitation.force]]\non = \"main\"\namplitude = 240\n"
    "[tune]\nobjective = \"minimax\"\nquantity = \"main_peak\"\n"
    "band = { parameter = \"n\", from = 150, to = 350, unit = \"rpm\" }\n"
    "[[design]]\nparameter = \"I\"\nlower = 4\nupper = 13\nschedule = { knots = [150, 200, 350], max_slope = "
    "0.25 }\n"
    "rule = \"k/n^2\"\n"
    "[[design]]\nparameter = \"k\"\nlower = 5\nupper = 20\n"
    "[[constraint]]\nquantity = \"tmd_spring_stroke\"\nupper = 80\nunit = \"mm\"\n"
    "[[column]]\nname = \"ratio\"\nvalue = \"I/10\"\nlower = 0.5\nupper = 0.8\n"
    "[[column]]\nname = \"grams\"\nvalue = \"I\"\nunit = \"g\"\nupper = 7000\n"
    "[[column]]\nname = \"twice\"\nvalue = \"2000*I\"\nunit = \"g\"\n";

tuning::Optimum optimum_of(double objective, tuning::Outcome outcome = tuning::Outcome::converged) {
  tuning::Optimum optimum;
  optimum.outcome = outcome;
  optimum.objective = objective;
  return optimum;
}

// A result of the rig's shape, made up.
TuningResult rig_result(const Study& study) {
  tuning::Optimum optimum = optimum_of(0.02);
  using enum tuning::AtBound;
  optimum.parameters = {{{5, 9, 6}, {no, upper, no}, {0, 0, 0}, {0, 1e-3, 0}},
                        {{12e3}, {upper}, {0}, {2e-6}}};
  optimum.parameters[0].knots = study.tune()->designs[0].knots;
  const tuning::Band& band = study.tune()->band->range;
  optimum.peaks = {{0, 0, band.from, 0.02, 1.0, {1e-3, 3e-6}}};
  optimum.limits = {{0.07, band.to, 0, 0.125, 0.25}};
  optimum.constant = {8.0, 11e3};
  TuningResult result{
      .starts = {{0, {optimum_of(0.03)}}, {1, {optimum}}}, .best = {1}, .assessment = {}, .before = {}};
  result.assessment.band = {band.from, 0.5 * (band.from + band.to), band.to};
  result.assessment.curves = {{"before", {{0.01, 0.03, 0.01}}, 0.03}, {"after", {{0.02, 0.01, 0.02}}, 0.02}};
  return result;
}

const results::Column& named(const std::vector<results::Column>& columns, const std::string& name) {
  for (const auto& column : columns) {
    if (column.variable.name == name) return column;
  }
  throw std::out_of_range(name);
}

TEST_CASE("the record of a tuning is in the units of its study") {
  const Study study = parse(rig);
  const auto columns = optimum_columns(study, rig_result(study));
  results::check(columns);
  const auto values = [&](const char* name) { return named(columns, name).values; };
  const auto unit = [&](const char* name) { return named(columns, name).variable.unit; };
  CHECK_THAT(values("k")[0], Catch::WithinRel(12.0, rounding));
  CHECK(unit("k") == "kN/m");
  CHECK_THAT(values("k_upper_multiplier")[0], Catch::WithinRel(2e-3, rounding));
  CHECK(unit("k_upper_multiplier") == "m (kN/m)-1");
  CHECK(values("k_at_bound") == std::vector<double>{3});
  CHECK(values("I_at_bound") == std::vector<double>{1, 3, 1});
  CHECK_THAT(values("k_before")[0], Catch::WithinRel(11.0, rounding));
  CHECK(values("I") == std::vector<double>{5, 9, 6});
  CHECK(named(columns, "I").dimension == "knots_I");
  CHECK_THAT(values("knots_I")[1], Catch::WithinRel(200.0, rounding));
  CHECK(unit("knots_I") == "rpm");
  CHECK_THAT(values("I_max_slope")[0], Catch::WithinRel(0.25, rounding));
  CHECK(unit("I_max_slope") == "kg (rpm)-1");
  CHECK_THAT(values("k_sensitivity")[0], Catch::WithinRel(3e-3, rounding));
  CHECK_THAT(values("peak_n")[0], Catch::WithinRel(150.0, rounding));
  CHECK_THAT(values("tmd_spring_stroke_limited")[0], Catch::WithinRel(70.0, rounding));
  CHECK(values("tmd_spring_stroke_limit_excess") == std::vector<double>{0.125});
  CHECK_THAT(values("tmd_spring_stroke_limit_multiplier")[0], Catch::WithinRel(0.25e-3, rounding));
  CHECK(std::isnan(values("tmd_spring_stroke_lower_limit")[0]));
  CHECK(named(columns, "response_after").dimension == "n");
  CHECK_THAT(values("I_schedule")[1], Catch::WithinRel(8.0, rounding));
  // A parameter alone is converted, an expression gives its number in the unit.
  CHECK_THAT(values("grams")[1], Catch::WithinRel(8000.0, rounding));
  CHECK(unit("grams") == "g");
  CHECK(values("grams_range") == std::vector<double>{1, 3, 1});
  CHECK_THAT(values("twice")[1], Catch::WithinRel(16000.0, rounding));
  CHECK(values("ratio_range") == std::vector<double>{1, 1, 1});
  CHECK(values("ratio_range_lower") == std::vector<double>{0.5});
  CHECK(values("ratio_range_upper") == std::vector<double>{0.8});
  CHECK(values("outcome") == std::vector<double>{1});
  CHECK(values("best_start") == std::vector<double>{1});
  CHECK(values("start_objective") == std::vector<double>{0.03, 0.02});
  CHECK(std::isnan(values("start_k")[0]));
}

std::string text_of(const std::string& name, const Study& study, const TuningResult& result) {
  const auto texts = optimum_texts(study, result);
  const auto is_it = [&](const results::Text& text) { return text.first == name; };
  const auto found = std::find_if(texts.begin(), texts.end(), is_it);
  return found == texts.end() ? std::string() : found->second;
}

TEST_CASE("a record tells that its schedule was to dominate the constant, and only then") {
  const auto dominate = [](const Study& study) { return text_of("dominate", study, rig_result(study)); };
  CHECK(dominate(parse(rig)).empty());
  std::string dominating = rig;
  dominating.replace(dominating.find("[[design]]"), 10, "dominate = \"constant\"\n[[design]]");
  CHECK(dominate(parse(dominating)) == "constant");
}

TEST_CASE("the assessment of an optimum ends where it is asked to stop, amid the frequencies of a curve") {
  const Study study = read_study(study_path("tune_absorber_stops"));
  tuning::Optimum optimum = optimum_of(2.0);
  optimum.parameters = {{{0.9}, {tuning::AtBound::no}, {0}, {0}}, {{0.1}, {tuning::AtBound::no}, {0}, {0}}};
  int asked = 0;
  const TuningResult result = tuning_result(study, {{0, {optimum}}}, [&] { return ++asked > 20; });
  CHECK(result.assessment.searched.points < 20);
  CHECK(result.optimum().objective == 2.0);
}

TEST_CASE("the certificate of a worst peak says which width of a peak it may miss, in the band's unit") {
  const Study study = parse(rig);  // 150 to 350 rpm
  const auto columns = optimum_columns(study, rig_result(study));
  const auto& width = named(columns, "certificate_width");
  CHECK(width.variable.unit == "rpm");
  CHECK_THAT(width.values.front(), Catch::WithinRel(1e-7 * 200.0 / 48.0, 1e-12));
}

TEST_CASE("a variance without a band has the objective of the design before beside that after") {
  const Study study = parse(
      heading + absorber +
      "[tune]\nobjective = \"variance\"\nquantity = \"main_rms\"\nnoise = { force_on = \"main\" }\n" + of_f);
  tuning::Optimum optimum = optimum_of(2.0);
  optimum.parameters = {{{0.9}, {tuning::AtBound::no}, {0}, {0}}};
  TuningResult result{.starts = {{0, {optimum}}}, .best = {0}, .assessment = {}, .before = {}};
  result.assessment.curves = {{"before", {}, 3.0}, {"after", {}, 2.0}};
  const auto columns = optimum_columns(study, result);
  results::check(columns);
  CHECK(named(columns, "worst_before").values == std::vector<double>{3.0});
  CHECK(named(columns, "worst_after").values == std::vector<double>{2.0});
  CHECK(text_of("noise", study, result) == "a force on main");
  CHECK(text_of("relative_to", study, result).empty());
}

TEST_CASE("a variance under support motion says that it is of the motion relative to the support") {
  const Study study = read_study(study_path("tune_h2_support"));
  const TuningResult result{.starts = {{0, {optimum_of(2.0)}}}, .best = {0}, .assessment = {}, .before = {}};
  CHECK(text_of("noise", study, result) == "the acceleration of base");
  CHECK(text_of("noise_density", study, result) == "1");
  CHECK(text_of("relative_to", study, result) == "base");
}

TEST_CASE("every unit of the record is one that UDUNITS reads") {
  const Study study = parse(rig);
  const UnitSystem units;
  for (const auto& column : optimum_columns(study, rig_result(study))) {
    INFO(column.variable.name << " [" << column.variable.unit << "]");
    if (column.variable.type != results::Type::flag) CHECK_NOTHROW(units.parse(column.variable.unit));
  }
  std::string squared = rig;
  squared.replace(squared.find("minimax"), 7, "mean_square");
  squared.replace(squared.find("main_peak"), 9, "main_velocity_peak");
  const Study mean = parse(squared);
  CHECK(objective_unit(mean) == "(m s-1)2");
  const Unit unit = units.parse(objective_unit(mean));
  CHECK(unit.exponents == std::array<int, 3>{2, 0, -2});
}

TEST_CASE("names that would stand twice in the record are refused, with the name") {
  std::string text = classical;
  for (std::size_t i = 0; (i = text.find("zeta", i)) != std::string::npos; i += 5)
    text.replace(i, 4, "start");
  CHECK_THROWS_WITH(plan_tuning(parse(text), {}),
                    Catch::Contains("the same name twice") && Catch::Contains("start"));
  CHECK_THROWS_WITH(plan_tuning(parse(classical + "[[column]]\nname = \"f\"\nvalue = \"f\"\n"), {}),
                    Catch::Contains("'f'"));
  CHECK_NOTHROW(plan_tuning(parse(classical), {}));
}

TEST_CASE("a front tells its ends and which of its limits gain nothing") {
  const Study study =
      parse(small_tunings::heading + absorber + minimax +
            "trade_off = { quantity = \"tmd_spring_stroke\", values = [30, 26, 22] }\n" + of_f);
  tuning::Optimum loose = optimum_of(7.0), middle = optimum_of(7.0 * (1.0 + 1e-9)), tight = optimum_of(8.0);
  loose.trade_off = 30, middle.trade_off = 26, tight.trade_off = 22;
  tight.ends = {.least = 20.0, .objective_at_least = 9.0, .most = 25.0, .objective_at_most = 7.0};
  const TuningResult result{
      .starts = {{0, {loose, middle, tight}}}, .best = {0, 0, 0}, .assessment = {}, .before = {}};
  CHECK(is_dominated(result, 0));
  CHECK_FALSE(is_dominated(result, 1));
  CHECK_FALSE(is_dominated(result, 2));
  const auto front = front_columns(study, result);
  CHECK(named(front, "dominated").values == std::vector<double>{2, 1, 1});
  CHECK(named(front, "least_trade_off").values.front() == 20.0);
  CHECK(named(front, "objective_at_most").values.front() == 7.0);
}

TEST_CASE("a tuning that began at a map records what it saw of the box") {
  const Study study = parse(classical);
  tuning::Optimum optimum = optimum_of(7.0);
  optimum.seen = {.cells = 121, .share = 0.5, .polished = {7.0, 7.5}};
  const TuningResult result{.starts = {{0, {optimum}}}, .best = {0}, .assessment = {}, .before = {}};
  const auto columns = optimum_columns(study, result);
  CHECK(named(columns, "map_cells").values.front() == 121);
  CHECK(named(columns, "map_share").values.front() == 0.5);
  CHECK(named(columns, "map_objective").values == std::vector<double>{7.0, 7.5});
}

TEST_CASE("a converged start comes before a lower one that is not, then the least, then the first") {
  using tuning::Outcome;
  const auto best = [](const std::vector<tuning::Optimum>& optima) {
    std::vector<const tuning::Optimum*> all;
    for (const auto& optimum : optima) all.push_back(&optimum);
    return best_of(all);
  };
  CHECK(best({optimum_of(1.0, Outcome::not_converged), optimum_of(2.0), optimum_of(1.5), optimum_of(1.5)}) ==
        2);
  CHECK(best({optimum_of(std::nan("")), optimum_of(2.0)}) == 1);
  tuning::Optimum near = optimum_of(3.0, Outcome::infeasible), far = optimum_of(1.0, Outcome::infeasible);
  near.violation = 0.1;
  far.violation = 0.2;
  CHECK(best({far, near}) == 1);
  CHECK(best({near, optimum_of(9.0, Outcome::not_converged)}) == 1);
}

TEST_CASE("what changes an optimum is physics; rules and columns are not") {
  const auto of = [](const std::string& text) { return plan_tuning(parse(text), {}).fingerprint; };
  const auto base = of(rig);
  const auto changed = [&](const std::string& passage, const std::string& by) {
    std::string text = rig;
    text.replace(text.find(passage), passage.size(), by);
    return of(text);
  };
  for (const auto& [passage, by] : std::vector<std::pair<std::string, std::string>>{
           {"to = 350", "to = 350.5"},
           {"upper = 20", "upper = 21"},
           {"knots = [150, 200, 350]", "knots = 3"},
           {"max_slope = 0.25", "max_slope = 1"},
           {"upper = 80", "upper = 81"},
           {"\"main_peak\"", "\"tmd_peak\""},
           {"\"minimax\"", "\"mean_square\""},
           {"k = { value = 11", "k = { value = 12"},
           {"amplitude = 240", "amplitude = 241"},
           {"[[design]]", "tolerance = 1e-5\n[[design]]"},
           {"[[design]]", "solver = \"ipopt\"\n[[design]]"},
           {"[[design]]", "weight = \"n\"\n[[design]]"},
           {"[[design]]", "dominate = \"constant\"\n[[design]]"}}) {
    INFO(passage << " -> " << by);
    // The band's knots move with its end, which would be refused.
    const std::string knots = passage == "to = 350" ? "from" : "";
    if (knots.empty()) CHECK(changed(passage, by).physics != base.physics);
  }
  CHECK(changed("value = 250", "value = 260") == base);
  for (const auto& [passage, by] :
       std::vector<std::pair<std::string, std::string>>{{"k/n^2", "k/n^3"}, {"upper = 0.8", "upper = 0.9"}}) {
    CHECK(changed(passage, by).physics == base.physics);
    CHECK(changed(passage, by).grid != base.grid);
  }
  std::string more = rig;
  more.replace(more.find("[[design]]"), 10, "start = 4\n[[design]]");
  std::string most = rig;
  most.replace(most.find("[[design]]"), 10, "start = 8\n[[design]]");
  CHECK(of(more).physics != of(most).physics);
}

TEST_CASE("The band and what scenarios set are refused by --set, which would be without effect") {
  CHECK_THROWS_WITH(plan_tuning(parse(rig), {"n=200"}), Catch::Contains("runs over the band"));
  CHECK_THROWS_WITH(
      plan_tuning(parse(classical + "[[scenario]]\nname = \"two\"\nset = { P = 2 }\n"), {"P=3"}),
      Catch::Contains("is set by the scenario \"two\""));
}

}  // namespace
}  // namespace optimum_columns_test
