#include "solvers/flow/search_work.hpp"

#include <catch2/catch.hpp>
#include <utility>

#include "solvers/exact/coexistence.hpp"
#include "solvers/exact/orbit_search.hpp"
#include "solvers/laws/elastic_stop.hpp"
#include "tests/known_answers/rig.hpp"
#include "tests/known_answers/single_mass.hpp"

// The work that a search may take.
namespace frahm::periodic::search_work_test {
namespace {

// One mass with friction near its resonance, whose orbit takes several passages.
struct Search {
  Search() {
    assembly.set_values(single_mass_values(0.99, 1e-3, 0.3), system);
    assembly.set_forcing(single_mass_values(0.99, 1e-3, 0.3), system);
    flow.set_system(system);
    flow.set_forcing(system);
  }
  const Orbit<1, 1>& find(double most_steps) {
    const LimitedSearch limit(flow.work(), most_steps * flow.step_work());
    search.forget();
    search.find(system, {}, false, orbit);
    return orbit;
  }

  mechanics::Assembly assembly{single_mass()};
  mechanics::LinearSystem system;
  Flow<1, 1> flow;
  OrbitSearch<1, 1> search{assembly, flow};
  Orbit<1, 1> orbit;
};

TEST_CASE(
    "A search that takes more work than it may fails with that reason, each time after as many passages") {
  Search search;
  const Orbit<1, 1> first = search.find(100.0);
  CHECK(first.status == Status::failed);
  CHECK(first.reason == kSearchIsLong);
  CHECK(first.passages > 0);
  CHECK(search.find(100.0).passages == first.passages);
}

TEST_CASE("A search has the work of its own, whatever those before it took, and after it there is no limit") {
  Search search;
  for (int point = 0; point < 100; ++point) CHECK(search.find(20'000.0).is_found());
  search.flow.work().add(1e300);
  CHECK(!search.flow.work().is_over());
  CHECK(search.find(20'000.0).is_found());
}

TEST_CASE("More masses and contacts make a step and an event more work") {
  const Search one;
  const mechanics::Assembly assembly(rig());
  mechanics::LinearSystem system;
  assembly.set_values(rig_values(20.0, 6.36, 0.1), system);
  assembly.set_forcing(rig_values(20.0, 6.36, 0.1), system);
  Flow<2, 1> two;
  two.set_system(system);
  two.set_forcing(system);
  CHECK(two.step_work() > one.flow.step_work());
  CHECK(two.event_work() > one.flow.event_work());
  CHECK(one.flow.event_work() > one.flow.step_work());
}

// The orbits of a mass between stops, zeta = 0.05, at a frequency at which two are stable.
std::pair<StableOrbits<1, 1>, Orbit<1, 1>> orbits_between_stops(double most_steps) {
  mechanics::Network network = single_mass();
  network.elements[2] = {"stops", mechanics::ElementType::gap, {}, {mechanics::NodeKind::mass, 0}};
  network.elements[2].bends = {{1.0, &laws::elastic_stop}, {-1.0, &laws::elastic_stop}};
  mechanics::NetworkValues values = single_mass_values(1.7, 0.05, 4.0);
  values.second = {0.0, 0.0, 0.0};
  values.bends = {{}, {}, {{1.0, 4.0, 0.0}, {1.0, 4.0, 0.0}}};
  const mechanics::Assembly assembly(network);
  mechanics::LinearSystem system;
  assembly.set_values(values, system);
  assembly.set_forcing(values, system);
  Flow<1, 1> flow;
  flow.set_system(system);
  flow.set_forcing(system);
  const LimitedSearch limit(flow.work(), most_steps * flow.step_work());
  Coexistence<1, 1> search(assembly, flow);
  std::pair<StableOrbits<1, 1>, Orbit<1, 1>> result;
  result.first = search.find(system, nullptr);
  search.tell(system, result.first, result.second);
  return result;
}

TEST_CASE("A search for several orbits that is ended tells those it found, or why it has none") {
  const auto [all, largest] = orbits_between_stops(kInfinity);
  CHECK(all.stable.size() == 2);
  CHECK(all.failure == nullptr);
  CHECK(largest.status == Status::several);

  const auto [some, one_of_them] = orbits_between_stops(1000.0);
  CHECK(some.stable.size() == 1);
  CHECK_THAT(some.failure, Catch::Equals(kSearchIsLong));
  CHECK(one_of_them.is_found());

  const auto [none, no_orbit] = orbits_between_stops(10.0);
  CHECK(none.stable.empty());
  CHECK(no_orbit.status == Status::failed);
  CHECK(no_orbit.reason == kSearchIsLong);
}

}  // namespace
}  // namespace frahm::periodic::search_work_test
