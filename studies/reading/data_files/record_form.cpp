#include "studies/reading/data_files/record_form.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "solvers/mechanics/rotation.hpp"
#include "studies/reading/text/spelling.hpp"

namespace frahm::studies {
namespace {

using Method = IdentifyMethod;

constexpr std::size_t two_rows = 2;

Role required(std::string name, Quantity quantity, Range range = Range::finite) {
  return {std::move(name), quantity, range};
}

Role increasing(std::string name, Quantity quantity, Range range = Range::finite) {
  return {std::move(name), quantity, range, true, true};
}

Role optional(std::string name, Quantity quantity, Range range = Range::finite) {
  return {std::move(name), quantity, range, false};
}

RecordForm trace(std::vector<Role> roles) {
  roles.insert(roles.begin(), increasing("time", Quantity::time));
  return {std::move(roles), two_rows, true};
}

RecordForm response_curve() {
  return {{increasing("frequency", Quantity::angular_frequency, Range::positive),
           required("amplitude", Quantity::length, Range::positive)},
          two_rows};
}

// The forms of a free vibration of one mass: as sampled, or its extremes alone.
std::vector<RecordForm> decay_forms() {
  Role extremum_time = increasing("extremum_time", Quantity::time);
  extremum_time.required = false;
  return {trace({required("displacement", Quantity::length)}),
          {{required("extremum", Quantity::length), extremum_time}, two_rows}};
}

std::vector<RecordForm> half_power_forms() {
  const auto frequency = [](const char* name) {
    return required(name, Quantity::angular_frequency, Range::positive);
  };
  return {response_curve(),
          {{frequency("natural_frequency"), frequency("lower_frequency"), frequency("upper_frequency")}}};
}

std::vector<RecordForm> magnification_forms() {
  return {response_curve(),
          {{required("static_displacement", Quantity::length, Range::positive),
            required("resonant_displacement", Quantity::length, Range::positive)}}};
}

std::vector<RecordForm> resonance_forms(CurveOf curve) {
  const Role excitation = curve == CurveOf::support ? required("support", Quantity::length, Range::positive)
                                                    : required("force", Quantity::force, Range::positive);
  return {{{required("response", Quantity::length, Range::positive), excitation}, two_rows},
          {{required("slope", Quantity::number, Range::positive), required("intercept", Quantity::length)}}};
}

std::vector<RecordForm> energy_forms() {
  return {{{required("amplitude", Quantity::length, Range::positive), required("energy", Quantity::energy),
            required("frequency", Quantity::angular_frequency, Range::positive),
            optional("velocity_rms", Quantity::speed, Range::positive)},
           two_rows}};
}

std::vector<RecordForm> added_mass_forms() {
  return {trace({required("displacement", Quantity::length)}),
          {{required("added_mass", Quantity::mass, Range::not_negative),
            required("frequency", Quantity::angular_frequency, Range::positive),
            optional("frequency_error", Quantity::angular_frequency, Range::positive)},
           two_rows}};
}

std::vector<RecordForm> grey_box_forms(const mechanics::Network& network) {
  std::vector<Role> roles;
  for (std::size_t i = 0; i < network.masses.size(); ++i) {
    const std::string& mass = network.masses[i];
    const bool turns = mechanics::rotates(network, i);
    roles.push_back(optional(mass + "_displacement", turns ? Quantity::angle : Quantity::length));
    roles.push_back(optional(mass + "_velocity", turns ? Quantity::angular_frequency : Quantity::speed));
    roles.push_back(
        optional(mass + "_acceleration", turns ? Quantity::angular_acceleration : Quantity::acceleration));
  }
  for (std::size_t i = 0; i < network.masses.size(); ++i)
    roles.push_back(optional(network.masses[i] + "_force",
                             mechanics::rotates(network, i) ? Quantity::torque : Quantity::force));
  for (const std::string& support : network.prescribed)
    roles.push_back(optional(support + "_displacement", Quantity::length));
  return {trace(std::move(roles))};
}

std::size_t required_there(const RecordForm& form, const std::vector<std::string>& found) {
  return static_cast<std::size_t>(std::count_if(form.roles.begin(), form.roles.end(), [&](const Role& role) {
    return role.required && std::find(found.begin(), found.end(), role.name) != found.end();
  }));
}

std::size_t required_in_all(const RecordForm& form) {
  return static_cast<std::size_t>(
      std::count_if(form.roles.begin(), form.roles.end(), [](const Role& role) { return role.required; }));
}

}  // namespace

const Role* RecordForm::find(const std::string& name) const {
  const auto role =
      std::find_if(roles.begin(), roles.end(), [&](const Role& each) { return each.name == name; });
  return role == roles.end() ? nullptr : &*role;
}

std::vector<RecordForm> record_forms(const Study& study) {
  switch (study.identify()->method) {
    case Method::half_power:
      return half_power_forms();
    case Method::resonance_magnification:
      return magnification_forms();
    case Method::log_decrement:
    case Method::free_decay:
      return decay_forms();
    case Method::forced_resonance:
      return resonance_forms(study.identify()->curve);
    case Method::energy_balance:
      return energy_forms();
    case Method::hysteresis_loop:
      return {trace({required("displacement", Quantity::length), required("force", Quantity::force)})};
    case Method::added_mass:
      return added_mass_forms();
    case Method::grey_box:
      break;
  }
  return grey_box_forms(study.network);
}

std::vector<std::string> role_names(const std::vector<RecordForm>& forms) {
  std::vector<std::string> names;
  bool tables = false;
  for (const RecordForm& form : forms) {
    for (const Role& role : form.roles) {
      if (std::find(names.begin(), names.end(), role.name) == names.end()) names.push_back(role.name);
    }
    tables = tables || !form.is_trace;
  }
  if (tables) names.emplace_back(label_role);
  names.emplace_back(doubtful_role);
  return names;
}

const RecordForm& form_of(const std::vector<RecordForm>& forms, const std::vector<std::string>& found) {
  for (const RecordForm& form : forms) {
    if (required_there(form, found) == required_in_all(form)) return form;
  }
  return *std::max_element(forms.begin(), forms.end(), [&](const RecordForm& a, const RecordForm& b) {
    return required_there(a, found) < required_there(b, found);
  });
}

std::string described(const RecordForm& form) {
  std::vector<std::string> must, may;
  for (const Role& role : form.roles) (role.required ? must : may).push_back(role.name);
  std::string text = listed(must, " and ");
  if (!may.empty()) text += fmt::format(", and any of {}", listed(may, " and "));
  return text;
}

bool is_excitation(const Study& study, const std::string& role) {
  const auto names = [&](const std::vector<std::string>& nodes, const char* ending) {
    return std::any_of(nodes.begin(), nodes.end(),
                       [&](const std::string& node) { return role == node + ending; });
  };
  return names(study.network.masses, "_force") || names(study.network.prescribed, "_displacement");
}

bool is_motion(const Study& study, const std::string& role) {
  return role != "time" && !is_excitation(study, role);
}

}  // namespace frahm::studies
