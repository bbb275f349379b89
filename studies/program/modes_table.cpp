#include "studies/program/modes_table.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numbers>
#include <type_traits>

namespace frahm::studies {
namespace {

constexpr std::size_t most_modes = 12;        // of an excerpt
constexpr std::size_t most_in_a_system = 12;  // masses whose shapes are shown whole
constexpr std::size_t most_in_a_shape = 8;    // of an excerpt

void print_table(const Study& study, const periodic::LinearModes& modes, Listing listing, std::ostream& out) {
  const std::size_t masses = study.network.masses.size(), all = modes.frequency.size();
  const std::size_t shown = listing == Listing::whole ? all : std::min(all, most_modes);
  const std::vector<std::size_t> places =
      listed_indices(masses, masses > most_in_a_system ? most_in_a_shape : masses, listing);
  const auto at_places = [&](const auto& of_masses) {
    std::vector<std::decay_t<decltype(of_masses[0])>> chosen;
    for (const std::size_t place : places) chosen.push_back(of_masses[place]);
    return chosen;
  };
  const std::string frequencies = study.dimensionless
                                      ? fmt::format("{:>12}", "frequency")
                                      : fmt::format("{:>12}{:>11}{:>11}", "rad/s", "Hz", "rpm");
  fmt::print(out, "  mode{}{:>12}   shape of {}\n", frequencies, "damping",
             fmt::join(at_places(study.network.masses), ", "));
  for (std::size_t k = 0; k < shown; ++k) {
    const double omega = modes.frequency[k], hertz = omega / (2.0 * std::numbers::pi);
    fmt::print(out, "  {:>4}{:>12.6g}", k + 1, omega);
    if (!study.dimensionless) fmt::print(out, "{:>11.5g}{:>11.5g}", hertz, 60.0 * hertz);
    const std::string damping = omega == 0.0 ? "free" : fmt::format("{:.5g}", modes.damping[k]);
    fmt::print(out, "{:>12}   {:.4g}\n", damping, fmt::join(at_places(modes.shape[k]), ", "));
  }
  if (shown < all || places.size() < masses)
    fmt::print(out, "  {} of {} modes, at {} of {} masses; --all shows all\n", shown, all, places.size(),
               masses);
}

bool rubs_on_a_support(const mechanics::Network& network) {
  return std::ranges::any_of(network.elements, [](const mechanics::Element& element) {
    return mechanics::has_contact(element) &&
           std::ranges::any_of(element.along, [](const mechanics::Share& share) {
             return share.node.kind == mechanics::NodeKind::prescribed;
           });
  });
}

// The largest ratio that [damping] modal gives a mode; 0 without it.
double largest_ratio(const Study& study, const mechanics::NetworkValues& values) {
  if (study.network.damping != mechanics::DampingModel::modal) return 0.0;
  return std::ranges::max(values.damping);
}

// A ratio meant in per cent is a valid one, and another system.
void note_beyond_critical(double ratio, std::ostream& out) {
  if (ratio <= 1.0) return;
  fmt::print(out,
             "note: [damping]: modal: a ratio of {:.6g} is above 1 (critical damping), so this mode does not "
             "oscillate; 2 % is 0.02\n",
             ratio);
}

}  // namespace

ModesAtPoint modes_at_point(const Study& study, const mechanics::NetworkValues& values) {
  const auto& elements = study.network.elements;
  const bool friction = std::any_of(elements.begin(), elements.end(), mechanics::has_contact);
  const mechanics::FreeMasses free = free_masses(study.kind(), study.network);
  return {periodic::linear_modes(study.network, values, false, free),
          periodic::linear_modes(study.network, values, true, free), friction, largest_ratio(study, values)};
}

void print_modes(const Study& study, const ModesAtPoint& modes, Listing listing, std::ostream& out) {
  fmt::print(out, "Undamped modes{}\n", modes.friction ? " with all friction sliding" : "");
  print_table(study, modes.sliding, listing, out);
  note_beyond_critical(modes.largest_ratio, out);
  if (!modes.friction) return;
  if (modes.stuck.frequency.empty()) {
    fmt::print(out, "With all friction stuck nothing moves{}.\n",
               rubs_on_a_support(study.network) ? ", except with its supports" : "");
    return;
  }
  fmt::print(out, "Undamped modes with all friction stuck\n");
  print_table(study, modes.stuck, listing, out);
}

mechanics::NetworkValues stated_values(const Study& study) {
  std::vector<double> parameters = study.parameters.nominal();
  mechanics::NetworkValues values;
  evaluate(study.values, study.parameters, parameters, values);
  return values;
}

void print_stated_modes(const Study& study, const ModesAtPoint& modes, Listing listing, std::ostream& out) {
  fmt::print(out, "For the design of the study:\n");
  print_modes(study, modes, listing, out);
}

}  // namespace frahm::studies
