#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "solvers/mechanics/linear_system.hpp"

// The coordinates that are reported: the displacement of each mass, then each signal. They are numbered so.
namespace frahm::mechanics {

std::size_t coordinate_count(const Network& network);
const std::string& coordinate_name(const Network& network, std::size_t coordinate);
std::vector<std::string> coordinate_names(const Network& network);

// The unit of a coordinate's quantity by that of a translation's, in UDUNITS form.
bool coordinate_rotates(const Network& network, std::size_t coordinate);
std::string_view coordinate_unit(const Network& network, std::size_t coordinate, std::string_view unit);

// x = w^T q + p^T y of a coordinate: of a mass its own displacement.
Incidence coordinate_incidence(const Network& network, std::size_t coordinate);

// The same for the signals alone, in their order.
std::vector<Incidence> signal_incidences(const Network& network);

}  // namespace frahm::mechanics
