#include "studies/map/branch_group.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "studies/map/branch_rows.hpp"
#include "studies/map/map_groups.hpp"
#include "studies/provenance/assembly_stage.hpp"
#include "studies/provenance/result_variables.hpp"

namespace frahm::studies {
namespace {

using periodic::BranchEnd, periodic::SpecialKind;

constexpr int none = 1;                  // of a flag: after "not_computed"
constexpr int stable = 1, unstable = 2;  // values of `stability`

results::Variable parameter_of_branch(const Study& study, std::size_t parameter) {
  return parameter_variable(study, parameter, usual_unit(study, parameter).text);
}

// A quantity of the search, with all its digits.
results::Variable of_the_search(const Study& study, periodic::Measure measure,
                                results::Type type = results::Type::float64) {
  const auto quantity = periodic::describe({measure, 0}, study.network, study.dimensionless);
  return variable(Named::by_study(quantity.name, quantity.long_name), quantity.unit, type);
}

std::vector<results::Variable> row_variables(const Study& study, const std::vector<std::size_t>& beside) {
  std::vector<std::string> ends;
  for (int end = 0; end <= static_cast<int>(BranchEnd::family); ++end)
    ends.emplace_back(periodic::end_name(static_cast<BranchEnd>(end)));
  std::vector<results::Variable> variables;
  for (const std::size_t parameter : beside) variables.push_back(parameter_of_branch(study, parameter));
  variables.push_back(of_the_search(study, periodic::Measure::period_multiple, results::Type::int32));
  variables.push_back(flag_variable("first_end", ends));
  variables.push_back(flag_variable("last_end", ends));
  return variables;
}

std::vector<results::Variable> sample_variables(const Study& study, std::size_t along,
                                                const std::vector<periodic::Quantity>& quantities,
                                                const std::vector<std::size_t>& elements) {
  std::vector<std::string> kinds{"none"}, names{"none"};
  for (int kind = 0; kind <= static_cast<int>(SpecialKind::corner); ++kind)
    kinds.emplace_back(periodic::kind_name(static_cast<SpecialKind>(kind)));
  for (const std::size_t element : elements) names.push_back(study.network.elements[element].name);
  std::vector<results::Variable> variables{parameter_of_branch(study, along), variable("arclength")};
  for (const periodic::Quantity& each : quantities) {
    variables.push_back(variable_of(study, periodic::describe(each, study.network, study.dimensionless)));
    variables.back().significant_bits = 0;
  }
  variables.push_back(of_the_search(study, periodic::Measure::floquet_radius));
  variables.push_back(of_the_search(study, periodic::Measure::residual));
  variables.push_back(flag_variable("stability", {"stable", "unstable"}));
  variables.push_back(flag_variable("special", kinds));
  variables.push_back(variable("special_residual"));
  variables.push_back(flag_variable("special_element", names));
  return variables;
}

// The index of an enumerator or an element among the meanings of its flag.
template <class Enumerator>
int flag_value(Enumerator value) {
  return static_cast<int>(value) + 1;
}

}  // namespace

BranchGroup::BranchGroup(const Study& study, std::size_t along, std::vector<std::size_t> beside,
                         const std::vector<periodic::Quantity>& quantities, results::MapWriter& writer)
    : study_(study),
      along_(along),
      beside_(std::move(beside)),
      elements_(elements_with_events(study.network)),
      writer_(writer) {
  const results::RaggedLayout layout{
      .group = "branches",
      .row = "branch",
      .row_variables = row_variables(study, beside_),
      .sample = "place",
      .sample_variables = sample_variables(study, along, quantities, elements_)};
  columns_ = layout.sample_variables.size();
  table_ = writer.create_ragged(layout);
  writer.write_texts("branches", {{"along", study.parameters.list[along].name}});
}

std::vector<std::vector<double>> BranchGroup::samples(const periodic::Branch& branch) const {
  std::vector<std::vector<double>> columns(columns_);
  const double si_factor = usual_unit(study_, along_).si_factor;
  periodic::go_along(branch, [&](const periodic::BranchPoint& point, const periodic::SpecialPoint* special) {
    auto column = columns.begin();
    (column++)->push_back(point.parameter / si_factor);
    (column++)->push_back(point.arclength);
    for (const double value : point.quantities) (column++)->push_back(value);
    (column++)->push_back(point.floquet_radius);
    (column++)->push_back(point.residual);
    (column++)->push_back(point.stable ? stable : unstable);
    (column++)->push_back(special ? none + flag_value(special->kind) : none);
    (column++)->push_back(special ? special->residual : kNone);
    const auto element =
        special && special->element
            ? std::ranges::find(elements_, mechanics::reported_by(study_.network, *special->element))
            : elements_.end();
    column->push_back(element == elements_.end() ? none : none + flag_value(element - elements_.begin()));
  });
  return columns;
}

void BranchGroup::append(std::span<const double> parameters, const periodic::Branch& branch) {
  std::vector<double> row;
  for (const std::size_t parameter : beside_)
    row.push_back(parameters[parameter] / usual_unit(study_, parameter).si_factor);
  row.push_back(branch.points.front().multiple);
  row.push_back(flag_value(branch.first_end));
  row.push_back(flag_value(branch.last_end));
  writer_.append_ragged(table_, row, samples(branch));
}

std::vector<std::size_t> axis_parameters_beside(const Study& study, std::size_t along) {
  std::vector<std::size_t> parameters;
  for (const ParameterAxis& axis : study.map()->axes)
    if (axis.parameter != along) parameters.push_back(axis.parameter);
  return parameters;
}

void write_branches(const MapPlan& plan, const engine::TileIndex& index, const AssemblyOptions& options,
                    results::MapWriter& writer) {
  const Study& study = plan.study;
  if (!study.sweep()->branches) return;
  const ParameterAxis& axis = study.map()->axes[study.sweep()->branches->axis];
  BranchGroup record(study, axis.parameter, axis_parameters_beside(study, axis.parameter),
                     branch_quantities(study), writer);
  const std::vector<std::vector<std::uint64_t>> rows = branch_rows(study);
  engine::TileReader reader(index);
  const auto obey = [&options](const periodic::BranchPoint&) {
    if (options.stop_asked()) throw AssemblyStopped{};
  };
  const auto append = [&](const std::vector<std::uint64_t>& row, const std::vector<periodic::Branch>& found) {
    std::vector<double> parameters = study.parameters.nominal();
    for (std::size_t d = 0; d < row.size(); ++d) set_along(*study.sweep(), d, row[d], parameters);
    for (const periodic::Branch& branch : found) record.append(parameters, branch);
  };
  const auto make_work = [&]() -> engine::PieceWork {
    // Shared, as a PieceWork has to be copyable.
    auto branches = std::make_shared<RowBranches>(plan);
    return [&, branches](std::uint64_t number) {
      const std::vector<std::uint64_t>& row = rows[number];
      return [found = branches->follow(row, branches->places(row, index, reader), obey), &row, &append] {
        append(row, found);
      };
    };
  };
  carry_out({.name = "branches",
             .pieces = rows.size(),
             .points = rows.size() * axis.values.size(),
             .points_of = [&axis](std::uint64_t) { return axis.values.size(); },
             .make_work = make_work},
            options);
}

}  // namespace frahm::studies
