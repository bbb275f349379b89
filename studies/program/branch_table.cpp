#include "studies/program/branch_table.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <iterator>

#include "studies/map/output_quantities.hpp"
#include "studies/reading/quantities/unit_words.hpp"
#include "studies/reading/study/study_units.hpp"

namespace frahm::studies {
BranchTable::BranchTable(const Study& study, std::size_t along,
                         const std::vector<periodic::Quantity>& quantities)
    : study_(study),
      along_(along),
      name_(study.parameters.list[along].name),
      unit_(spoken_value(study, along, 0.0).unit) {
  for (const periodic::Quantity& each : quantities)
    quantities_.push_back(periodic::describe(each, study.network, study.dimensionless));
  const auto found = std::ranges::find(quantities_, headline_of(study), &periodic::QuantityDescription::name);
  if (found != quantities_.end()) headline_ = static_cast<std::size_t>(found - quantities_.begin());
}

double BranchTable::spoken(double si) const {
  return spoken_value(study_, along_, si).value;
}

void BranchTable::print(const periodic::Branch& branch, std::ostream& out) const {
  const auto stable = std::ranges::count(branch.points, true, &periodic::BranchPoint::stable);
  const auto [least, most] = std::ranges::minmax(branch.points, {}, &periodic::BranchPoint::parameter);
  fmt::print(out, "{:<22} {} points along {} from {:.6g} to {:.6g}{}, {} of them stable", "branch",
             branch.points.size(), name_, spoken(least.parameter), spoken(most.parameter),
             unit_.empty() ? "" : " " + unit_, stable);
  const int multiple = branch.points.front().multiple;
  if (multiple > 1) fmt::print(out, ", of {} periods of the excitation", multiple);
  fmt::print(out, "\n{:<22} {}\n", "before the first", periodic::end_sentence(branch.first_end));
  fmt::print(out, "{:<22} {}\n", "after the last", periodic::end_sentence(branch.last_end));
  if (branch.special.empty()) return fmt::print(out, "{:<22} none\n", "special points");
  const periodic::QuantityDescription& shown = quantities_[headline_];
  fmt::print(out, "\n{:<16} {:>18} {:>20} {:>10}  {}\n", "special point", in_brackets(name_, unit_),
             in_brackets(shown.name, shown.unit), "residual", "element");
  for (const periodic::SpecialPoint& each : branch.special) {
    fmt::print(out, "{:<16} {:>18.12g} {:>20.12g} {:>10.1e}  {}\n", periodic::kind_name(each.kind),
               spoken(each.at.parameter), each.at.quantities[headline_], each.residual,
               each.element ? study_.network.elements[*each.element].name : "");
  }
}

void BranchTable::print_failure(double start, const std::string& reason, std::ostream& out) const {
  fmt::print(out, "no response to start from at {} = {:.6g}{}: {}\n", name_, spoken(start),
             unit_.empty() ? "" : " " + unit_, reason);
}

std::string BranchTable::row(const periodic::BranchPoint& point, const char* special) const {
  std::string text = fmt::format("\n{:.17g}", spoken(point.parameter));
  for (const double value : point.quantities) fmt::format_to(std::back_inserter(text), ",{:.17g}", value);
  return text +
         fmt::format(",{:.17g},{:d},{},{}", point.floquet_radius, point.stable, point.multiple, special);
}

std::string BranchTable::csv(const periodic::Branch& branch) const {
  std::string text = in_brackets(name_, unit_);
  for (const auto& each : quantities_) text += "," + in_brackets(each.name, each.unit);
  text += ",largest_multiplier,stable,multiple,special";
  periodic::go_along(branch, [&](const periodic::BranchPoint& at, const periodic::SpecialPoint* special) {
    text += row(at, special ? periodic::kind_name(special->kind) : "");
  });
  return text + "\n";
}

}  // namespace frahm::studies
