#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "solvers/response/gradient_check.hpp"
#include "solvers/transient/forced_motion.hpp"
#include "solvers/transient/free_decay.hpp"
#include "solvers/tuning/variance/variance.hpp"
#include "tests/known_answers/responses.hpp"

// A system whose second mass is counted after a gear, q = ratio x the coordinate, in every solver: it moves
// as it did, only counted otherwise.
namespace frahm::periodic::geared_test {
namespace {

using namespace mechanics;

constexpr double kRatio = -3.25;
const Node ground{}, first{NodeKind::mass, 0}, second{NodeKind::mass, 1}, base{NodeKind::prescribed, 0};

// Order of the elements: spring, damper; link, its damper and friction; an inerter. All stand on `support`.
Network plain(const Node& support, ForceLaw law = ForceLaw::exact) {
  return {.masses = {"main", "wheel"},
          .prescribed = {"base"},
          .elements = {{"spring", ElementType::spring, support, first},
                       {"damper", ElementType::damper, support, first},
                       {"link", ElementType::spring, first, second},
                       {"oil", ElementType::damper, first, second},
                       {"rub", ElementType::coulomb, first, second, law},
                       {"inerter", ElementType::inerter, support, second}},
          .excitations = {{ExcitationKind::force, 0, 1}, {ExcitationKind::motion, 0, 1}}};
}

NetworkValues plain_values(double omega, double friction, double slope = 0.0) {
  return {.omega = omega,
          .mass = {1.0, 0.3},
          .element = {1.0, 0.05, 0.4, 0.03, friction, 0.1},
          .excitation = {{1.0, 0.2}, {0.3, 0.0}},
          .second = std::vector<double>(6, 0.0),
          .smooth = {{}, {}, {}, {}, {.slope = slope}, {}}};
}

Network geared(Network network) {
  for (Element& element : network.elements) {
    for (auto& [node, factor] : element.along) {
      if (node == second) factor *= kRatio;
    }
  }
  return network;
}

NetworkValues geared_values(NetworkValues values) {
  values.mass[1] *= kRatio * kRatio;
  return values;
}

TEST_CASE("a free decay of a geared mass is that of the mass") {
  constexpr double kSame = 1e-11;
  transient::InitialState initial{{1.0, -0.5}, {0.0, 0.4}}, counted = initial;
  counted.displacement[1] /= kRatio;
  counted.velocity[1] /= kRatio;
  const auto expected = transient::free_decay(plain(ground), plain_values(1.0, 0.04), initial, {});
  const auto found =
      transient::free_decay(geared(plain(ground)), geared_values(plain_values(1.0, 0.04)), counted, {});
  CHECK_THAT(found.energy.dissipated[4], Catch::WithinRel(expected.energy.dissipated[4], kSame));
  for (std::size_t mass : {0, 1}) {
    const double ratio = mass == 0 ? 1.0 : kRatio;
    REQUIRE(found.masses[mass].extrema.size() == expected.masses[mass].extrema.size());
    for (std::size_t i = 0; i < std::min<std::size_t>(20, found.masses[mass].extrema.size()); ++i) {
      CHECK_THAT(ratio * found.masses[mass].extrema[i].displacement,
                 Catch::WithinAbs(expected.masses[mass].extrema[i].displacement, kSame));
    }
  }
}

TEST_CASE("a forced motion of a geared mass is that of the mass") {
  constexpr double kSame = 1e-11;
  transient::ForcedOptions options;
  options.from = 0.8;
  options.duration = 60.0;
  const auto run = [&](const Network& network, const NetworkValues& values) {
    return transient::forced_motion(
        network, [&](double) { return values; }, {}, options);
  };
  const auto expected = run(plain(ground), plain_values(0.8, 0.2));
  const auto found = run(geared(plain(ground)), geared_values(plain_values(0.8, 0.2)));
  REQUIRE(found.stops[0].size() == expected.stops[0].size());
  CHECK_THAT(found.peaks[0].displacement, Catch::WithinRel(expected.peaks[0].displacement, kSame));
  CHECK_THAT(kRatio * found.peaks[1].displacement, Catch::WithinRel(expected.peaks[1].displacement, kSame));
  CHECK_THAT(found.energy.input, Catch::WithinRel(expected.energy.input, kSame));
}

TEST_CASE("under the arctan law a geared mass moves as the mass") {
  constexpr double kSame = 1e-6;  // two integrations
  Responses smooth(plain(ground, ForceLaw::arctan)), turned(geared(plain(ground, ForceLaw::arctan)));
  const NetworkValues values = plain_values(0.9, 0.15, 1e3);
  REQUIRE(smooth.solve(values).status == Status::ok);
  REQUIRE(turned.solve(geared_values(values)).status == Status::ok);
  CHECK_THAT(turned["main_peak"], Catch::WithinRel(smooth["main_peak"], kSame));
  CHECK_THAT(turned["wheel_peak"], Catch::WithinRel(smooth["wheel_peak"] / -kRatio, kSame));
  CHECK_THAT(turned["rub_energy"], Catch::WithinRel(smooth["rub_energy"], kSame));
}

TEST_CASE("under white noise of a force or of its support a geared mass moves as the mass") {
  constexpr double kSame = 1e-11;
  for (const auto kind : {tuning::NoiseKind::force_on, tuning::NoiseKind::acceleration_of}) {
    for (const auto& measure : {tuning::NoisyQuantity{tuning::NoisyKind::displacement, 1},
                                tuning::NoisyQuantity{tuning::NoisyKind::stroke, 2}}) {
      Network network = plain(base);
      network.elements.erase(network.elements.begin() + 4);
      NetworkValues values = plain_values(1.0, 0.0);
      values.element.erase(values.element.begin() + 4);
      values.second.clear();
      const tuning::Noise noise{kind, 0, 0.7};
      // By the inertance and by the second mass, which is ratio^2 times as large after the gear.
      NetworkValues by_inertance = values, by_mass;
      for (double& value : by_inertance.mass) value = 0.0;
      for (double& value : by_inertance.element) value = 0.0;
      by_mass = by_inertance;
      by_inertance.element[4] = 1.0;
      by_mass.mass[1] = 1.0;
      std::vector<double> expected_slopes(2), slopes(2);
      const double expected = tuning::Variance(network, noise, measure)
                                  .mean_square(values, {by_inertance, by_mass}, expected_slopes);
      by_mass.mass[1] = kRatio * kRatio;
      const double found = tuning::Variance(geared(network), noise, measure)
                               .mean_square(geared_values(values), {by_inertance, by_mass}, slopes);
      const double scale = measure.kind == tuning::NoisyKind::stroke ? 1.0 : 1.0 / (kRatio * kRatio);
      INFO("noise " << static_cast<int>(kind) << ", quantity " << static_cast<int>(measure.kind));
      CHECK_THAT(found, Catch::WithinRel(scale * expected, kSame));
      for (std::size_t d : {0, 1}) CHECK_THAT(slopes[d], Catch::WithinRel(scale * expected_slopes[d], 1e-9));
    }
  }
}

// With the inerter along a way of its own, so that the supports feel its inertia; the support moves too.
TEST_CASE("derivatives with levers in the network are those of differences") {
  Network network = geared(plain(ground));
  network.elements[5].along = {{first, 0.6}, {second, 0.8}, {base, -0.3}};
  network.elements.emplace_back("strut", ElementType::spring,
                                Direction{{first, 1.0}, {base, -0.5}, {ground, -0.5}});
  NetworkValues values = geared_values(plain_values(0.9, 0.12));
  values.element.push_back(0.7);
  values.second.push_back(0.0);
  std::vector<Quantity> quantities;
  for (const char* name : {"main_peak", "wheel_peak", "link_stroke", "rub_force_peak", "transmitted_force",
                           "base_transmitted_force", "force_transmissibility", "energy_input"})
    quantities.push_back(*find_quantity(name, network));
  std::vector<CheckedParameter> parameters;
  NetworkValues none = values;
  none.omega = 0.0;
  for (double& value : none.mass) value = 0.0;
  for (double& value : none.element) value = 0.0;
  for (auto& value : none.excitation) value = {};
  for (const std::size_t e : {2, 4, 5, 6}) {
    CheckedParameter by{.value = values.element[e], .direction = none};
    by.direction.element[e] = 1.0;
    by.values_at = [values, e](double value) {
      NetworkValues changed = values;
      changed.element[e] = value;
      return changed;
    };
    parameters.push_back(std::move(by));
  }
  CheckedParameter by_mass{.value = values.mass[1], .direction = none};
  by_mass.direction.mass[1] = 1.0;
  by_mass.values_at = [values](double value) {
    NetworkValues changed = values;
    changed.mass[1] = value;
    return changed;
  };
  parameters.push_back(std::move(by_mass));
  const GradientCheck check = check_gradient(network, quantities, values, parameters);
  REQUIRE(check.reason.empty());
  constexpr double kOfDifferences = 1e-6;
  for (const auto& column : check.columns) {
    for (std::size_t q = 0; q < column.size(); ++q) {
      INFO(describe(quantities[q], network, false).name << ": " << column[q].exact << ", "
                                                        << column[q].difference);
      CHECK(column[q].relative_difference() < kOfDifferences);
    }
  }
}

}  // namespace
}  // namespace frahm::periodic::geared_test
