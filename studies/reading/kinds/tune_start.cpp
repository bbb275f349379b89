#include "studies/reading/kinds/tune_start.hpp"

#include <algorithm>
#include <cstdint>

#include "studies/reading/kinds/tune_reading.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {

// Sequential quadratic programming goes on from a start that is nearly right in a few steps, each of the cube
// of the variables: it suits constants, and a schedule of some dozen knots that starts from its best path.
// Many knots, and schedules without such a start, suit an interior point.
tuning::SolverKind read_solver(const TomlSection& section, const TuneChoice& choice) {
  constexpr std::size_t kFewKnots = 60;
  std::size_t knots = 0, schedules = 0;
  for (const DesignChoice& design : choice.designs) {
    if (!design.is_scheduled()) continue;
    ++schedules;
    knots += design.count();
  }
  const bool starts_from_path =
      schedules == 1 && choice.objective == tuning::Objective::minimax && !section.find("dominate");
  const char* by_default = schedules == 0 || (starts_from_path && knots <= kFewKnots) ? "slsqp" : "ipopt";
  return tuning::solver_named(section.choice("solver", by_default));
}

void check_map(const TuneReading& reading, const TomlSection& section) {
  constexpr std::ptrdiff_t kMostOfMap = 3;
  if (reading.choice.start != tuning::Start::map) return;
  const auto varying = std::ranges::count_if(
      reading.choice.designs, [](const DesignChoice& design) { return design.lower < design.upper; });
  if (varying > kMostOfMap)
    section.fail(rules::beyond_schema(rules::out_of_range), "start",
                 "\"map\" searches up to {} parameters, but {} are tuned; write a number of starts",
                 kMostOfMap, varying);
  if (tuning::may_take_several_orbits(reading.study.network))
    section.fail(rules::unfit_quantity, "start",
                 "\"map\" needs a system with one response at each frequency; write a number of starts");
}

void read_start(const TomlSection& section, TuneChoice& choice) {
  const TomlValue* value = section.find("start");
  if (value && value->as<std::int64_t>()) {
    choice.start = tuning::Start::many;
    choice.starts = static_cast<std::size_t>(section.integer("start"));
  } else if (value && !value->as<std::string>()) {
    section.fail(rules::wrong_type, "start",
                 "expected \"map\", \"given\", \"nlopt\" or a number of starts, found {}", described(*value));
  } else {
    const std::string word = section.choice("start", "given", " or a number of starts");
    if (word == "nlopt") choice.start = tuning::Start::global;
    if (word == "map") choice.start = tuning::Start::map;
  }
  choice.start_is_given = value != nullptr;
  if (section.find("global") && choice.start != tuning::Start::global)
    section.fail(rules::beyond_schema(rules::key_without_use), "global", "belongs to start = \"nlopt\"");
  choice.global_solver = tuning::solver_named(section.choice("global"));
}

}  // namespace frahm::studies
