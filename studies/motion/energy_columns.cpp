#include "studies/motion/energy_columns.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <ostream>

#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/structural_damping.hpp"
#include "solvers/transient/energy_account.hpp"

namespace frahm::studies {

void add_energies(const Study& study, const transient::EnergyBudget& energy, MotionColumns& columns) {
  using transient::MotionMeasure;
  const auto& elements = study.network.elements;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    if (!mechanics::kind_of(elements[e]).dissipates || elements[e].parts == 0) continue;
    columns.add_quantity({MotionMeasure::energy, e}, energy.dissipated[e]);
    columns.add_quantity({MotionMeasure::energy_share, e}, energy.share[e]);
  }
  if (mechanics::has_structural_damping(study.network)) {
    columns.add_quantity({MotionMeasure::damping_energy}, energy.dissipated.back());
    columns.add_quantity({MotionMeasure::damping_energy_share}, energy.share.back());
  }
  columns.add_quantity({MotionMeasure::initial_energy}, energy.initial);
  columns.add_quantity({MotionMeasure::final_energy}, energy.final);
  if (study.kind() == StudyKind::transient) columns.add_quantity({MotionMeasure::energy_input}, energy.input);
  columns.add_quantity({MotionMeasure::energy_balance}, energy.balance);
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
