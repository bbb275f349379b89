#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>
#include <ostream>

#include "studies/program/point_report.hpp"

namespace frahm::studies {
namespace {

using Json = nlohmann::ordered_json;

Json quantity_json(const PointReport::QuantityValue& quantity) {
  const auto& [description, value] = quantity;
  Json json{{"value", has_value(quantity) ? Json(value) : Json()}, {"unit", description.unit}};
  if (has_value(quantity) && description.kind != periodic::QuantityKind::real)
    json["value"] = static_cast<int>(value);
  if (description.kind == periodic::QuantityKind::flag) json["meaning"] = flag_meaning(description, value);
  json["long_name"] = description.long_name;
  return json;
}

Json stretches_json(const PointReport& report) {
  Json list = Json::array();
  for (const periodic::Stretch& stretch : report.stretches) {
    Json contacts = Json::object();
    for (std::size_t i = 0; i < report.friction_elements.size(); ++i) {
      contacts[report.friction_elements[i]] = stretch.contacts[i];
    }
    list.push_back({{"start", stretch.start}, {"length", stretch.length}, {"contacts", contacts}});
  }
  return list;
}

Json modes_json(const Study& study, const periodic::LinearModes& modes) {
  Json list = Json::array();
  for (std::size_t k = 0; k < modes.frequency.size(); ++k) {
    Json shape = Json::object();
    for (std::size_t i = 0; i < study.network.masses.size(); ++i)
      shape[study.network.masses[i]] = modes.shape[k][i];
    list.push_back({{"frequency", modes.frequency[k]},
                    {"unit", study.dimensionless ? "1" : "rad s-1"},
                    {"damping", modes.damping[k]},
                    {"shape", shape}});
  }
  return list;
}

Json number_json(double value) {
  return std::isnan(value) ? Json() : Json(value);
}

Json gradient_json(const PointGradient& gradient) {
  Json by = Json::object();
  for (const auto& [parameter, unit, derivatives] : gradient.by) {
    Json quantities = Json::object();
    for (std::size_t i = 0; i < derivatives.size(); ++i) {
      const periodic::DerivativeCheck& check = derivatives[i];
      Json json{{"exact", number_json(check.exact)},
                {"difference", number_json(check.difference)},
                {"relative_difference", number_json(check.relative_difference())},
                {"uncertainty_of_difference", number_json(check.uncertainty)}};
      if (!check.why_none.empty()) json["reason"] = check.why_none;
      quantities[gradient.quantities[i].name] = json;
    }
    by[parameter] = {{"unit", unit}, {"quantities", quantities}};
  }
  return {{"reason", gradient.reason}, {"by", by}};
}

Json numbers_json(const std::vector<FoundResponse::Number>& numbers) {
  Json json = Json::object();
  for (const FoundResponse::Number& each : numbers)
    json[each.name] = {{"value", number_json(each.value)}, {"unit", each.unit}};
  return json;
}

Json responses_json(const std::vector<FoundResponse>& responses) {
  Json list = Json::array();
  for (const FoundResponse& each : responses) {
    Json multipliers = Json::array();
    for (const std::complex<double>& value : each.multipliers)
      multipliers.push_back({number_json(value.real()), number_json(value.imag())});
    list.push_back({{"shown", each.is_shown},
                    {"period_multiple", each.period_multiple},
                    {"mirror_of", each.mirror_of ? Json(*each.mirror_of) : Json()},
                    {"peaks", numbers_json(each.peaks)},
                    {"multipliers", multipliers},
                    {"state", numbers_json(each.state)}});
  }
  return list;
}

}  // namespace

void print_point_json(const Study& study, const PointReport& report, std::ostream& out) {
  Json json{{"study", study.source.name}, {"title", study.title}};
  for (const auto& [name, spoken] : report.parameters) {
    json["parameters"][name] = {{"value", spoken.value}, {"unit", spoken.unit.empty() ? "1" : spoken.unit}};
  }
  json["status"] = report.status;
  json["reason"] = report.reason;
  json["residual"] = report.residual;
  json["why_no_error_bound"] = report.why_no_bound;
  json["continuum"] = report.continuum;
  json["newton_iterations"] = report.newton_iterations;
  json["passages"] = report.passages;
  json["found_by"] = way_name(report.way);
  for (const PointReport::QuantityValue& quantity : report.quantities) {
    json["quantities"][quantity.description.name] = quantity_json(quantity);
  }
  json["stretches"] = stretches_json(report);
  if (report.modes) {
    json["modes"]["sliding"] = modes_json(study, report.modes->sliding);
    json["modes"]["stuck"] = modes_json(study, report.modes->stuck);
  }
  if (report.responses) json["responses"] = responses_json(*report.responses);
  if (report.gradient) json["gradient"] = gradient_json(*report.gradient);
  // A path need not be UTF-8, which JSON must be.
  out << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
}

}  // namespace frahm::studies
