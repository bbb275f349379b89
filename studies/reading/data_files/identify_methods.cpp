#include "studies/reading/data_files/identify_methods.hpp"

#include <string>
#include <utility>

#include "solvers/mechanics/rotation.hpp"

namespace frahm::studies {
namespace {

using Method = IdentifyMethod;
using Q = Quantity;

constexpr std::size_t two_rows = 2;

RecordForm table(std::vector<Role> roles, std::size_t least_rows = 1) {
  return {std::move(roles), least_rows};
}

RecordForm trace(std::vector<Role> roles) {
  roles.insert(roles.begin(), {.name = "time", .quantity = Q::time, .increases = true});
  return {std::move(roles), two_rows, true};
}

RecordForm response_curve() {
  return table(
      {{.name = "frequency", .quantity = Q::angular_frequency, .range = Range::positive, .increases = true},
       {"amplitude", Q::length, Range::positive}},
      two_rows);
}

RecordForm with_key(const char* key, const char* meaning, RecordForm form) {
  form.key = key;
  form.meaning_of_key = meaning;
  return form;
}

Role optional(std::string name, Quantity quantity, Range range = Range::finite) {
  return {std::move(name), quantity, range, false};
}

// The forms of a free vibration of one mass: as sampled, or its extremes alone.
std::vector<RecordForm> decay_forms() {
  return {trace({{"displacement", Q::length}}),
          table({{"extremum", Q::length},
                 {.name = "extremum_time", .quantity = Q::time, .required = false, .increases = true}},
                two_rows)};
}

// Of a grey box: time, and <mass>_displacement, <mass>_velocity, <mass>_acceleration, <mass>_force and
// <support>_displacement.
RecordForm traces_of(const mechanics::Network& network) {
  std::vector<Role> roles, rest;
  for (std::size_t i = 0; i < network.masses.size(); ++i) {
    const std::string& mass = network.masses[i];
    const bool turns = mechanics::rotates(network, i);
    roles.push_back(optional(mass + "_displacement", turns ? Q::angle : Q::length));
    roles.push_back(optional(mass + "_velocity", turns ? Q::angular_frequency : Q::speed));
    roles.push_back(optional(mass + "_acceleration", turns ? Q::angular_acceleration : Q::acceleration));
    rest.push_back(optional(mass + "_force", turns ? Q::torque : Q::force));
  }
  for (const std::string& support : network.prescribed)
    rest.push_back(optional(support + "_displacement", Q::length));
  roles.insert(roles.end(), rest.begin(), rest.end());
  return trace(std::move(roles));
}

// More estimates, on a condition.
std::string only_if(bool holds, const char* names) {
  return holds ? names : "";
}

}  // namespace

MethodRow method_row(const Study& study) {
  using enum Range;
  const IdentifyChoice& choice = *study.identify();
  const bool mass = choice.mass.has_value(), stiffness = choice.stiffness.has_value();
  const bool by_support = choice.curve == CurveOf::support;
  const bool is_curve = choice.records.front().find("amplitude");  // otherwise each row has its own answer
  switch (choice.method) {
    case Method::half_power:
      return {.forms = {response_curve(), table({{"natural_frequency", Q::angular_frequency, positive},
                                                 {"lower_frequency", Q::angular_frequency, positive},
                                                 {"upper_frequency", Q::angular_frequency, positive}})},
              .estimates = only_if(is_curve,
                                   "damping_ratio|damping_ratio_first_order|peak_frequency|natural_frequency|"
                                   "lower_frequency|upper_frequency")};
    case Method::resonance_magnification:
      return {.forms = {with_key("static_displacement",
                                 "for a response curve of the method \"resonance_magnification\" it is the "
                                 "displacement at rest under the force, or the amplitude of the support",
                                 response_curve()),
                        table({{"static_displacement", Q::length, positive},
                               {"resonant_displacement", Q::length, positive}})},
              .estimates = "damping_ratio|damping_ratio_first_order" +
                           only_if(is_curve, "|peak_frequency|peak_amplitude")};
    case Method::log_decrement:
      return {
          .forms = decay_forms(),
          .estimates =
              "log_decrement|damping_ratio|damping_ratio_first_order|damped_frequency|natural_frequency|"
              "log_decrement_over_cycles|damping_ratio_over_cycles|damping_ratio_first_order_over_cycles"};
    case Method::free_decay:
      return {.forms = decay_forms(),
              .estimates =
                  "damping_ratio|friction_displacement|natural_frequency|damped_frequency|"
                  "damping_ratio_first|friction_displacement_first" +
                  only_if(choice.sensor_offset, "|offset") +
                  only_if(mass || stiffness, "|damping|friction_force") + only_if(mass, "|stiffness") +
                  only_if(stiffness, "|mass")};
    case Method::forced_resonance:
      return {
          .forms = {table({{"response", Q::length, positive},
                           {by_support ? "support" : "force", by_support ? Q::length : Q::force, positive}},
                          two_rows),
                    table({{"slope", Q::number, positive}, {"intercept", Q::length}})},
          .estimates =
              "slope|intercept|damping_ratio_line|friction_displacement_line|damping_ratio|"
              "friction_displacement" +
              only_if(mass && stiffness, "|damping|damping_line") +
              only_if(stiffness, "|friction_force|friction_force_line")};
    case Method::energy_balance:
      return {.forms = {table({{"amplitude", Q::length, positive},
                               {"energy", Q::energy},
                               {"frequency", Q::angular_frequency, positive},
                               optional("velocity_rms", Q::speed, positive)},
                              two_rows)},
              .estimates = "damping|friction_force"};
    case Method::hysteresis_loop:
      return {.forms = {trace({{"displacement", Q::length}, {"force", Q::force}})},
              .estimates =
                  "energy_loss|amplitude|frequency|storage_stiffness|loss_factor|equivalent_damping|"
                  "equivalent_friction"};
    case Method::added_mass:
      return {.forms = {with_key("added_mass",
                                 "it is the mass added while the trace of a record of the method "
                                 "\"added_mass\" was taken; 0 if none was",
                                 trace({{"displacement", Q::length}})),
                        table({{"added_mass", Q::mass, not_negative},
                               {"frequency", Q::angular_frequency, positive},
                               optional("frequency_error", Q::angular_frequency, positive)},
                              two_rows)},
              .estimates = "mass|stiffness",
              .several_traces = true};
    case Method::grey_box:
      break;
  }
  return {.forms = {traces_of(study.network)}, .several_traces = true};
}

}  // namespace frahm::studies
