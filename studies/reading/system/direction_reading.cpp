#include "studies/reading/system/direction_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solvers/mechanics/rotation.hpp"
#include "studies/reading/quantities/expression.hpp"
#include "studies/reading/quantities/expression_dimension.hpp"
#include "studies/reading/study/dimension_check.hpp"
#include "studies/reading/study/parameter_reading.hpp"
#include "studies/reading/study/study_values.hpp"
#include "studies/reading/system/connectivity.hpp"
#include "studies/reading/system/network_reading.hpp"
#include "studies/reading/text/spelling.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {
namespace {

using mechanics::Node;
using mechanics::NodeKind;

constexpr std::string_view key_of_direction = "along";
constexpr std::string_view factor_must_stay =
    "a factor must be the same throughout a study; write a study for each value, or run this one again with "
    "--set";

// What a factor is, as far as its units tell: a rotation times a length [m/rad] is a length, a translation
// over a length an angle.
enum class FactorDimension { unknown, number, length, per_length };

// Nothing for any other dimension.
std::optional<FactorDimension> factor_dimension(const ExpressionDimension& dimension) {
  if (!dimension) return FactorDimension::unknown;
  if (same(*dimension, {0.0, 0.0, 0.0})) return FactorDimension::number;
  if (same(*dimension, {1.0, 0.0, 0.0})) return FactorDimension::length;
  if (same(*dimension, {-1.0, 0.0, 0.0})) return FactorDimension::per_length;
  return std::nullopt;
}

std::optional<FactorDimension> factor_dimension(const Unit& unit) {
  if (unit.foreign || std::abs(unit.radians) > 1) return std::nullopt;
  return factor_dimension(exponents_of(unit));
}

// A factor while it is read.
struct Factor {
  StudyValue value;
  FactorDimension dimension = FactorDimension::unknown;
};

[[noreturn]] void refuse_dimension(const StudyContext& context, const std::string& where, Position position,
                                   const std::string& found) {
  throw context.source.error_at(
      rules::wrong_dimension, position,
      "{}: {}, but a factor must be a number or a length per radian (such as 1, m or mm)", where, found);
}

Factor read_factor(const StudyContext& context, const Parameters& parameters, const std::string& where,
                   const TomlValue& value) {
  Factor factor;
  factor.value.where = where;
  factor.value.position = value.position;
  if (value.as<std::string>()) {
    factor.value.expression = read_expression(context, parameters, where, value);
    const ExpressionDimension found =
        dimension_of_geometry(context, parameters, factor.value.expression, where, value.position);
    const auto dimension = factor_dimension(found);
    if (!dimension)
      refuse_dimension(context, where, value.position, "the expression is " + described(*found));
    factor.dimension = *dimension;
    return factor;
  }
  const NumberWithUnit number = read_number_with_unit(context, where, value);
  if (number.unit) {
    const auto dimension = factor_dimension(*number.unit);
    if (!dimension) {
      refuse_dimension(
          context, where, number.unit_position,
          fmt::format("the unit \"{}\" is that of {}", number.unit->text, dimension_name(*number.unit)));
    }
    factor.dimension = *dimension;
  }
  factor.value.expression = Expression(number.value * (number.unit ? number.unit->scale : 1.0));
  return factor;
}

// Whether the combination is an angle: where no coordinate in it is a length. A translation is one, but over
// a length; a rotation is none, but times a length.
bool is_angle(const StudyContext& context, const mechanics::Network& network, const std::vector<Node>& nodes,
              const std::vector<Factor>& factors) {
  const auto turns = [&](std::size_t i) { return mechanics::turns(network, nodes[i]); };
  bool angle = true;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].kind == NodeKind::ground) continue;
    const FactorDimension dimension = factors[i].dimension;
    angle =
        angle && (turns(i) ? dimension != FactorDimension::length : dimension == FactorDimension::per_length);
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].kind == NodeKind::ground || factors[i].dimension == FactorDimension::unknown) continue;
    const FactorDimension fits = turns(i) == angle ? FactorDimension::number
                                 : angle           ? FactorDimension::per_length
                                                   : FactorDimension::length;
    if (factors[i].dimension == fits) continue;
    throw context.source.error_at(
        rules::wrong_dimension, factors[i].value.position,
        "{}: with this factor it is not {} like the others; a {} is multiplied by {}", factors[i].value.where,
        angle ? "an angle" : "a length", turns(i) ? "rotation" : "translation",
        fits == FactorDimension::number   ? "a number"
        : fits == FactorDimension::length ? "a radius (m, mm)"
                                          : "a number per length (1/m)");
  }
  return angle;
}

// An angle takes the ground for an angle, but over a length; a length, times one.
bool twists_ground(bool angle, const std::vector<Node>& nodes, const std::vector<Factor>& factors) {
  const auto ground = std::ranges::find(nodes, Node{});
  if (ground == nodes.end()) return angle;
  const FactorDimension dimension = factors[static_cast<std::size_t>(ground - nodes.begin())].dimension;
  return angle ? dimension != FactorDimension::per_length : dimension == FactorDimension::length;
}

// The node of a share, which no share before it has.
Node read_node(const StudyContext& context, const mechanics::Network& network, const TomlSection& section,
               const TomlEntry& share, const std::vector<Node>& before) {
  const auto fail = [&](Rule rule, const std::string& problem) {
    throw context.source.error_at(rule, share.position, "{}: {}: {}", section.where(), key_of_direction,
                                  problem);
  };
  const auto node = find_node(network, share.key);
  if (!node) fail(rules::unknown_name, none_called("node", share.key, node_names(network)));
  if (std::ranges::find(before, *node) != before.end())
    fail(rules::given_twice, fmt::format("\"{}\" is given twice", share.key));
  return *node;
}

// A number parameter that changes within the study, and by what.
struct Change {
  std::size_t parameter = 0;
  std::string by;
};

std::vector<Change> changes_of(const Study& study) {
  std::vector<Change> changes;
  if (study.map()) {
    for (const ParameterAxis& axis : study.map()->axes) changes.push_back({axis.parameter, "an [[axis]]"});
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

// Squares of factors, times a stiffness, stay among the doubles.
void check_factor_size(const Study& study, const StudyValue& factor, double value) {
  constexpr double smallest = 1e-50, largest = 1e50;
  const double size = std::abs(value);
  if (size >= smallest && size <= largest) return;
  throw study.source.error_at(rules::beyond_schema(rules::out_of_range), factor.position,
                              "{}: {}; the size of a factor must be from {} to {}{}", factor.where,
                              std::isnan(value) ? "has no value" : fmt::format("is {:.6g}", value), smallest,
                              largest, value == 0.0 ? " (leave out the node)" : "");
}

}  // namespace

StudyDirection read_direction(const StudyContext& context, const Parameters& parameters,
                              const mechanics::Network& network, const TomlSection& section) {
  const TomlValue& table = section.require(key_of_direction);
  const auto* shares = table.as<TomlTable>();
  if (!shares || shares->empty())
    section.fail(rules::wrong_type, key_of_direction,
                 "expected nodes with their factors: along = {{ roof = 1, ground = -1 }}");
  StudyDirection along;
  along.position = table.position;
  std::vector<Factor> factors;
  for (const TomlEntry& share : *shares) {
    along.nodes.push_back(read_node(context, network, section, share, along.nodes));
    const std::string where = fmt::format("{}: {}: {}", section.where(), key_of_direction, share.key);
    factors.push_back(read_factor(context, parameters, where, share.value));
    along.factors.push_back(factors.back().value);
  }
  const bool moves = std::ranges::any_of(along.nodes, [](const Node& node) {
    return node.kind == NodeKind::mass || node.kind == NodeKind::joint;
  });
  if (!moves)
    section.fail(rules::wrong_node, key_of_direction,
                 "a lever without a moving end: none of its nodes is a mass");
  along.rotational = is_angle(context, network, along.nodes, factors);
  along.twists_ground = twists_ground(along.rotational, along.nodes, factors);
  return along;
}

mechanics::Direction direction_of(const Study& study, const StudyDirection& along) {
  const std::vector<double> parameters = study.parameters.nominal();
  mechanics::Direction direction;
  for (std::size_t i = 0; i < along.nodes.size(); ++i) {
    const StudyValue& factor = along.factors[i];
    check_it_stays(study, factor);
    const double value = factor.expression.evaluate(std::span<const double>(parameters));
    check_factor_size(study, factor, value);
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

void set_directions(Study& study) {
  bool any = false;
  for (std::size_t e = 0; e < study.values.along.size(); ++e) {
    if (!study.values.along[e].is_given()) continue;
    study.network.elements[e].along = direction_of(study, study.values.along[e]);
    any = true;
  }
  if (any || !study.network.matrices.empty()) check_combinations_are_held(study);
}

}  // namespace frahm::studies
