#include "studies/program/verify_system.hpp"

#include "solvers/orbits/orbit.hpp"

namespace frahm::studies {
namespace {

using mechanics::ElementType;
using mechanics::Node;
using mechanics::NodeKind;
using periodic::Measure;

constexpr Node base{NodeKind::prescribed, 0};

std::vector<mechanics::Element> spring_damper_friction(Node support, Node friction_support) {
  return {{"spring", ElementType::spring, support, moving_mass},
          {"damper", ElementType::damper, support, moving_mass},
          {"friction", ElementType::coulomb, friction_support, moving_mass}};
}

const std::vector<periodic::Quantity> asked_for = {{Measure::amplitude, 0},      {Measure::stroke, 0},
                                                   {Measure::peak_phase, 0},     {Measure::floquet_radius, 0},
                                                   {Measure::energy_balance, 0}, {Measure::stuck_fraction, 2},
                                                   {Measure::regime, 2}};

}  // namespace

mechanics::Network forced_mass(const std::vector<int>& orders) {
  mechanics::Network network{.masses = {"x"}, .elements = spring_damper_friction({}, {})};
  for (const int order : orders) network.excitations.push_back({mechanics::ExcitationKind::force, 0, order});
  network.reference_order = orders.front();
  return network;
}

mechanics::Network mass_on_base(bool friction_on_base) {
  return {.masses = {"x"},
          .prescribed = {"base"},
          .elements = spring_damper_friction(base, friction_on_base ? base : Node{}),
          .excitations = {{mechanics::ExcitationKind::motion, 0, 1}}};
}

mechanics::NetworkValues mass_values(double r, double zeta, double f) {
  return {.omega = r, .mass = {1.0}, .element = {1.0, 2.0 * zeta, f}, .excitation = {{1.0, 0.0}}};
}

ClassicalSystem::ClassicalSystem(const mechanics::Network& network)
    : response_(network, asked_for), found_(asked_for.size()) {}

KnownQuantities ClassicalSystem::solve(const mechanics::NetworkValues& values) {
  response_.forget();
  response_.set_values(values);
  const periodic::Status status = response_.solve().status;
  response_.quantities(found_);
  return {.amplitude = found_[0],
          .stroke = found_[1],
          .peak_phase = found_[2],
          .floquet_radius = found_[3],
          .energy_balance = found_[4],
          .stuck_fraction = found_[5],
          .has_orbit = status == periodic::Status::ok || status == periodic::Status::grazing,
          .unbounded = status == periodic::Status::unbounded,
          .regime = static_cast<periodic::Regime>(static_cast<int>(found_[6]))};
}

}  // namespace frahm::studies
