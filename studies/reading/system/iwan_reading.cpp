#include "studies/reading/system/iwan_reading.hpp"

#include <fmt/format.h>

#include "solvers/laws/iwan.hpp"
#include "studies/reading/keys/element_keys.hpp"
#include "studies/reading/quantities/expression.hpp"
#include "studies/reading/system/network_reading.hpp"
#include "studies/reading/text/toml_reading.hpp"

// An iwan element: sliders side by side, each a jenkins element.
namespace frahm::studies {
namespace {

Quantity stiffness_of(bool rotational) {
  return rotational ? Quantity::torsional_stiffness : Quantity::stiffness;
}
Quantity force_of(bool rotational) {
  return rotational ? Quantity::torque : Quantity::force;
}

std::vector<StudyValue> read_list(NetworkReading& reading, const TomlSection& section, const char* key,
                                  Quantity quantity, Range range) {
  const auto* list = section.require(key).as<TomlArray>();
  if (!list) section.fail(rules::wrong_type, key, "expected a list with a value for each slider");
  if (list->empty()) section.fail(rules::empty, key, "has no slider");
  std::vector<StudyValue> values;
  for (const TomlValue& value : *list) {
    const std::string where = fmt::format("{}: {}: {}", section.where(), key, values.size() + 1);
    values.push_back(read_value_at(reading, where, value, quantity, range));
  }
  return values;
}

std::vector<StudySlider> listed_sliders(NetworkReading& reading, const TomlSection& section,
                                        bool rotational) {
  for (const char* key : {"stiffness", "force", "elements", "chi"}) {
    if (section.find(key))
      section.fail(rules::key_without_use, key, "belongs to a distribution, but the sliders are listed here");
  }
  const auto stiffnesses =
      read_list(reading, section, "stiffnesses", stiffness_of(rotational), range_of_type(iwan, "stiffness"));
  const auto forces =
      read_list(reading, section, "forces", force_of(rotational), range_of_type(iwan, "force"));
  if (stiffnesses.size() != forces.size())
    section.fail(rules::beyond_schema(rules::wrong_length), "forces",
                 "{} for {} stiffnesses; each slider needs one of each", forces.size(), stiffnesses.size());
  std::vector<StudySlider> sliders;
  for (std::size_t i = 0; i < forces.size(); ++i) sliders.push_back({stiffnesses[i], forces[i]});
  return sliders;
}

double read_exponent(const TomlSection& section, bool is_power) {
  if (!is_power) {
    if (section.find("chi"))
      section.fail(rules::key_without_use, "chi", "only the distribution \"power\" has an exponent");
    return 0.0;
  }
  return section.number("chi");  // beyond 100 all slip forces are one but for the last digits
}

StudyValue scaled(StudyValue value, double share) {
  value.expression = value.expression * Expression(share);
  return value;
}

std::vector<StudySlider> spread_sliders(NetworkReading& reading, const TomlSection& section,
                                        bool rotational) {
  for (const char* key : {"stiffnesses", "forces"}) {
    if (section.find(key))
      section.fail(rules::one_of_two_keys, key,
                   "the element already has a distribution; give only one of the two");
  }
  const bool is_power = section.choice("distribution") == "power";
  const double chi = read_exponent(section, is_power);
  const std::int64_t n = section.integer("elements");
  const StudyValue stiffness =
      read_value(reading, section, "stiffness", stiffness_of(rotational), range_of_type(iwan, "stiffness"));
  const StudyValue force =
      read_value(reading, section, "force", force_of(rotational), range_of_type(iwan, "force"));
  std::vector<StudySlider> sliders;
  for (const laws::IwanShare& share : laws::iwan_shares(static_cast<int>(n), chi))
    sliders.push_back({scaled(stiffness, share.stiffness), scaled(force, share.force)});
  return sliders;
}

}  // namespace

std::vector<StudySlider> read_sliders(NetworkReading& reading, const TomlSection& section, bool rotational) {
  if (section.find("distribution")) return spread_sliders(reading, section, rotational);
  if (!section.find("stiffnesses") && !section.find("forces"))
    section.fail_here(rules::one_of_two_keys,
                      "its sliders are missing: stiffnesses and forces, or a distribution = \"uniform\"");
  return listed_sliders(reading, section, rotational);
}

}  // namespace frahm::studies
