#include "solvers/laws/iwan.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "solvers/transient/forced_motion.hpp"
#include "solvers/transient/free_decay.hpp"
#include "tests/known_answers/responses.hpp"
#include "tests/solvers/gradient_parameters.hpp"

// Sliders side by side as one element next to a spring: x'' + 2 zeta x' + x + sum s_i = cos(r tau).
namespace frahm::periodic::iwan_test {
namespace {

using Catch::Matchers::WithinAbs, Catch::Matchers::WithinRel;
using namespace mechanics;
constexpr double kSame = 1e-12;     // of the same motion computed twice, relative
constexpr double kExact = 1e-10;    // of closed forms, relative
constexpr double kBalance = 1e-10;  // of the energy
constexpr double kGradient = 1e-6;  // of differences, extrapolated

const Node ground{}, mass{NodeKind::mass, 0};

struct Slider {
  double stiffness, force;
};
using Sliders = std::vector<Slider>;
const Sliders kListed = {{0.8, 0.2}, {0.5, 0.45}, {0.3, 0.6}, {0.2, 2.0}};

// together: one element; otherwise each is one.
Network jointed_mass(const Sliders& sliders, bool together) {
  Network network{.masses = {"x"},
                  .elements = {{"spring", ElementType::spring, ground, mass},
                               {"damper", ElementType::damper, ground, mass}},
                  .excitations = {{ExcitationKind::force, 0, 1}}};
  for (std::size_t i = 0; i < sliders.size(); ++i) {
    Element& added = network.elements.emplace_back(together ? "joint" : "slider" + std::to_string(i),
                                                   ElementType::jenkins, ground, mass);
    if (together) added.parts = i == 0 ? sliders.size() : 0;
  }
  return network;
}

NetworkValues jointed_values(double r, double zeta, const Sliders& sliders) {
  NetworkValues values{.omega = r,
                       .mass = {1.0},
                       .element = {1.0, 2.0 * zeta},
                       .excitation = {{1.0, 0.0}},
                       .second = {0.0, 0.0}};
  for (const auto& [stiffness, force] : sliders) {
    values.element.push_back(stiffness);
    values.second.push_back(force);
  }
  return values;
}

Sliders spread(int n, double chi, double K, double F) {
  Sliders sliders;
  for (const laws::IwanShare& share : laws::iwan_shares(n, chi))
    sliders.push_back({K * share.stiffness, F * share.force});
  return sliders;
}

TEST_CASE("An iwan element moves as its sliders do one by one, and sums their energies and forces") {
  const Network one_by_one = jointed_mass(kListed, false);
  Responses apart(one_by_one), together(jointed_mass(kListed, true));
  for (const double r : {0.5, 0.8, 1.1, 1.35, 1.7}) {
    INFO("r " << r);
    const NetworkValues values = jointed_values(r, 0.05, kListed);
    REQUIRE(apart.solve(values).status == Status::ok);
    REQUIRE(together.solve(values).status == Status::ok);
    for (const char* name : {"x_peak", "x_rms", "x_phase", "floquet_radius", "transmitted_force"})
      CHECK_THAT(together[name], WithinRel(apart[name], kSame));
    double energy = 0.0, share = 0.0;
    int slipping = 0;
    for (std::size_t i = 0; i < kListed.size(); ++i) {
      const std::string name = "slider" + std::to_string(i);
      energy += apart[name + "_energy"];
      share += apart[name + "_energy_share"];
      if (apart[name + "_stuck_fraction"] < 1.0) ++slipping;
    }
    CHECK_THAT(together["joint_energy"], WithinRel(energy, kSame) || WithinAbs(energy, kSame));
    CHECK_THAT(together["joint_energy_share"], WithinRel(share, kSame) || WithinAbs(share, kSame));
    CHECK(together["joint_slipping"] == slipping);
    CHECK(together["energy_balance"] < kBalance);
  }
}

// With one reversal at each end, X the amplitude: the loop takes sum 4 F_i (X - F_i/k_i) of those that slip,
// and by Masing's rule the force at its ends is sum min(k_i X, F_i).
TEST_CASE("A joint's loop takes what its sliders' loops take, and carries what they carry") {
  Responses response(jointed_mass(kListed, true));
  for (const double r : {0.9, 1.1, 1.35, 1.7}) {
    INFO("r " << r);
    response.solve(jointed_values(r, 0.05, kListed));
    const double X = response["x_peak"];
    double loss = 0.0, force = 0.0;
    int slipping = 0;
    for (const auto& [k, F] : kListed) {
      force += std::min(k * X, F);
      if (X > F / k) {
        loss += 4.0 * F * (X - F / k);
        ++slipping;
      }
    }
    CHECK_THAT(response["joint_energy"], WithinRel(loss, kExact));
    CHECK_THAT(response["joint_force_peak"], WithinRel(force, kExact));
    CHECK(response["joint_slipping"] == slipping);
  }
}

// For the density R phi^chi of stiffness over the slip displacement, R = K (chi+1)/phi_m^(chi+1) and phi_m =
// F (chi+2)/(K (chi+1)), a loop of amplitude X <= phi_m takes the integral of 4 R phi^(chi+1) (X - phi),
//   4 R X^(chi+3)/((chi+2)(chi+3)),   of an even spread K^2 X^3/(3 F),
// as Masing's rule gives of the parabola K u - K^2 u^2/(4 F).
TEST_CASE("A joint's loss comes to the closed form of its distribution as its sliders become more") {
  constexpr double K = 2.0, F = 3.0, kOfSpread = 1.5;  // the error is below this / n^2
  for (const double chi : {0.0, -0.5, 1.0}) {
    for (const int n : {1, 4, 8, 16, 32}) {
      const Sliders sliders = spread(n, chi, K, F);
      Responses response(jointed_mass(sliders, true));
      REQUIRE(response.solve(jointed_values(1.6, 0.05, sliders)).status == Status::ok);
      const double X = response["x_peak"];
      const double phi_m = F * (chi + 2.0) / (K * (chi + 1.0));
      const double R = K * (chi + 1.0) / std::pow(phi_m, chi + 1.0);
      INFO("chi " << chi << ", n " << n << ", X " << X << " of " << phi_m);
      REQUIRE(X < phi_m);
      const double closed = 4.0 * R * std::pow(X, chi + 3.0) / ((chi + 2.0) * (chi + 3.0));
      if (chi == 0.0) CHECK_THAT(closed, WithinRel(K * K * X * X * X / (3.0 * F), kExact));
      const double loss = n > 1 ? response["joint_energy"] : 0.0;
      const double whole = 4.0 * F * phi_m;  // of the largest loop's order
      if (n > 1) CHECK(std::abs(loss - closed) < kOfSpread * whole / (n * n));
      if (n == 32) CHECK(std::abs(loss - closed) < 0.02 * closed);
    }
  }
}

TEST_CASE("The sliders of a joint share its stiffness and its limit, and one alone has both") {
  for (const double chi : {0.0, -0.7, 2.0}) {
    double stiffness = 0.0, force = 0.0, last = 0.0;
    for (const auto& [of_stiffness, of_force] : laws::iwan_shares(9, chi)) {
      stiffness += of_stiffness;
      force += of_force;
      CHECK(of_force / of_stiffness > last);  // each slips later
      last = of_force / of_stiffness;
    }
    CHECK_THAT(stiffness, WithinRel(1.0, kSame));
    CHECK_THAT(force, WithinRel(1.0, kSame));
  }
  const auto alone = laws::iwan_shares(1, 0.3);
  REQUIRE(alone.size() == 1);
  CHECK(alone[0].stiffness == 1.0);
  CHECK(alone[0].force == 1.0);
  const auto even = laws::iwan_shares(4, 0.0);
  for (int i = 1; i <= 4; ++i) {
    CHECK_THAT(even[static_cast<std::size_t>(i - 1)].stiffness, WithinRel(0.25, kSame));
    CHECK_THAT(even[static_cast<std::size_t>(i - 1)].force, WithinRel((2.0 * i - 1.0) / 16.0, kSame));
  }
}

TEST_CASE("Derivatives of a joint's energy and force agree with differences") {
  const Network network = jointed_mass(kListed, true);
  const std::vector<Quantity> quantities = {
      {Measure::peak, 0}, {Measure::energy, 2}, {Measure::energy_share, 2}, {Measure::force_peak, 2}};
  for (const double r : {1.1, 1.35})
    check_derivatives(network, quantities, jointed_values(r, 0.05, kListed), kGradient);
}

TEST_CASE("Decays and transients tell a joint's energy as that of its sliders") {
  const Network apart = jointed_mass(kListed, false), together = jointed_mass(kListed, true);
  NetworkValues values = jointed_values(1.1, 0.02, kListed);
  const transient::InitialState start{{3.0}, {0.0}};
  const auto sum = [](const std::vector<double>& dissipated) {
    double of_sliders = 0.0;
    for (std::size_t e = 2; e < dissipated.size(); ++e) of_sliders += dissipated[e];
    return of_sliders;
  };
  const auto check = [&](const auto& one_by_one, const auto& as_one) {
    CHECK_THAT(as_one.energy.dissipated[2], WithinRel(sum(one_by_one.energy.dissipated), kSame));
    CHECK(sum(as_one.energy.dissipated) == as_one.energy.dissipated[2]);
    CHECK(as_one.energy.balance < kBalance);
  };
  const auto forced = [&](const Network& network) {
    return transient::forced_motion(network, [&](double) { return values; }, start,
                                    {.from = 1.1, .duration = 30.0, .samples = 11});
  };
  check(forced(apart), forced(together));
  values.excitation.clear();
  const auto decay = [&](Network network) {
    network.excitations.clear();
    return transient::free_decay(network, values, start, {.duration = 20.0, .samples = 11});
  };
  check(decay(apart), decay(together));
}

}  // namespace
}  // namespace frahm::periodic::iwan_test
