#include "studies/identification/identified_study.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "results/map_reader.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "solvers/mechanics/modes.hpp"
#include "studies/identification/identification_columns.hpp"
#include "studies/motion/one_motion.hpp"
#include "studies/provenance/stored_study.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_units.hpp"
#include "studies/reading/study/toml_building.hpp"
#include "studies/reading/text/toml_reading.hpp"
#include "studies/reading/text/toml_writing.hpp"

namespace frahm::studies {
namespace {

constexpr double kFromMode = 0.5, kToMode = 1.5;  // of the lowest and highest natural frequency
constexpr std::int64_t kPoints = 401;

TomlTable& table_of(TomlTable& root, const std::string& key) {
  return std::get<TomlTable>(entry_of(root, key)->value.content);
}

struct Stored {
  Study study;
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
    throw StudyError(rules::wrong_file, "{}: is not the result of an identification", file.string());
  StoredStudy stored = read_stored_study(result, file);
  return {std::move(stored.study), std::move(stored.overrides), result.columns(identification_group),
          file.string()};
}

// All parameters that the identification determines, with their values; a later value counts. For a parameter
// with a value in each record, that of the first record.
std::vector<Assignment> settled(const Stored& stored) {
  const IdentifyChoice& choice = *stored.study.identify();
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
      throw StudyError(rules::not_computed, "{}: the data do not determine {}, which the study needs",
                       stored.name, estimate);
    all.push_back({fitted.parameter, value});
  }
  return all;
}

void set_kind(TomlTable& root, StudyKind kind) {
  entry_of(table_of(root, "study"), "kind")->value = toml_string(std::string(kind_name(kind)));
}

void remove(TomlTable& root, const std::string& key) {
  std::erase_if(root, [&](const TomlEntry& entry) { return entry.key == key; });
}

// A name that no parameter has yet.
std::string free_name(const Study& study, std::string name) {
  while (study.parameters.find(name)) name += "_";
  return name;
}

mechanics::NetworkValues values_at(const Study& study, std::vector<double> parameters) {
  mechanics::NetworkValues values;
  evaluate(study.values, study.parameters, parameters, values);
  return values;
}

// [[axis]] over the modes of the system as identified.
void add_axis(const std::string& parameter, const std::string& unit, double factor,
              const std::vector<double>& modes, TomlTable& root) {
  TomlTable axis{{"parameter", {}, toml_string(parameter)}};
  if (!unit.empty()) axis.push_back({"unit", {}, toml_string(unit)});
  axis.push_back({"from", {}, toml_number(kFromMode * modes.front() / factor)});
  axis.push_back({"to", {}, toml_number(kToMode * modes.back() / factor)});
  axis.push_back({"points", {}, {{}, kPoints}});
  set_kind(root, StudyKind::sweep);
  remove(root, "initial");
  root.push_back({"axis", {}, {{}, TomlArray{{{}, std::move(axis)}}}});
}

// A force that moves the first mass well: a thousandth of its static stiffness, and beyond all friction.
double moving_force(const Study& study, const mechanics::NetworkValues& values) {
  mechanics::Network network = study.network;
  network.excitations.clear();
  mechanics::NetworkValues unexcited = values;
  unexcited.excitation.clear();
  const mechanics::Assembly assembly(network);
  mechanics::LinearSystem system;
  unexcited.omega = 1.0;
  if (!(unexcited.hysteretic_omega > 0.0)) unexcited.hysteretic_omega = 1.0;
  assembly.set_values(unexcited, system);
  const double compliance = system.K.inverse()(0, 0);
  const Eigen::VectorXd arms = system.W.cwiseAbs().colwise().maxCoeff().transpose();  // 1 without levers
  return std::max(1e-3 / compliance, 4.0 * arms.dot(system.limit));
}

// Puts a harmonic force on the first mass of a system that has no excitation except measured ones.
void drive(const Study& study, const mechanics::NetworkValues& values, const std::vector<double>& modes,
           TomlTable& root) {
  const std::string omega = free_name(study, "omega"), force = free_name(study, "P");
  if (!entry_of(root, "parameters")) root.push_back({"parameters", {}, {{}, TomlTable{}}});
  TomlTable& parameters = table_of(root, "parameters");
  parameters.push_back({omega, {}, toml_number(modes.front())});
  parameters.push_back({force, {}, toml_number(moving_force(study, values))});
  TomlTable on{{"on", {}, toml_string(study.network.masses.front())}, {"amplitude", {}, toml_string(force)}};
  TomlTable excitation{{"frequency", {}, toml_string(omega)}};
  excitation.push_back({"force", {}, {{}, TomlArray{{{}, std::move(on)}}}});
  root.push_back({"excitation", {}, {{}, std::move(excitation)}});
  add_axis(omega, "", 1.0, modes, root);
}

// The motion of the first record, sampled as it was.
void make_motion(const Stored& stored, TomlTable& root) {
  const std::vector<double> time = stored.column(stored.study.identify()->records.front().name + "_time");
  if (time.size() < 2)
    throw StudyError(
        rules::wrong_dependence,
        "{}: the excitation's frequency is computed from parameters, so there is no axis to sweep",
        stored.name);
  set_kind(root, StudyKind::transient);
  root.push_back({"transient",
                  {},
                  {{},
                   TomlTable{{"duration", {}, toml_number(time.back() - time.front())},
                             {"samples", {}, {{}, static_cast<std::int64_t>(time.size())}}}}});
}

std::string study_of_system(const Stored& stored) {
  const Study& study = stored.study;
  TomlValue document = read_toml(study.source);
  TomlTable& root = std::get<TomlTable>(document.content);
  remove(root, "identify");
  std::vector<double> parameters = study.parameters.nominal();
  for (const Assignment& assignment : settled(stored)) {
    TomlTable& definitions = table_of(root, "parameters");
    entry_of(definitions, study.parameters.list[assignment.parameter].name)->value =
        toml_parameter(study, assignment.parameter, assignment.value);
    parameters[assignment.parameter] = assignment.value;
  }
  const mechanics::NetworkValues values = values_at(study, parameters);
  const std::vector<double> modes = periodic::linear_modes(study.network, values, false).frequency;
  const auto frequency = study.values.omega.expression.sole_parameter();
  if (!entry_of(root, "excitation")) {
    drive(study, values, modes, root);
  } else if (frequency && study.parameters.list[*frequency].is_number()) {
    const SpokenValue one = spoken_value(study, *frequency, 1.0);
    add_axis(study.parameters.list[*frequency].name, one.unit, usual_unit(study, *frequency).si_factor, modes,
             root);
  } else {
    make_motion(stored, root);
  }
  return toml_text(document);
}

// m x'' + c x' + k x + F Sgn(x') = P cos(omega t), of which mass, ratio, frequency and friction were found.
std::string study_of_one_mass(const Stored& stored) {
  const Study& study = stored.study;
  const IdentifyChoice& choice = *study.identify();
  const double zeta = stored.value("damping_ratio");
  if (std::isnan(zeta)) {
    throw StudyError(rules::not_computed,
                     "{}: the method {} does not find the damping ratio of one mass; describe the system in "
                     "the study ([[mass]], [[element]]) and name in [[identify.parameter]] the estimate that "
                     "each of its parameters takes",
                     stored.name, method_name(choice.method));
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
      F > 0.0 ? 4.0 * F : k * 1e-3;  // well above friction; otherwise a millimetre of static displacement
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
  const std::string outcome = stored.value("outcome") == converged_outcome
                                  ? ""
                                  : "# The fit did not converge: these are the best values it found.\n";
  const std::string study =
      stored.study.network.masses.empty() ? study_of_one_mass(stored) : study_of_system(stored);
  return std::string(identified_mark) + "\n" + outcome + study;
}

}  // namespace frahm::studies
