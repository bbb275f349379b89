#include "studies/reading/system/network_limits.hpp"

#include <algorithm>

#include "solvers/flow/sizes.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "studies/reading/system/network_reading.hpp"

// How many contacts are followed exactly, and how large a system may be.
namespace frahm::studies {
namespace {

// An orbit takes memory in proportion to the square of the states, and time to their cube: 1 GB and 10 s
// here.
constexpr std::size_t most_states = 700;

using mechanics::ElementKind;

bool join_the_same_nodes(const mechanics::Direction& a, const mechanics::Direction& b) {
  if (!mechanics::is_between_two_nodes(a) || !mechanics::is_between_two_nodes(b)) return a == b;
  return (a[0].node == b[0].node && a[1].node == b[1].node) ||
         (a[0].node == b[1].node && a[1].node == b[0].node);
}

// Elements along one direction whose law merges are one contact.
std::size_t number_of_contacts(const mechanics::Network& network) {
  std::size_t contacts = 0;
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    const mechanics::Element& element = network.elements[e];
    const ElementKind& kind = mechanics::kind_of(element);
    const auto is_the_same = [&](const mechanics::Element& other) {
      return other.type == element.type && join_the_same_nodes(other.along, element.along);
    };
    const auto own = network.elements.begin() + static_cast<std::ptrdiff_t>(e);
    const bool joins =
        kind.law != nullptr && kind.law->merges && std::any_of(network.elements.begin(), own, is_the_same);
    contacts += kind.law != nullptr && !joins;
  }
  return contacts;
}

}  // namespace

void check_number_of_contacts(const NetworkReading& reading, const TomlSection& section,
                              const mechanics::Element& element) {
  if (!mechanics::has_contact(element) || element.law != mechanics::ForceLaw::exact) return;
  const std::size_t contacts = number_of_contacts(reading.result.network);
  if (contacts <= periodic::kMostContacts) return;
  section.fail_here(
      rules::too_large,
      "the {}th friction contact; at most {} can be followed exactly (law = \"arctan\" has no limit)",
      contacts, periodic::kMostContacts);
}

void check_number_of_states(const NetworkReading& reading, const TomlSection& section) {
  const mechanics::Network& network = reading.result.network;
  const auto has_internal_force = [](const auto& each) {
    return mechanics::kind_of(each).has_internal_force;
  };
  const std::size_t in_series = network.joints.size() + static_cast<std::size_t>(std::ranges::count_if(
                                                            network.elements, has_internal_force));
  const std::size_t states = 2 * network.masses.size() + in_series;
  if (states <= most_states) return;
  section.fail_here(
      rules::too_large,
      "with it the system has {} states: two per mass, one per joint and per spring in series with a damper "
      "or "
      "slider; at "
      "most {} are possible, because its matrices are full: reduce it to the points of interest",
      states, most_states);
}

}  // namespace frahm::studies
