#include "studies/program/modes_table.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numbers>

namespace frahm::studies {
namespace {

void print_table(const Study& study, const periodic::LinearModes& modes, std::ostream& out) {
  const std::string masses = fmt::format("{}", fmt::join(study.network.masses, ", "));
  const std::string frequencies = study.dimensionless
                                      ? fmt::format("{:>12}", "frequency")
                                      : fmt::format("{:>12}{:>11}{:>11}", "rad/s", "Hz", "rpm");
  fmt::print(out, "  mode{}{:>12}   shape of {}\n", frequencies, "damping", masses);
  for (std::size_t k = 0; k < modes.frequency.size(); ++k) {
    const double omega = modes.frequency[k], hertz = omega / (2.0 * std::numbers::pi);
    fmt::print(out, "  {:>4}{:>12.6g}", k + 1, omega);
    if (!study.dimensionless) fmt::print(out, "{:>11.5g}{:>11.5g}", hertz, 60.0 * hertz);
    fmt::print(out, "{:>12.5g}   {:.4g}\n", modes.damping[k], fmt::join(modes.shape[k], ", "));
  }
}

}  // namespace

ModesAtPoint modes_at_point(const Study& study, const mechanics::NetworkValues& values) {
  const auto& elements = study.network.elements;
  const bool friction = std::any_of(elements.begin(), elements.end(), mechanics::has_contact);
  return {periodic::linear_modes(study.network, values, false),
          periodic::linear_modes(study.network, values, true), friction};
}

void print_modes(const Study& study, const ModesAtPoint& modes, std::ostream& out) {
  fmt::print(out, "Undamped modes{}\n", modes.friction ? " with all friction sliding" : "");
  print_table(study, modes.sliding, out);
  if (!modes.friction) return;
  if (modes.stuck.frequency.empty()) {
    fmt::print(out, "With all friction stuck nothing moves.\n");
    return;
  }
  fmt::print(out, "Undamped modes with all friction stuck\n");
  print_table(study, modes.stuck, out);
}

}  // namespace frahm::studies
