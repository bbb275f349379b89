#include "studies/program/check_command.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "engine/progress.hpp"
#include "engine/team.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "solvers/mechanics/rotation.hpp"
#include "studies/identification/identification_columns.hpp"
#include "studies/identification/identification_result.hpp"
#include "studies/map/first_modes.hpp"
#include "studies/map/map_groups.hpp"
#include "studies/map/map_plan.hpp"
#include "studies/map/map_sample.hpp"
#include "studies/map/map_summary.hpp"
#include "studies/map/motion_cost.hpp"
#include "studies/map/statistics_group.hpp"
#include "studies/map/unfit_systems.hpp"
#include "studies/motion/one_motion.hpp"
#include "studies/program/array_job.hpp"
#include "studies/program/branch_cost.hpp"
#include "studies/program/check_tuning.hpp"
#include "studies/program/exit_code.hpp"
#include "studies/program/memory_use.hpp"
#include "studies/program/modes_table.hpp"
#include "studies/program/rank_table.hpp"
#include "studies/program/readable_size.hpp"
#include "studies/program/record_table.hpp"
#include "studies/program/scatter_table.hpp"
#include "studies/reading/settings.hpp"
#include "studies/reading/study/series_text.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_units.hpp"

namespace frahm::studies {
namespace {

using Clock = std::chrono::steady_clock;

void print_grid(const Study& study, const Grid& grid, std::ostream& out) {
  fmt::print(out, "points  {} = ", grid.points());
  for (std::size_t d = 0; d < study.map()->dimensions.size(); ++d) {
    fmt::print(out, "{}{} {}", d == 0 ? "" : " x ", grid.shape[d], study.map()->dimensions[d].name);
  }
  fmt::print(out, "\ntiles   {} of {} points\n", grid.tiles(), grid.box(0).points());
}

void print_series(const Study& study, std::ostream& out) {
  for (const std::string& text : series_texts(study.values)) fmt::print(out, "series  {}\n", text);
}

std::string about_seconds(double seconds) {
  return seconds < 1.0 ? "less than a second" : "about " + engine::readable_time(seconds);
}

// What a result holds of a variable or an axis next to its numbers: name, units, place in the file [bytes].
constexpr double bytes_of_variable = 5e3;

// A thread computes whole tiles, so that some threads may wait for the last.
void print_prediction(const MapPlan& plan, const MapSample& sample, const MemoryUse& memory,
                      int wanted_threads, std::ostream& out) {
  const Study& study = plan.study;
  const Grid& grid = plan.grid;
  const double share = static_cast<double>(grid.points()) / static_cast<double>(sample.points);
  const int threads = engine::team_size(wanted_threads, grid.tiles());
  const std::uint64_t turns =
      (grid.tiles() + static_cast<std::uint64_t>(threads) - 1) / static_cast<std::uint64_t>(threads);
  const double seconds =
      sample.seconds * share * static_cast<double>(turns) / static_cast<double>(grid.tiles());
  const double rate = static_cast<double>(sample.points) / sample.seconds;
  fmt::print(out, "time    {} on {} thread{} of this machine ({:.3g} {}/s on one, from {} points)\n",
             about_seconds(seconds), threads, threads == 1 ? "" : "s", rate, answers_noun(study),
             sample.points);
  fmt::print(out, "memory  about {}\n",
             readable_size(memory.of_run(threads) + threads * statistics_memory(plan)));
  fmt::print(
      out, "file    about {} (its numbers {} before compression)\n",
      readable_size(static_cast<double>(sample.stored_bytes) * share +
                    bytes_of_variable * static_cast<double>(plan.variables.size() + grid.shape.size())),
      readable_size(static_cast<double>(sample.raw_bytes) * share));
  if (sample.failed > 0) {
    fmt::print(out, "without {}: {} of the {} points tried, the first at {}: {}\n",
               study.transient() ? "a motion" : "a response", sample.failed, sample.points, sample.failed_at,
               sample.reason);
  }
}

// Tells the systems that cannot be, which the sample may not have met.
void print_unfit_systems(const Study& study, const MapSample& sample, std::ostream& out) {
  const UnfitSystems found = unfit_systems(study);
  if (found.unfit == 0 || sample.reason == found.reason) return;
  fmt::print(out, "without a system: {} of {} combinations of masses and elements, the first at {}: {}\n",
             found.unfit, found.tried, found.first_at, found.reason);
}

// The orbits that the study lists are solved once more, for their histories.
void print_orbits_cost(const MapPlan& plan, int threads, std::ostream& out) {
  const std::size_t orbits = plan.study.map()->output.histories.size();
  if (orbits == 0) return;
  const OrbitsCost cost = cost_of_orbits(plan);
  const double seconds = cost.seconds / engine::team_size(threads, orbits);
  fmt::print(out, "orbits  the histories of {}, about {} more, {} before compression\n", orbits,
             seconds < 1.0 ? "a second" : engine::readable_time(seconds), readable_size(cost.bytes));
}

void print_array(const CheckOptions& options, const StudyPlan& plan, const char* noun,
                 std::optional<double> core_seconds, std::ostream& out) {
  print_array_job({.study = options.study,
                   .set = options.set,
                   .noun = noun,
                   .tiles = plan.tiles,
                   .core_seconds = core_seconds,
                   .most_tasks = options.max_array > 0 ? options.max_array : most_array_tasks()},
                  out);
}

void print_first_modes(const Study& study, const Grid& grid, Listing listing, std::ostream& out) {
  const mechanics::NetworkValues values = values_at_first_point(study);
  const std::vector<std::uint64_t> first(grid.shape.size(), 0);
  fmt::print(out, "\nAt the first point of the grid, {}:\n", point_text(study, first));
  try {
    const ModesAtPoint modes = modes_at_point(study, values);
    if (study.transient()) print_records(study, modes.sliding, out);
    print_modes(study, modes, listing, out);
  } catch (const mechanics::MechanicsError& error) {
    fmt::print(out, "No modes: {}\n", error.what());
  }
}

std::string seconds_text(const Study& study, double seconds) {
  return fmt::format("{:.6g}{}", seconds, study.dimensionless ? "" : " s");
}

// "250 rpm", as the study speaks of frequencies.
std::string frequency_text(const Study& study, double omega) {
  const SpokenValue spoken = spoken_frequency(study, omega);
  return fmt::format("{:.6g}{}{}", spoken.value, spoken.unit.empty() ? "" : " ", spoken.unit);
}

void print_decay_choice(const Study& study, const mechanics::NetworkValues& values, std::ostream& out) {
  const auto& duration = study.motion()->duration;
  fmt::print(out, "decay      free vibration, {}\n",
             duration ? "for " + seconds_text(study, stated(study, *duration))
                      : "until rest, or until its end is clear");
  if (mechanics::frequency_dependent_element(study.network) && values.hysteretic_omega > 0.0) {
    fmt::print(out, "reference  {}: the loss factors' frequency\n",
               frequency_text(study, values.hysteretic_omega));
  }
}

void print_transient_choice(const Study& study, std::ostream& out) {
  const transient::ForcedOptions options = forced_options(study);
  fmt::print(out, "transient  {}", seconds_text(study, options.duration));
  if (std::ranges::any_of(study.network.excitations, [](const auto& each) { return each.order > 0; }))
    fmt::print(out, " at {}", frequency_text(study, options.from));
  if (options.run_up.rate > 0.0) {
    fmt::print(out, ", running to {} at {} a {}", frequency_text(study, options.run_up.to),
               frequency_text(study, options.run_up.rate), study.dimensionless ? "unit of time" : "second");
  }
  fmt::print(out, "\n");
}

ModesAtPoint modes_of_motion(const Study& study, const mechanics::NetworkValues& values) {
  try {
    return modes_at_point(study, values);
  } catch (const mechanics::MechanicsError& error) {
    throw StudyError(rules::not_computed, "{}", study.source.name + ": " + error.what());
  }
}

// Checks a decay or transient.
int check_motion(const Study& study, Listing listing, std::ostream& out) {
  const mechanics::NetworkValues values = motion_values(study);
  const transient::InitialState initial = initial_state(study);
  const ModesAtPoint modes = modes_of_motion(study, values);
  if (study.kind() == StudyKind::decay) check_duration(study, values);
  fmt::print(out, "{} is a valid study{}{}\n\n", study.source.name, study.title.empty() ? "" : ": ",
             study.title);
  if (study.kind() == StudyKind::decay) {
    print_decay_choice(study, values, out);
  } else {
    print_transient_choice(study, out);
    print_series(study, out);
  }
  for (std::size_t i = 0; i < initial.displacement.size(); ++i) {
    const bool turns = mechanics::rotates(study.network, i);
    const auto unit = [&](const char* linear, const char* angular) {
      return study.dimensionless ? "" : turns ? angular : linear;
    };
    fmt::print(out, "initial    {}: {:.6g}{}, {:.6g}{}\n", study.network.masses[i], initial.displacement[i],
               unit(" m", " rad"), initial.velocity[i], unit(" m/s", " rad/s"));
  }
  fmt::print(out, "samples    {}\n", study.motion()->samples);
  if (study.transient()) fmt::print(out, "time       {}\n", about_seconds(predicted_motion_seconds(study)));
  fmt::print(out, "\n");
  if (study.transient()) print_records(study, modes.sliding, out);
  print_modes(study, modes, listing, out);
  return exit_code::done;
}

// Refuses what a run refuses: a method in closed form is carried out, a fit of motions for this time at most.
constexpr double identification_seconds = 1.0;
void try_identification(const Study& study) {
  struct LongEnough {};
  const auto start = Clock::now();
  try {
    const IdentificationResult result = identify(study, [start] {
      if (std::chrono::duration<double>(Clock::now() - start).count() > identification_seconds)
        throw LongEnough{};
    });
    identification_columns(study, result);
  } catch (const LongEnough&) {
  }
}

std::optional<ModesAtPoint> modes_of_identification(const Study& study) {
  if (study.network.masses.empty()) return std::nullopt;
  return modes_of_motion(study, stated_values(study));
}

// Checks an identification.
int check_identification(const CheckOptions& options, Study read, std::ostream& out) {
  const StudyPlan plan = plan_without_map(std::move(read), options.set);
  const Study& study = plan.study;
  try_identification(study);
  const std::optional<ModesAtPoint> modes = modes_of_identification(study);
  fmt::print(out, "{} is a valid study{}{}\n\n", study.source.name, study.title.empty() ? "" : ": ",
             study.title);
  print_identification_choice(study, out);
  if (!modes) return exit_code::done;
  fmt::print(out, "\n");
  print_stated_modes(study, *modes, options.listing(), out);
  return exit_code::done;
}

MapSample sample_of(const MapPlan& plan, double seconds) {
  try {
    return sample_map(plan, seconds);
  } catch (const mechanics::MechanicsError& error) {
    throw StudyError(rules::not_computed, "{}", plan.study.source.name + ": " + error.what());
  }
}

}  // namespace

int check_command(const CheckOptions& options, std::ostream& out) {
  constexpr double sample_seconds = 1.0;
  const auto start = Clock::now();
  Study read = read_study_with(options.study, options.set);
  if (options.simulate_ranks > 0 && !read.map())
    throw StudyError(rules::other_kind, "{}",
                     options.study.string() + ": --simulate-ranks is for maps; this study is " +
                         std::string(kind_noun(read.kind())));
  switch (read.kind()) {
    case StudyKind::tune:
      return check_tuning(options, std::move(read), out);
    case StudyKind::identify:
      return check_identification(options, std::move(read), out);
    case StudyKind::decay:
      return check_motion(read, options.listing(), out);
    case StudyKind::transient:
      if (!read.map()) return check_motion(read, options.listing(), out);
      break;
    case StudyKind::sweep:
      break;
  }
  const MapPlan plan = plan_map(std::move(read), options.set);
  refuse_unfit_map(plan.study);
  const double start_seconds = std::chrono::duration<double>(Clock::now() - start).count();
  const Study& study = plan.study;
  const MemoryUse memory;
  const MapSample sample = sample_of(plan, sample_seconds);
  const double core_seconds =
      sample.seconds * static_cast<double>(plan.grid.points()) / static_cast<double>(sample.points);

  const bool has_none = sample.failed == sample.points;
  if (has_none) {
    fmt::print(out, "{} can be read, but none of the points tried has {}\n\n", study.source.name,
               study.transient() ? "a motion" : "a response");
  } else {
    fmt::print(out, "{} is a valid study{}{}\n\n", study.source.name, study.title.empty() ? "" : ": ",
               study.title);
  }
  print_grid(study, plan.grid, out);
  print_series(study, out);
  print_samples(study, out);
  print_prediction(plan, sample, memory, options.threads, out);
  print_unfit_systems(study, sample, out);
  if (study.sweep()) {
    print_orbits_cost(plan, options.threads, out);
    print_branch_cost(plan, sample, options.threads, out);
  }
  print_array(options, plan, "map", core_seconds, out);
  if (options.simulate_ranks > 0) {
    print_rank_table(plan.grid, sample, options.simulate_ranks, std::max(1, options.threads), start_seconds,
                     out);
  }
  print_first_modes(study, plan.grid, options.listing(), out);
  return has_none ? exit_code::some_failed : exit_code::done;
}

}  // namespace frahm::studies
