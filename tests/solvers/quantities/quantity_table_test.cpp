#include "solvers/quantities/quantity_table.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "solvers/orbits/orbit.hpp"

namespace quantity_table_test {
// The one table of quantities, against the page of the format and against itself.
namespace {

using namespace frahm::periodic;
using namespace frahm::mechanics;

// As the page of the format writes a quantity of any owner.
std::string name_on_page(const QuantityRow& row) {
  const std::string suffix = row.suffix;
  switch (row.owner) {
    case Owner::mass:
      return "`<node>_" + suffix + "`";
    case Owner::element:
    case Owner::contact:
    case Owner::sliders:
      return "`<element>_" + suffix + "`";
    case Owner::mode:
      return "`" + suffix + "_<k>`";
    case Owner::support:
    case Owner::point:
    case Owner::structure:
    case Owner::coexistence:
    case Owner::offsets:
      break;
  }
  return "`" + suffix + "`";
}

std::vector<std::string> rows_of_page() {
  std::ifstream page(FRAHM_SOURCE_DIR "/results/FORMAT.md");
  std::vector<std::string> rows;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("| `")) rows.push_back(line);
  }
  return rows;
}

// A mass on spring, damper and friction.
Network oscillator() {
  Network network;
  const frahm::mechanics::Node ground{NodeKind::ground, 0}, mass{NodeKind::mass, 0};
  network.masses = {"main"};
  network.elements = {{"spring", ElementType::spring, ground, mass},
                      {"damper", ElementType::damper, ground, mass},
                      {"friction", ElementType::coulomb, ground, mass}};
  return network;
}

}  // namespace

TEST_CASE("Every quantity stands on the page of the format, with its type, unit and flags") {
  const std::vector<std::string> page = rows_of_page();
  for (const QuantityRow& row : quantity_table()) {
    const std::string name = name_on_page(row);
    INFO(name);
    const auto line = std::find_if(page.begin(), page.end(), [&](const std::string& each) {
      return each.find(name) != std::string::npos;
    });
    REQUIRE(line != page.end());
    const char* type = row.kind == QuantityKind::real    ? "| float |"
                       : row.kind == QuantityKind::count ? "| int32 |"
                                                         : "| flag |";
    CHECK(line->find(type) != std::string::npos);
    if (row.kind != QuantityKind::flag) CHECK(line->find(row.unit) != std::string::npos);
    for (const FlagMeaning& flag : row.flags)
      CHECK(line->find(std::to_string(flag.value) + " `" + flag.meaning + "`") != std::string::npos);
  }
}

TEST_CASE("What stands for a quantity that is not computed") {
  CHECK(std::isnan(missing_value(Measure::peak, Status::failed)));
  CHECK(missing_value(Measure::stops, Status::failed) == -1.0);
  CHECK(missing_value(Measure::regime, Status::failed) == 0.0);
  CHECK(missing_value(Measure::status, Status::failed) == static_cast<double>(Status::failed));
  CHECK(is_missing(QuantityKind::count, -1.0));
  CHECK_FALSE(is_missing(QuantityKind::count, 0.0));
}

TEST_CASE("Over several periods energies and counts add up, and nothing else does") {
  for (const QuantityRow& row : quantity_table()) {
    INFO(row.suffix);
    const bool is_of_search = row.owner == Owner::coexistence || row.measure == Measure::newton_iterations;
    const bool counts_sliders = row.owner == Owner::sliders || row.owner == Owner::offsets;
    const bool counts_events = row.kind == QuantityKind::count && !is_of_search && !counts_sliders;
    const bool adds_up = std::string(row.unit) == "J" || counts_events;
    CHECK(is_of_a_period(row.measure) == adds_up);
  }
}

TEST_CASE("The standard record of an oscillator with friction") {
  const Network network = oscillator();
  std::vector<std::string> names, shown;
  for (const Quantity& quantity : standard_quantities(network))
    names.push_back(describe(quantity, network, false).name);
  for (const Quantity& quantity : all_quantities(network)) {
    if (is_shown(quantity, network)) shown.push_back(describe(quantity, network, false).name);
  }
  CHECK(names == std::vector<std::string>{"main_peak", "main_amplitude", "main_mean", "main_rms",
                                          "main_phase", "spring_stroke", "friction_stops",
                                          "friction_stuck_fraction", "friction_regime", "friction_energy",
                                          "status", "floquet_radius", "energy_balance", "residual",
                                          "error_bound", "transmitted_force"});
  CHECK(shown == std::vector<std::string>{"main_peak", "spring_stroke", "damper_energy_share",
                                          "friction_energy_share", "friction_stops", "friction_regime",
                                          "status"});
}

TEST_CASE("By its name alone a quantity is shown where any of its kind is") {
  CHECK(is_shown("main_peak"));
  CHECK(is_shown("any_stroke"));
  CHECK(is_shown("status"));
  CHECK_FALSE(is_shown("main_velocity_peak"));
  CHECK_FALSE(is_shown("guide_force_peak"));
  CHECK_FALSE(is_shown("status_compared"));
  CHECK_FALSE(is_shown("residual"));
}
}  // namespace quantity_table_test
