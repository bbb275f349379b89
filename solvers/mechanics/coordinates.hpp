#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "solvers/mechanics/linear_system.hpp"

// The coordinates that are reported: the displacement of each mass, of each joint, then each signal. They are
// numbered so.
namespace frahm::mechanics {

struct Coordinate {
  enum class Kind { mass, joint, signal };
  Kind kind = Kind::mass;
  std::size_t index = 0;  // among those of its kind
};
Coordinate coordinate(const Network& network, std::size_t index);

std::size_t coordinate_count(const Network& network);
const std::string& coordinate_name(const Network& network, std::size_t index);
std::vector<std::string> coordinate_names(const Network& network);

// The unit of a coordinate's quantity by that of a translation's, in UDUNITS form.
bool coordinate_rotates(const Network& network, std::size_t index);
std::string_view coordinate_unit(const Network& network, std::size_t index, std::string_view unit);

// w^T q + p^T y + j^T x of a coordinate: of a mass or joint its own displacement.
Incidence coordinate_incidence(const Network& network, std::size_t index);

// The same for those after the masses, in their order.
std::vector<Incidence> incidences_beyond_masses(const Network& network);

}  // namespace frahm::mechanics
