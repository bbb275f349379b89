#include "studies/motion/energy_columns.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <ostream>

#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/structural_damping.hpp"
#include "solvers/transient/energy_account.hpp"

namespace frahm::studies {

void add_energies(const Study& study, const transient::EnergyBudget& energy, MotionColumns& columns) {
  const auto& elements = study.network.elements;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    if (!mechanics::kind_of(elements[e]).dissipates || elements[e].parts == 0) continue;
    const std::string& name = elements[e].name;
    columns.add_number(name + "_energy", "J", "energy dissipated by " + name, energy.dissipated[e]);
    columns.add_number(name + "_energy_share", "1", "share of " + name + " in the energy dissipated",
                       energy.share[e]);
  }
  if (mechanics::has_structural_damping(study.network)) {
    columns.add_number("damping_energy", "J", "energy dissipated by the damping of the structure",
                       energy.dissipated.back());
    columns.add_number("damping_energy_share", "1",
                       "share of the damping of the structure in the energy dissipated", energy.share.back());
  }
  columns.add_number("initial_energy", "J", "kinetic and potential energy at the start", energy.initial);
  columns.add_number("final_energy", "J", "kinetic and potential energy at the end", energy.final);
  if (study.kind() == StudyKind::transient)
    columns.add_number("energy_input", "J", "work of the excitation", energy.input);
  columns.add_number(
      "energy_balance", "1",
      "energy at the start plus energy put in, minus energy dissipated and energy at the end, relative",
      energy.balance);
}

void print_energies(const Study& study, const transient::EnergyBudget& energy, std::ostream& out) {
  const auto line = [&](const std::string& what, double value, const std::string& share) {
    fmt::print(out, "{:<24}{:>18.10g}{:>10}\n", what, value, share);
  };
  fmt::print(out, "\n{:<24}{:>18}{:>10}\n", "", study.dimensionless ? "energy" : "energy [J]", "share");
  line("at the start", energy.initial, "");
  if (study.kind() == StudyKind::transient) line("work of the excitation", energy.input, "");
  const auto& elements = study.network.elements;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    if (!mechanics::kind_of(elements[e]).dissipates || elements[e].parts == 0) continue;
    line("lost in " + elements[e].name, energy.dissipated[e],
         fmt::format("{:.2f} %", 100.0 * energy.share[e]));
  }
  if (mechanics::has_structural_damping(study.network))
    line("lost in the structure", energy.dissipated.back(),
         fmt::format("{:.2f} %", 100.0 * energy.share.back()));
  line("at the end", energy.final, "");
  fmt::print(out, "the energies balance to {:.2g}\n", energy.balance);
}

}  // namespace frahm::studies
