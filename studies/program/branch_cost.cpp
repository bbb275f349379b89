#include "studies/program/branch_cost.hpp"

#include <fmt/ostream.h>

#include <chrono>

#include "engine/progress.hpp"
#include "engine/team.hpp"
#include "studies/map/branch_rows.hpp"

namespace frahm::studies {
namespace {

using Clock = std::chrono::steady_clock;

struct OutOfTime {};

// Some of the points of the row: a run searches only where the map has more orbits than the branches.
std::vector<periodic::SearchedPlace> some_places(const RowBranches& branches) {
  constexpr std::size_t enough = 8;
  const std::vector<periodic::SearchedPlace> all = branches.places();
  std::vector<periodic::SearchedPlace> some;
  for (std::size_t i = 0; i < all.size(); i += 1 + all.size() / enough) some.push_back(all[i]);
  return some;
}

}  // namespace

void print_branch_cost(const MapPlan& plan, const MapSample& sample, int threads, std::ostream& out) {
  if (!plan.study.sweep()->branches) return;
  constexpr std::chrono::seconds most(2);
  const auto rows = branch_rows(plan.study);
  if (rows.empty()) return fmt::print(out, "branches no row has the values of [output] branches: at\n");
  const RowBranches branches(plan);
  const Clock::time_point start = Clock::now();
  const auto watch = [&](const periodic::BranchPoint&) {
    if (Clock::now() - start > most) throw OutOfTime{};
  };
  const std::vector<periodic::SearchedPlace> places = some_places(branches);
  const char* about = "about";
  // The searches at these places, as many points of the map.
  double row_seconds =
      sample.seconds / static_cast<double>(sample.points) * static_cast<double>(places.size());
  if (row_seconds > std::chrono::duration<double>(most).count()) {
    about = "more than";
  } else {
    try {
      branches.follow(rows[rows.size() / 2], places, watch);
    } catch (const OutOfTime&) {
      about = "more than";
    }
    row_seconds = std::chrono::duration<double>(Clock::now() - start).count();
  }
  const int team = engine::team_size(threads, rows.size());
  const double seconds = row_seconds * static_cast<double>(rows.size()) / team;
  fmt::print(out, "branches through {} row{}, {} {} more\n", rows.size(), rows.size() == 1 ? "" : "s", about,
             seconds < 1.0 ? "a second" : engine::readable_time(seconds));
}

}  // namespace frahm::studies
