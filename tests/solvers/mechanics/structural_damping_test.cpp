#include "solvers/mechanics/structural_damping.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "solvers/mechanics/modes.hpp"
#include "solvers/response/periodic_response.hpp"
#include "solvers/transient/forced_motion.hpp"
#include "solvers/transient/free_decay.hpp"
#include "tests/solvers/gradient_parameters.hpp"
#include "tests/solvers/nonstop/two_ways.hpp"

// Damping of the structure: [damping] modal and rayleigh.
namespace frahm::mechanics::structural_damping_test {
namespace {

using periodic::Measure;
using periodic::PeriodicResponse;
using periodic::Quantity;

constexpr double kRounding = 1e-12;

const Node ground{};
Node mass(std::size_t i) {
  return {NodeKind::mass, i};
}
const Node base{NodeKind::prescribed, 0};

// n masses of 1 to 2 kg on springs from `foot`, with contacts at some storeys, driven by a force on the last
// mass or by the foot.
Network chain(std::size_t n, const Node& foot, std::vector<std::size_t> contacts) {
  Network network;
  for (std::size_t i = 0; i < n; ++i) {
    network.masses.push_back("m" + std::to_string(i));
    const Node below = i == 0 ? foot : mass(i - 1);
    network.elements.push_back({"k" + std::to_string(i), ElementType::spring, below, mass(i)});
  }
  for (const std::size_t i : contacts) {
    const Node below = i == 0 ? foot : mass(i - 1);
    network.elements.push_back({"f" + std::to_string(i), ElementType::coulomb, below, mass(i)});
  }
  if (foot == base) {
    network.prescribed = {"base"};
    network.excitations = {{ExcitationKind::motion, 0, 1}};
  } else {
    network.excitations = {{ExcitationKind::force, n - 1, 1}};
  }
  return network;
}

NetworkValues chain_values(const Network& network, double friction) {
  NetworkValues values{.omega = 1.3, .mass = {}, .element = {}, .excitation = {{1.0, 0.2}}};
  for (std::size_t i = 0; i < network.masses.size(); ++i)
    values.mass.push_back(1.0 + 0.5 * (1.0 + std::sin(3.0 * double(i))));
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    const bool is_spring = network.elements[e].type == ElementType::spring;
    values.element.push_back(is_spring ? 20.0 + 3.0 * std::cos(2.0 * double(e)) : friction);
  }
  return values;
}

std::vector<double> quantities_of(const Network& network, const NetworkValues& values,
                                  const std::vector<Quantity>& quantities, bool by_shooting) {
  using periodic::Path;
  PeriodicResponse response(network, quantities, by_shooting ? Path::general : Path::fastest);
  std::vector<double> out(quantities.size());
  if (by_shooting) {
    response.set_values(values);
    response.solve();
    response.quantities(out);
    return out;
  }
  std::vector<periodic::ResponseSummary> found(1);
  response.solve_row(std::span(&values, 1), found, out);
  return out;
}

struct DampedChain {
  Network network;
  NetworkValues values;
  LinearSystem system;

  DampedChain(std::size_t n, const Node& foot, DampingModel model, const std::vector<double>& damping)
      : network(chain(n, foot, {})), values(chain_values(network, 0.0)) {
    network.damping = model;
    values.damping = damping;
    Assembly(network).set_values(values, system);
  }
};

TEST_CASE("Modal damping comes back as the damping ratio of each mode, uniform or from a list") {
  for (const std::vector<double>& ratios :
       {std::vector{0.02}, std::vector{0.01, 0.05, 0.03},
        std::vector{0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 0.08, 0.09, 0.1, 0.11, 0.12}}) {
    const DampedChain storeys(12, ground, DampingModel::modal, ratios);
    std::vector<double> frequency, damping;
    periodic::modes_of(storeys.system, frequency, damping);
    for (std::size_t i = 0; i < 12; ++i)
      CHECK(std::abs(damping[i] - ratios[std::min(i, ratios.size() - 1)]) < kRounding);
  }
}

TEST_CASE("Rayleigh damping gives each mode the ratio a / (2 omega) + b omega / 2") {
  const DampedChain storeys(12, ground, DampingModel::rayleigh, {0.03, 0.004});
  std::vector<double> frequency, damping;
  periodic::modes_of(storeys.system, frequency, damping);
  for (std::size_t i = 0; i < 12; ++i)
    CHECK(std::abs(damping[i] - (0.015 / frequency[i] + 0.002 * frequency[i])) < kRounding);
}

// One mass on a spring from `foot` with friction to it; the damper is an element or the structure's.
struct OneMass {
  Network with_damper, with_modal;
  NetworkValues damper_values, modal_values;

  OneMass(const Node& foot, double friction, double zeta) {
    with_modal = chain(1, foot, {0});
    modal_values = chain_values(with_modal, friction);
    with_modal.damping = DampingModel::modal;
    modal_values.damping = {zeta};
    with_damper = chain(1, foot, {0});
    damper_values = chain_values(with_damper, friction);
    with_damper.elements.push_back({"damper", ElementType::damper, foot, mass(0)});
    damper_values.element.push_back(2.0 * zeta * std::sqrt(damper_values.element[0] * damper_values.mass[0]));
  }
};

TEST_CASE("One mass with modal damping moves as with a damper of c = 2 zeta sqrt(k m), in every quantity") {
  const auto by_shooting = GENERATE(true, false);
  const auto foot = GENERATE(ground, base);
  const auto friction = GENERATE(0.0, 0.3, 0.9);
  const OneMass one(foot, friction, 0.07);
  const auto quantities = periodic::all_quantities(one.with_modal);
  std::vector<Quantity> of_damper = quantities;
  for (Quantity& quantity : of_damper) {
    if (quantity.measure == Measure::damping_energy) quantity = {Measure::energy, 2};
    if (quantity.measure == Measure::damping_energy_share) quantity = {Measure::energy_share, 2};
  }
  const auto a = quantities_of(one.with_damper, one.damper_values, of_damper, by_shooting);
  const auto b = quantities_of(one.with_modal, one.modal_values, quantities, by_shooting);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (quantities[i].measure == Measure::energy_balance) CHECK(b[i] < kRounding);
    if (periodic::is_of_computation(quantities[i].measure)) continue;
    INFO(periodic::describe(quantities[i], one.with_modal, false).name << " " << a[i] << " " << b[i]
                                                                       << " friction " << friction);
    CHECK(periodic::difference(i, of_damper, a, b) < kRounding);
  }
}

TEST_CASE(
    "Work in is energy lost with damping of the structure, sticking or not, with a moving base or not") {
  const auto by_shooting = GENERATE(true, false);
  const auto model = GENERATE(DampingModel::modal, DampingModel::rayleigh);
  const auto foot = GENERATE(ground, base);
  const auto friction = GENERATE(0.05, 1.2);
  Network network = chain(6, foot, {0, 3});
  network.damping = model;
  NetworkValues values = chain_values(network, friction);
  values.damping = {0.03, 0.05};
  const std::vector<Quantity> quantities{{Measure::energy_balance, 0}, {Measure::damping_energy, 0},
                                         {Measure::energy_input, 0},   {Measure::energy, 6},
                                         {Measure::energy, 7},         {Measure::damping_energy_share, 0}};
  const auto out = quantities_of(network, values, quantities, by_shooting);
  CHECK(out[0] < kRounding);
  CHECK(out[1] > 0.01 * out[2]);
  CHECK(std::abs(out[1] + out[3] + out[4] - out[2]) < kRounding * out[2]);
  CHECK(std::abs(out[5] - out[1] / out[2]) < kRounding);
}

TEST_CASE("A structure that moves with its base as a rigid body is not damped by its modal damping") {
  // All springs lead to the base: C 1 + C_support = 0, and nothing of a common motion is lost.
  const DampedChain storeys(5, base, DampingModel::modal, {0.04, 0.02});
  const LinearSystem& system = storeys.system;
  const double scale = system.C.cwiseAbs().maxCoeff();
  CHECK((system.C.rowwise().sum() + system.C_support.col(0)).cwiseAbs().maxCoeff() < kRounding * scale);
  Eigen::VectorXd together = Eigen::VectorXd::Ones(7);
  together[5] = 0.0;  // the ground, to which nothing leads
  CHECK((system.structural_damping * together).cwiseAbs().maxCoeff() < kRounding * scale);
}

TEST_CASE("Modes of one frequency may have one ratio, but not two") {
  Network network{.masses = {"a", "b"},
                  .elements = {{"ka", ElementType::spring, ground, mass(0)},
                               {"kb", ElementType::spring, ground, mass(1)}},
                  .excitations = {{ExcitationKind::force, 0, 1}},
                  .damping = DampingModel::modal};
  NetworkValues values{.omega = 1.0, .mass = {1.0, 1.0}, .element = {4.0, 4.0}, .excitation = {{1.0, 0.0}}};
  values.damping = {0.05};
  LinearSystem system;
  Assembly(network).set_values(values, system);
  CHECK(std::abs(system.C(0, 0) - 0.2) < kRounding);
  values.damping = {0.05, 0.04};
  CHECK_THROWS_WITH(
      Assembly(network).set_values(values, system),
      Catch::Contains("modes 1 and 2 have the same frequency") && Catch::Contains("0.05 and 0.04"));
}

TEST_CASE("The arctan law too keeps the balance with damping of the structure") {
  Network network = chain(2, base, {0});
  network.elements.back().law = ForceLaw::arctan;
  network.damping = DampingModel::modal;
  NetworkValues values = chain_values(network, 0.5);
  values.smooth.assign(3, {.slope = 200.0});
  values.damping = {0.05, 0.03};
  const auto out = quantities_of(network, values,
                                 {{Measure::energy_balance, 0}, {Measure::damping_energy_share, 0}}, true);
  CHECK(out[0] < 1e-7);  // the integrator's error
  CHECK(out[1] > 0.01);
}

TEST_CASE("A decay and a transient account for what the structure dissipates") {
  const OneMass one(ground, 0.0, 0.07);
  const transient::InitialState start{.displacement = {0.3}, .velocity = {0.1}};
  const auto a = transient::free_decay(one.with_damper, one.damper_values, start, {.duration = 4.0});
  const auto b = transient::free_decay(one.with_modal, one.modal_values, start, {.duration = 4.0});
  CHECK(b.energy.balance < kRounding);
  CHECK(std::abs(b.energy.dissipated.back() - a.energy.dissipated.back()) < kRounding * a.energy.initial);
  CHECK(b.energy.share.back() == Approx(1.0).epsilon(kRounding));

  Network shaken = chain(4, base, {1});
  shaken.damping = DampingModel::rayleigh;
  NetworkValues values = chain_values(shaken, 0.4);
  values.damping = {0.05, 0.01};
  transient::InitialState still;
  still.displacement.assign(4, 0.1);
  still.velocity.assign(4, 0.0);
  const auto motion = transient::forced_motion(shaken, [&](double) { return values; }, still,
                                               {.from = values.omega, .duration = 20.0, .samples = 11});
  CHECK(motion.energy.balance < 1e-11);
  CHECK(motion.energy.dissipated.back() > 0.1 * motion.energy.input);
}

}  // namespace
}  // namespace frahm::mechanics::structural_damping_test
