#include "studies/tuning/optimum_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "engine/bad_entry.hpp"
#include "results/utf8.hpp"
#include "studies/tuning/optimum_entry.hpp"

namespace frahm::studies {
namespace {

using engine::BadEntry;
using tuning::Optimum;

void require(bool holds, const char* what) {
  if (!holds) throw BadEntry(fmt::format("{} does not belong to this study", what));
}

// Within the bounds but for rounding, or NaN where there is none.
void check_values(const DesignChoice& choice, const std::vector<double>& values) {
  const double slack = 1e-6 * std::max(choice.upper - choice.lower, std::abs(choice.upper));
  for (const double value : values)
    require(std::isnan(value) || (value >= choice.lower - slack && value <= choice.upper + slack),
            "a value of a parameter");
}

void check_parameters(const TuneChoice& tune, const Optimum& optimum) {
  if (optimum.parameters.empty()) return;  // a start that failed
  require(optimum.parameters.size() == tune.designs.size(), "the number of parameters");
  for (std::size_t i = 0; i < tune.designs.size(); ++i) {
    const tuning::TunedParameter& tuned = optimum.parameters[i];
    const std::size_t count = tune.designs[i].count();
    for (const std::size_t size : {tuned.value.size(), tuned.at_bound.size(), tuned.lower_multiplier.size(),
                                   tuned.upper_multiplier.size(), tuned.knots.size()})
      require(size == 0 || size == count, "the number of values of a parameter");
    check_values(tune.designs[i], tuned.value);
    require(std::ranges::is_sorted(tuned.knots), "the order of the knots");
    for (const tuning::AtBound end : tuned.at_bound)
      require(end >= tuning::AtBound::no && end <= tuning::AtBound::upper, "the bound of a parameter");
  }
}

void check_counts(const Optimum& optimum) {
  constexpr std::uint64_t most = std::numeric_limits<std::int32_t>::max();  // as the file stores them
  constexpr std::uint64_t most_orbits = std::uint64_t{1} << 53;
  const auto is_count = [](auto number) { return number >= 0 && static_cast<std::uint64_t>(number) <= most; };
  require(is_count(optimum.iterations), "the number of iterations");
  require(is_count(optimum.seen.cells), "the number of designs of the map");
  require(optimum.orbits <= most_orbits && optimum.gradients <= most_orbits, "the number of responses");
  for (const tuning::Round& round : optimum.rounds)
    require(is_count(round.active) && is_count(round.iterations), "the number of frequencies of a round");
}

void check_optimum(const TuneChoice& tune, const Optimum& optimum) {
  require(optimum.outcome >= tuning::Outcome::converged && optimum.outcome <= tuning::Outcome::stopped,
          "the outcome");
  try {
    results::check_utf8("reason", optimum.reason);
  } catch (const std::invalid_argument& reason) {
    throw BadEntry(reason.what());
  }
  check_parameters(tune, optimum);
  check_counts(optimum);
  const std::size_t scenarios = std::max<std::size_t>(1, tune.scenarios.size());
  const std::size_t records = tune.peaks ? tune.peaks->records.size() : 1;
  for (const tuning::Peak& peak : optimum.peaks)
    require(peak.scenario < scenarios && peak.record < records, "the scenario or record of a peak");
  for (const tuning::LimitState& limit : optimum.limits)
    require(limit.scenario < scenarios, "the scenario of a limit");
}

}  // namespace

void check_start(const Study& study, std::span<const std::byte> bytes) {
  const std::vector<Optimum> optima = decode_optima(bytes);
  const TuneChoice& tune = *study.tune();
  require(!optima.empty() && optima.size() <= (tune.trade_off ? tune.trade_off->limits.size() : 1),
          "the number of optima");
  for (const Optimum& optimum : optima) check_optimum(tune, optimum);
}

}  // namespace frahm::studies
