#include "studies/reading/direction_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/reading/network_reading.hpp"
#include "studies/reading/spelling.hpp"

namespace frahm::studies {
namespace {

using mechanics::Node;
using mechanics::NodeKind;

constexpr std::string_view key_of_direction = "along";
constexpr std::string_view factor_must_stay =
    "a factor is the same throughout a study; write a study for each value, or run this one again with "
    "--set";

// The factor of a unit to SI: of a number, a length, or a length per radian.
double si_factor_of_share(const StudyContext& context, const std::string& where, const Unit& unit,
                          Position position) {
  const bool is_number = unit.exponents == std::array{0, 0, 0} && unit.radians == 0;
  const bool is_length = unit.exponents == std::array{1, 0, 0} && (unit.radians == 0 || unit.radians == -1);
  if (!unit.foreign && (is_number || is_length)) return unit.scale;
  throw context.source.error_at(rules::wrong_dimension, position,
                                "{}: the unit \"{}\" is that of {}, but a number or a length per radian is "
                                "expected (such as 1, m or mm)",
                                where, unit.text, dimension_name(unit));
}

StudyValue read_factor(const StudyContext& context, const Parameters& parameters, const std::string& where,
                       const TomlValue& value) {
  StudyValue factor{.where = where, .position = value.position};
  if (value.as<std::string>()) {
    factor.expression = read_expression(context, parameters, where, value);
    return factor;
  }
  const NumberWithUnit number = read_number_with_unit(context, where, value);
  const double to_si =
      number.unit ? si_factor_of_share(context, where, *number.unit, number.unit_position) : 1.0;
  factor.expression = Expression(number.value * to_si);
  return factor;
}

// The names of number parameters that change within the study, and what changes them.
struct Change {
  std::size_t parameter = 0;
  std::string by;
};

std::vector<Change> changes_of(const Study& study) {
  std::vector<Change> changes;
  if (study.sweep()) {
    for (const ParameterAxis& axis : study.sweep()->axes) changes.push_back({axis.parameter, "an [[axis]]"});
  }
  if (const TuneChoice* tune = study.tune()) {
    if (tune->band) changes.push_back({tune->band->parameter, "the band of [tune]"});
    for (const DesignChoice& design : tune->designs) changes.push_back({design.parameter, "a [[design]]"});
  }
  if (const IdentifyChoice* identify = study.identify()) {
    for (const IdentifiedParameter& fitted : identify->parameters)
      changes.push_back({fitted.parameter, "an [[identify.parameter]]"});
    for (const FixedEstimate& fixed : identify->fixed) changes.push_back({fixed.parameter, "fixed_from"});
  }
  if (study.transient() && study.transient()->sweep_to) {
    for (const std::size_t i : study.parameters.inputs_of(study.values.omega.expression.reads()))
      changes.push_back({i, "sweep_to of [transient]"});
  }
  return changes;
}

void check_it_stays(const Study& study, const StudyValue& factor) {
  const std::vector<std::size_t> inputs = study.parameters.inputs_of(factor.expression.reads());
  for (const Change& change : changes_of(study)) {
    if (std::ranges::find(inputs, change.parameter) == inputs.end()) continue;
    throw study.source.error_at(rules::wrong_dependence, factor.position,
                                "{}: depends on \"{}\", which {} changes; {}", factor.where,
                                study.parameters.list[change.parameter].name, change.by, factor_must_stay);
  }
}

}  // namespace

StudyDirection read_direction(const StudyContext& context, const Parameters& parameters,
                              const mechanics::Network& network, const TomlSection& section) {
  const TomlValue& table = section.require(key_of_direction);
  const auto* shares = table.as<TomlTable>();
  if (!shares || shares->empty())
    section.fail(rules::wrong_type, key_of_direction,
                 "nodes with their factors are expected: along = {{ roof = 1, ground = -1 }}");
  StudyDirection along{.position = table.position};
  for (const TomlEntry& share : *shares) {
    const auto node = find_node(network, share.key);
    if (!node) {
      throw context.source.error_at(rules::unknown_name, share.position, "{}: {}: no node is called \"{}\"{}",
                                    section.where(), key_of_direction, share.key,
                                    suggestion(share.key, node_names(network)));
    }
    if (std::ranges::find(along.nodes, *node) != along.nodes.end()) {
      throw context.source.error_at(rules::given_twice, share.position, "{}: {}: \"{}\" is given twice",
                                    section.where(), key_of_direction, share.key);
    }
    along.nodes.push_back(*node);
    along.factors.push_back(
        read_factor(context, parameters,
                    fmt::format("{}: {}: {}", section.where(), key_of_direction, share.key), share.value));
  }
  const bool moves =
      std::ranges::any_of(along.nodes, [](const Node& node) { return node.kind == NodeKind::mass; });
  if (!moves)
    section.fail(rules::wrong_node, key_of_direction,
                 "a lever with no moving end: none of its nodes is a mass");
  return along;
}

mechanics::Direction direction_of(const Study& study, const StudyDirection& along) {
  const std::vector<double> parameters = study.parameters.nominal();
  mechanics::Direction direction;
  for (std::size_t i = 0; i < along.nodes.size(); ++i) {
    const StudyValue& factor = along.factors[i];
    check_it_stays(study, factor);
    const double value = factor.expression.evaluate(std::span<const double>(parameters));
    if (!std::isfinite(value) || value == 0.0)
      throw study.source.error_at(rules::out_of_range, factor.position,
                                  "{}: {}; a factor is a finite number other than zero{}", factor.where,
                                  std::isfinite(value) ? "is 0" : "has no value",
                                  value == 0.0 ? " (leave the node out)" : "");
    direction.push_back({along.nodes[i], value});
  }
  return direction;
}

void check_direction_at(const Study& study, const StudyDirection& along, std::span<const double> parameters,
                        std::string_view origin) {
  const std::vector<double> stated = study.parameters.nominal();
  for (const StudyValue& factor : along.factors) {
    const double before = factor.expression.evaluate(std::span<const double>(stated));
    const double here = factor.expression.evaluate(parameters);
    if (here == before) continue;
    throw study.source.error_at(rules::wrong_dependence, factor.position,
                                "{}: is {:.6g}, but {:.6g} here{}; {}", factor.where, before, here,
                                origin.empty() ? "" : fmt::format(" ({})", origin), factor_must_stay);
  }
}

}  // namespace frahm::studies
