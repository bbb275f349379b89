#include "solvers/mechanics/coordinates.hpp"

#include "solvers/mechanics/rotation.hpp"

namespace frahm::mechanics {

std::size_t coordinate_count(const Network& network) {
  return network.masses.size() + network.signals.size();
}

const std::string& coordinate_name(const Network& network, std::size_t coordinate) {
  const std::size_t masses = network.masses.size();
  return coordinate < masses ? network.masses[coordinate] : network.signals[coordinate - masses].name;
}

std::vector<std::string> coordinate_names(const Network& network) {
  std::vector<std::string> names = network.masses;
  for (const Signal& signal : network.signals) names.push_back(signal.name);
  return names;
}

bool coordinate_rotates(const Network& network, std::size_t coordinate) {
  const std::size_t masses = network.masses.size();
  return coordinate < masses ? rotates(network, coordinate) : network.signals[coordinate - masses].rotational;
}

std::string_view coordinate_unit(const Network& network, std::size_t coordinate, std::string_view unit) {
  return coordinate_rotates(network, coordinate) ? unit_of_rotation(unit) : unit;
}

Incidence coordinate_incidence(const Network& network, std::size_t coordinate) {
  const std::size_t masses = network.masses.size();
  if (coordinate >= masses) return incidence(network, network.signals[coordinate - masses].along);
  return incidence(network, Direction{{{NodeKind::mass, coordinate}, 1.0}});
}

std::vector<Incidence> signal_incidences(const Network& network) {
  std::vector<Incidence> incidences;
  for (std::size_t i = network.masses.size(); i < coordinate_count(network); ++i)
    incidences.push_back(coordinate_incidence(network, i));
  return incidences;
}

}  // namespace frahm::mechanics
