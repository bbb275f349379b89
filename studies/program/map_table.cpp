#include "studies/program/map_table.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <iostream>
#include <sstream>

#include "engine/progress.hpp"
#include "studies/map/map_summary.hpp"
#include "studies/map/output_quantities.hpp"
#include "studies/program/exit_code.hpp"
#include "studies/program/logged_run.hpp"
#include "studies/program/scatter_table.hpp"
#include "studies/provenance/finished_file.hpp"

namespace frahm::studies {
namespace {

constexpr int most_failures_shown = 3;

void print_effort(const Study& study, const Effort& effort, std::ostream& out) {
  const auto points = static_cast<double>(effort.points);
  fmt::print(out, "{:<22} {:.2f} s wall, {:.2f} s CPU on {}", "time", effort.seconds, effort.cpu_seconds,
             team_text(effort.threads, effort.ranks));
  if (effort.points > 0) {
    fmt::print(out, "; {} {}, {:.0f}/s, {:.0f} per CPU second", effort.points, answers_noun(study),
               points / effort.seconds, points / effort.cpu_seconds);
  }
  fmt::print(out, "\n");
}

// "3 points failed", "5 points have no periodic response that was found", or both; "some points failed" where
// the map has no status.
std::string failures_text(const std::vector<FlagCounts>& flags) {
  const auto status = std::ranges::find(flags, "status", &FlagCounts::variable);
  const std::uint64_t failed = status == flags.end() ? 0 : status->of("failed");
  const std::uint64_t not_periodic = status == flags.end() ? 0 : status->of("not_periodic");
  std::string text = failed > 0 ? fmt::format("{} points failed", failed) : "";
  if (not_periodic > 0)
    text += fmt::format("{}{} points for which no periodic response was found", failed > 0 ? ", " : "",
                        not_periodic);
  return text.empty() ? "some points failed" : text;
}

// What the responses of the map leave open.
void print_what_else(const MapPlan& plan, const results::MapReader& map, std::uint64_t points,
                     std::ostream& out) {
  if (const PointsAboveZero open = points_above_zero(map, "unsettled"); open.points > 0) {
    const periodic::OrbitsWanted wanted = plan.study.orbits_wanted();
    fmt::print(out,
               "{:<22} at {} of {} points {} of {} starts reached no stable response of up to {} periods: "
               "others may exist\n",
               "unsettled", open.points, points, open.sum,
               open.points * static_cast<std::uint64_t>(wanted.starts), wanted.most_multiple);
  }
  if (const PointsAboveZero open = points_above_zero(map, "continuum"); open.points > 0)
    fmt::print(
        out,
        "{:<22} {} of {} points show one of a continuum of responses, because sliders of jenkins or iwan "
        "elements never slip there: the one with z(T/2) = -z(0), otherwise the one of least energy\n",
        "continuum", open.points, points);
}

// The lines are those of provenance(): "<point as --at takes it>: <reason>".
void print_failures(const MapPlan& plan, const std::filesystem::path& study, const std::string& lines,
                    const std::string& failures) {
  std::istringstream rows(lines);
  std::string line;
  fmt::print(std::cerr, "{}; the first of them:\n", failures);
  for (int i = 0; i < most_failures_shown && std::getline(rows, line); ++i) {
    const std::size_t colon = line.find(": ");
    fmt::print(std::cerr, "  {}\n    frahm point {} --at \"{}\"", line, study.string(),
               line.substr(0, colon));
    for (const std::string& set : plan.set) fmt::print(std::cerr, " --set \"{}\"", set);
    fmt::print(std::cerr, "\n");
  }
}

}  // namespace

int print_map_table(const MapPlan& plan, const std::filesystem::path& study,
                    const std::filesystem::path& file, const std::optional<Effort>& effort,
                    std::ostream& out) {
  const results::MapReader map(file);
  const auto& variables = map.layout().variables;
  const std::uint64_t points = points_of(map.layout());
  const auto headline = std::ranges::find(variables, headline_of(plan.study), &results::Variable::name);
  const auto& samples = plan.study.map()->samples;
  const bool along_samples = samples && samples->dimension == 0;  // which lie in no order
  if (headline != variables.end() && !along_samples) {
    const auto variable = static_cast<std::size_t>(headline - variables.begin());
    print_worst(map, worst_along_slowest_axis(map, variable), out);
  }
  print_scatter(plan, file, out);
  const std::vector<FlagCounts> flags = count_flags(map);
  print_flags(flags, points, out);
  print_what_else(plan, map, points, out);
  if (effort) print_effort(plan.study, *effort, out);
  if (effort && plan.grown_from) {
    fmt::print(out, "{:<22} {} points of {}, {} computed\n", "reused", effort->reused, plan.grown_from->file,
               effort->points);
  }
  fmt::print(out, "{:<22} {} ({} point{}, {} variable{}, {:.1f} MB)\n", "file", file.string(), points,
             points == 1 ? "" : "s", variables.size(), variables.size() == 1 ? "" : "s",
             static_cast<double>(std::filesystem::file_size(file)) / 1e6);

  const std::string lines = provenance_text(map, "failed_points");
  if (lines.empty()) return exit_code::done;
  print_failures(plan, study, lines, failures_text(flags));
  return exit_code::some_failed;
}

}  // namespace frahm::studies
