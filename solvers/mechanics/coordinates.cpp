#include "solvers/mechanics/coordinates.hpp"

#include "solvers/mechanics/rotation.hpp"

namespace frahm::mechanics {

std::size_t coordinate_count(const Network& network) {
  return network.masses.size() + network.joints.size() + network.signals.size();
}

Coordinate coordinate(const Network& network, std::size_t index) {
  const std::size_t masses = network.masses.size(), joints = network.joints.size();
  if (index < masses) return {Coordinate::Kind::mass, index};
  if (index < masses + joints) return {Coordinate::Kind::joint, index - masses};
  return {Coordinate::Kind::signal, index - masses - joints};
}

const std::string& coordinate_name(const Network& network, std::size_t index) {
  const Coordinate its = coordinate(network, index);
  switch (its.kind) {
    case Coordinate::Kind::joint:
      return network.joints[its.index];
    case Coordinate::Kind::signal:
      return network.signals[its.index].name;
    case Coordinate::Kind::mass:
      break;
  }
  return network.masses[its.index];
}

std::vector<std::string> coordinate_names(const Network& network) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < coordinate_count(network); ++i) names.push_back(coordinate_name(network, i));
  return names;
}

bool coordinate_rotates(const Network& network, std::size_t index) {
  const Coordinate its = coordinate(network, index);
  switch (its.kind) {
    case Coordinate::Kind::joint:
      return joint_rotates(network, its.index);
    case Coordinate::Kind::signal:
      return network.signals[its.index].rotational;
    case Coordinate::Kind::mass:
      break;
  }
  return rotates(network, its.index);
}

std::string_view coordinate_unit(const Network& network, std::size_t index, std::string_view unit) {
  return coordinate_rotates(network, index) ? unit_of_rotation(unit) : unit;
}

Incidence coordinate_incidence(const Network& network, std::size_t index) {
  const Coordinate its = coordinate(network, index);
  if (its.kind == Coordinate::Kind::signal) return incidence(network, network.signals[its.index].along);
  const NodeKind kind = its.kind == Coordinate::Kind::joint ? NodeKind::joint : NodeKind::mass;
  return incidence(network, Direction{{{kind, its.index}, 1.0}});
}

std::vector<Incidence> incidences_beyond_masses(const Network& network) {
  std::vector<Incidence> incidences;
  for (std::size_t i = network.masses.size(); i < coordinate_count(network); ++i)
    incidences.push_back(coordinate_incidence(network, i));
  return incidences;
}

}  // namespace frahm::mechanics
