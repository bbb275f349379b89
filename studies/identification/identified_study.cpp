#include "studies/identification/identified_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "results/map_reader.hpp"
#include "solvers/periodic/linear_modes.hpp"
#include "studies/identification/identification_record.hpp"
#include "studies/map/stored_study.hpp"
#include "studies/motion/motion_record.hpp"
#include "studies/reading/settings.hpp"
#include "studies/reading/toml_writing.hpp"

namespace frahm::studies {
namespace {

constexpr double kFromMode = 0.5, kToMode = 1.5;  // of the lowest and highest natural frequency
constexpr std::int64_t kPoints = 401;

TomlValue text(const std::string& value) {
  return {{}, value};
}

TomlValue number(double value) {
  return {{}, value};
}

TomlEntry* find(TomlTable& table, const std::string& key) {
  const auto entry = std::find_if(table.begin(), table.end(), [&](auto& each) { return each.key == key; });
  return entry == table.end() ? nullptr : &*entry;
}

TomlTable& table_of(TomlTable& root, const std::string& key) {
  return std::get<TomlTable>(find(root, key)->value.content);
}

TomlValue with_unit(const StudyFile& study, std::size_t parameter, double si) {
  const SpokenValue spoken = spoken_value(study, parameter, si);
  if (spoken.unit.empty()) return number(spoken.value);
  return {{}, TomlTable{{"value", {}, number(spoken.value)}, {"unit", {}, text(spoken.unit)}}};
}

struct Stored {
  StudyFile study;
  std::vector<Assignment> overrides;
  std::vector<results::Column> columns;
  std::string name;  // of the file

  // Empty: there is none.
  std::vector<double> column(const std::string& of) const {
    const auto found = std::find_if(columns.begin(), columns.end(),
                                    [&](const results::Column& each) { return each.variable.name == of; });
    return found == columns.end() ? std::vector<double>{} : found->values;
  }
  // NaN: there is none.
  double value(const std::string& of) const {
    const std::vector<double> values = column(of);
    return values.empty() ? std::nan("") : values.front();
  }
};

Stored read(const std::filesystem::path& file) {
  const results::MapReader result(file);
  if (!result.has_group(identification_group))
    throw StudyError(fmt::format("{}: is not the result of an identification", file.string()));
  StoredStudy stored = read_stored_study(result, file);
  return {std::move(stored.study), std::move(stored.overrides), result.columns(identification_group),
          file.string()};
}

// All parameters that the identification settles, with their values; a later one counts. Of one that every
// record has for itself, that of the first record.
std::vector<Assignment> settled(const Stored& stored) {
  const IdentifyChoice& choice = *stored.study.identify;
  const RecordChoice& first = choice.records.front();
  std::vector<Assignment> all = stored.overrides;
  all.insert(all.end(), first.set.begin(), first.set.end());
  for (std::size_t i = 0; i < stored.study.parameters.list.size(); ++i) {
    const double value = stored.value(stored.study.parameters.list[i].name);
    if (!std::isnan(value)) all.push_back({i, value});
  }
  for (const IdentifiedParameter& fitted : choice.parameters) {
    std::string estimate = stored.study.parameters.list[fitted.parameter].name;
    if (fitted.each_record) estimate += "_" + first.name;
    const double value = stored.value(estimate);
    if (std::isnan(value))
      throw StudyError(
          fmt::format("{}: the data do not determine {}, which the study needs", stored.name, estimate));
    all.push_back({fitted.parameter, value});
  }
  return all;
}

void set_kind(TomlTable& root, StudyKind kind) {
  find(table_of(root, "study"), "kind")->value = text(std::string(kind_name(kind)));
}

void remove(TomlTable& root, const std::string& key) {
  std::erase_if(root, [&](const TomlEntry& entry) { return entry.key == key; });
}

// A sweep of the frequency, a parameter, over the modes of the system as identified.
void make_sweep(const StudyFile& study, const std::vector<double>& parameters, std::size_t frequency,
                TomlTable& root) {
  mechanics::NetworkValues values;
  std::vector<double> at = parameters;
  evaluate(study.values, study.parameters, at, values);
  const std::vector<double> modes = periodic::linear_modes(study.network, values, false).frequency;
  const SpokenValue from = spoken_value(study, frequency, kFromMode * modes.front());
  const SpokenValue to = spoken_value(study, frequency, kToMode * modes.back());
  TomlTable axis{{"parameter", {}, text(study.parameters.list[frequency].name)}};
  if (!from.unit.empty()) axis.push_back({"unit", {}, text(from.unit)});
  axis.push_back({"from", {}, number(from.value)});
  axis.push_back({"to", {}, number(to.value)});
  axis.push_back({"points", {}, {{}, kPoints}});
  set_kind(root, StudyKind::sweep);
  remove(root, "initial");
  root.push_back({"axis", {}, {{}, TomlArray{{{}, std::move(axis)}}}});
}

// The motion of the first record, sampled as it was.
void make_motion(const Stored& stored, TomlTable& root) {
  const std::vector<double> time = stored.column(stored.study.identify->records.front().name + "_time");
  const bool driven = find(root, "excitation") != nullptr;
  TomlTable motion;
  if (time.size() > 1) {
    motion.push_back({"duration", {}, number(time.back() - time.front())});
    motion.push_back({"samples", {}, {{}, static_cast<std::int64_t>(time.size())}});
  }
  set_kind(root, driven ? StudyKind::transient : StudyKind::decay);
  root.push_back({driven ? "transient" : "decay", {}, {{}, std::move(motion)}});
}

std::string study_of_system(const Stored& stored) {
  const StudyFile& study = stored.study;
  TomlValue document = read_toml(study.source);
  TomlTable& root = std::get<TomlTable>(document.content);
  remove(root, "identify");
  std::vector<double> parameters = study.parameters.nominal();
  for (const Assignment& assignment : settled(stored)) {
    TomlTable& definitions = table_of(root, "parameters");
    find(definitions, study.parameters.list[assignment.parameter].name)->value =
        with_unit(study, assignment.parameter, assignment.value);
    parameters[assignment.parameter] = assignment.value;
  }
  const auto frequency = study.values.omega.expression.sole_parameter();
  const bool driven = find(root, "excitation") != nullptr;
  if (driven && frequency && study.parameters.list[*frequency].is_number()) {
    make_sweep(study, parameters, *frequency, root);
  } else {
    make_motion(stored, root);
  }
  return toml_text(document);
}

// m x'' + c x' + k x + F Sgn(x') = P cos(omega t), of which mass, ratio, frequency and friction were found.
std::string study_of_one_mass(const Stored& stored) {
  const StudyFile& study = stored.study;
  const IdentifyChoice& choice = *study.identify;
  const double zeta = stored.value("damping_ratio");
  if (std::isnan(zeta)) {
    throw StudyError(
        fmt::format("{}: the method {} finds no damping ratio of one mass; describe the system in the study "
                    "([[mass]], [[element]]) and name in [[identify.parameter]] which estimate each of its "
                    "parameters takes",
                    stored.name, method_name(choice.method)));
  }
  double mass = choice.mass ? stated(study, *choice.mass) : stored.value("mass");
  double omega = stored.value("natural_frequency");
  const double stiffness = choice.stiffness ? stated(study, *choice.stiffness) : stored.value("stiffness");
  if (std::isnan(omega) && mass > 0.0 && stiffness > 0.0) omega = std::sqrt(stiffness / mass);
  const bool dimensionless = study.dimensionless || std::isnan(omega);
  if (dimensionless) mass = omega = 1.0;
  if (std::isnan(mass)) mass = stiffness > 0.0 ? stiffness / (omega * omega) : 1.0;
  const double k = mass * omega * omega, c = 2.0 * zeta * mass * omega;
  const double x_f = stored.value("friction_displacement"),
               F = std::max(0.0, std::isnan(x_f) ? 0.0 : k * x_f);
  const double P =
      F > 0.0 ? 4.0 * F : k * 1e-3;  // well above friction; else a millimetre of static displacement
  return fmt::format(R"([study]
schema = 1
kind = "sweep"
title = "{}"
units = "{}"

[parameters]
omega = {:.17g}
c = {:.17g}
F = {:.17g}
P = {:.17g}

[[mass]]
name = "mass"
mass = {:.17g}

[[element]]
name = "spring"
type = "spring"
between = ["ground", "mass"]
stiffness = {:.17g}

[[element]]
name = "damper"
type = "damper"
between = ["ground", "mass"]
damping = "c"

[[element]]
name = "friction"
type = "coulomb"
between = ["ground", "mass"]
force = "F"

[excitation]
frequency = "omega"
[[excitation.force]]
on = "mass"
amplitude = "P"

[[axis]]
parameter = "omega"
from = {:.17g}
to = {:.17g}
points = {}
)",
                     "The mass whose damping was identified", dimensionless ? "dimensionless" : "SI", omega,
                     c, F, P, mass, k, kFromMode * omega, kToMode * omega, kPoints);
}

}  // namespace

std::string identified_study(const std::filesystem::path& file) {
  const Stored stored = read(file);
  const std::string study =
      stored.study.network.masses.empty() ? study_of_one_mass(stored) : study_of_system(stored);
  return std::string(identified_mark) + "\n" + study;
}

}  // namespace frahm::studies
