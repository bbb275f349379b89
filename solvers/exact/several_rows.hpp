#pragma once

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "solvers/exact/sized_solver.hpp"
#include "solvers/mechanics/halfway.hpp"

// Bodies of SizedSolver: the rows of systems that may have several responses.
namespace frahm::periodic {

// Empty, or why they cannot be set.
template <int N, int H>
std::string SizedSolver<N, H>::set(const mechanics::NetworkValues& values) {
  try {
    if (is_set_ && have_same_elements(values, values_)) {
      set_forcing(values);
    } else {
      set_values(values);
    }
  } catch (const mechanics::MechanicsError& error) {
    return error.what();
  }
  return "";
}

// There, each point from the starts and from the responses of the point before; and back, each from those of
// the point after.
template <int N, int H>
void SizedSolver<N, H>::search_row(std::span<const mechanics::NetworkValues> points,
                                   std::span<ResponseSummary> found, std::span<double> out) {
  const std::size_t quantities = points.empty() ? 0 : out.size() / points.size();
  const auto record = [&](std::size_t i, const ResponseSummary& summary) {
    found[i] = summary;
    this->quantities(out.subspan(i * quantities, quantities));
  };
  std::vector<StableOrbits<N, H>> orbits;
  std::vector<std::size_t> searched;  // their points
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (found[i].status != Status::not_computed) continue;
    found[i].reason = set(points[i]);
    if (!found[i].reason.empty()) continue;
    if (OrbitSearch<N, H>::serves(assembly_, system_, undamped_modes_)) {
      search_.begin_row();
      record(i, solve());
      continue;
    }
    const LimitedSearch limit(flow_.work());
    orbits.push_back(coexistence_.find(system_, orbits.empty() ? nullptr : &orbits.back()));
    searched.push_back(i);
  }
  for (std::size_t k = searched.size(); k-- > 0;) {
    set(points[searched[k]]);
    const LimitedSearch limit(flow_.work());
    if (k + 1 < searched.size()) coexistence_.add(system_, orbits[k + 1], orbits[k]);
    keep_balanced(orbits[k]);
    coexistence_.tell(system_, orbits[k], orbit_);
    record(searched[k], conclude());
  }
}

// A sweep begins at rest, at one end of the row.
template <int N, int H>
void SizedSolver<N, H>::slow_sweep_row(std::span<const mechanics::NetworkValues> points,
                                       std::span<ResponseSummary> found, std::span<double> out) {
  const std::size_t quantities = points.empty() ? 0 : out.size() / points.size();
  slow_sweep_.begin();
  for (const std::size_t i : in_order_of_slow_sweep(points)) {
    found[i].reason = set(points[i]);
    if (!found[i].reason.empty()) continue;
    found[i] = solve();
    this->quantities(out.subspan(i * quantities, quantities));
  }
}

template <int N, int H>
std::vector<std::size_t> SizedSolver<N, H>::in_order_of_slow_sweep(
    std::span<const mechanics::NetworkValues> points) const {
  const double sign = wanted_.show == OrbitsWanted::Show::down ? -1.0 : 1.0;
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return sign * points[i].omega; });
  return order;
}

// From the values at which the sweep is to those that are set.
template <int N, int H>
void SizedSolver<N, H>::slow_sweep_on() {
  constexpr int kHalvings = 10;  // an orbit that ends does so within a thousandth of the step
  const mechanics::NetworkValues here = values_;
  if (OrbitSearch<N, H>::serves(assembly_, system_, undamped_modes_)) {
    search_.begin_row();
    search_.find(system_, undamped_modes_, true, orbit_);
    if (orbit_.is_found()) slow_sweep_.stand_on(orbit_);
  } else {
    const bool stays = slow_sweep_.is_on_orbit() && goes_on(swept_, here, kHalvings);
    if (!stays) {
      set(here);
      slow_sweep_.follow(system_);
    }
    slow_sweep_.tell(system_, orbit_);
  }
  swept_ = here;
}

// Whether the orbit goes on from some values to others: in one step or in two of half the length. The values
// are then set.
template <int N, int H>
bool SizedSolver<N, H>::goes_on(const mechanics::NetworkValues& from, const mechanics::NetworkValues& to,
                                int halvings) {
  if (!set(to).empty()) return false;
  if (slow_sweep_.go_on(system_)) return true;
  if (halvings == 0) return false;
  const mechanics::NetworkValues middle = mechanics::halfway(from, to);
  return goes_on(from, middle, halvings - 1) && goes_on(middle, to, halvings - 1);
}

}  // namespace frahm::periodic
