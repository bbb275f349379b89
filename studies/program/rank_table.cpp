#include "studies/program/rank_table.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include "engine/progress.hpp"
#include "engine/team.hpp"
#include "studies/reading/text/study_source.hpp"

namespace frahm::studies {
namespace {

constexpr double enough = 0.9;                     // efficiency worth asking for
constexpr std::int64_t most_threads = 10'000'000;  // in all: 80 MB

std::string wall_time(double seconds) {
  return seconds < 60.0 ? fmt::format("{:.3g} s", seconds) : engine::readable_time(seconds);
}

void print_row(const RankCosts& costs, int ranks, int threads, std::ostream& out) {
  const RankPrediction p = simulate_ranks(costs, ranks, threads);
  fmt::print(out, "{:>7}{:>9}{:>16}{:>10.1f} %{:>8.1f} %{:>9.1f} %{:>9.1f} %{:>9.1f} %{:>9.1f} %\n", ranks,
             static_cast<std::int64_t>(ranks) * threads, wall_time(p.wall), 100.0 * p.efficiency,
             100.0 * p.efficiency / (p.efficiency + p.waiting + p.imbalance), 100.0 * p.start,
             100.0 * p.waiting, 100.0 * p.imbalance, 100.0 * p.assembly);
}

void print_limit(const RankCosts& costs, int ranks, int threads, std::ostream& out) {
  const int limit = ranks_with_efficiency(costs, threads, enough, ranks);
  if (limit == 0) {
    fmt::print(out, "Efficiency is below {:.0f} % on one rank already: the map is too small for more.\n",
               100.0 * enough);
    return;
  }
  fmt::print(out, "Efficiency {} {:.0f} % {} {} ranks.\n", limit == ranks ? "stays above" : "falls below",
             100.0 * enough, limit == ranks ? "up to" : "beyond", limit);
}

// For a tile [s].
double mean_cost(const MapSample& sample) {
  double seconds = 0.0;
  for (const TileCost& each : sample.costs) seconds += each.seconds;
  return seconds / static_cast<double>(sample.costs.size());
}

}  // namespace

void print_rank_table(const Grid& grid, const MapSample& sample, int ranks, int threads, double start_seconds,
                      std::ostream& out) {
  if (static_cast<std::int64_t>(ranks) * threads > most_threads)
    throw StudyError(rules::wrong_option,
                     "--simulate-ranks {} with --threads {}: at most {} threads in total can be replayed",
                     ranks, threads, most_threads);
  const double share = static_cast<double>(grid.points()) / static_cast<double>(sample.points);
  const RankCosts costs{.tiles = costs_of_all(sample.costs, grid.tiles()),
                        .start = start_seconds,
                        .assembly = sample.encoding_seconds * share,
                        .processors = engine::default_threads()};
  fmt::print(out,
             "\nOn ranks of {} thread{} each, by a replay of how tiles are given out, with the cost of {} "
             "sampled tiles ({:.3g} ms each on average),\n{:.0f} us per request at rank 0, {:.0f} ms to its "
             "answer, assembly at {:.0f} MB/s per core by the ranks on rank 0's machine,\nwhich has as many "
             "processors as this one, on {} of them:\n",
             threads, threads == 1 ? "" : "s", sample.costs.size(), 1e3 * mean_cost(sample),
             1e6 * costs.service, 1e3 * costs.answer,
             1e-6 * static_cast<double>(sample.raw_bytes) / sample.encoding_seconds,
             assembling_threads(costs.processors, ranks, threads));
  fmt::print(out, "{:>7}{:>9}{:>16}{:>12}{:>10}{:>11}{:>11}{:>11}{:>11}\n", "ranks", "cores", "wall time",
             "efficiency", "of tiles", "start", "waiting", "end", "assembly");
  for (std::int64_t row = 1; row < ranks; row *= 10) print_row(costs, static_cast<int>(row), threads, out);
  print_row(costs, ranks, threads, out);
  fmt::print(out,
             "efficiency: time computing tiles / (wall time x cores); of tiles: the same until the last tile "
             "is done; then what is lost\nto the start, to waiting for rank 0, to lack of tiles at the end, "
             "and to the assembly on the machine of rank 0.\n");
  print_limit(costs, ranks, threads, out);
}

}  // namespace frahm::studies
