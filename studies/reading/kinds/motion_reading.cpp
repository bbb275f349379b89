#include "studies/reading/kinds/motion_reading.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "solvers/mechanics/rotation.hpp"
#include "solvers/transient/forced_motion.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/map/output_reading.hpp"
#include "studies/reading/quantities/expression.hpp"
#include "studies/reading/quantities/parameters.hpp"
#include "studies/reading/study/study_values.hpp"
#include "studies/reading/system/network_reading.hpp"
#include "studies/reading/system/unfit_elements.hpp"

namespace frahm::studies {
namespace {

using mechanics::NodeKind;

InitialValues read_initial_values(NetworkReading& reading, const TomlValue& table, std::size_t number) {
  const TomlSection section(reading.context.source, table,
                            label(table, "initial values of", "node", "initial", number), "initial");
  const auto& network = reading.result.network;
  const mechanics::Node node = read_mass(section, network, "node", "only a mass has initial values");
  const bool turns = mechanics::rotates(network, node.index);
  const Quantity displacement = turns ? Quantity::angle : Quantity::length;
  const Quantity velocity = turns ? Quantity::angular_frequency : Quantity::speed;
  return {node.index, read_value(reading, section, "displacement", displacement, 0.0),
          read_value(reading, section, "velocity", velocity, 0.0)};
}

std::vector<InitialValues> read_initial(NetworkReading& reading, const TomlValue& root) {
  std::vector<InitialValues> initial;
  std::size_t number = 0;
  for (const TomlValue* table : read_tables(reading.context.source, root, "initial")) {
    InitialValues values = read_initial_values(reading, *table, ++number);
    const bool twice = std::any_of(initial.begin(), initial.end(),
                                   [&](const InitialValues& other) { return other.mass == values.mass; });
    if (twice) {
      throw reading.context.source.error_at(rules::given_twice, table->position,
                                            "initial values of \"{}\": are already given",
                                            reading.result.network.masses[values.mass]);
    }
    initial.push_back(std::move(values));
  }
  return initial;
}

void read_decay(NetworkReading& reading, const TomlValue& root, DecayChoice& motion) {
  static const TomlValue nothing{{}, TomlTable{}};
  const TomlEntry* entry = find_entry(root, "decay");
  const TomlSection section(reading.context.source, entry ? entry->value : nothing, "[decay]", "decay");
  motion.duration = read_optional(reading, section, "duration", Quantity::time);
  motion.samples = static_cast<int>(section.integer("samples"));
  motion.reference_frequency =
      read_optional(reading, section, "reference_frequency", Quantity::angular_frequency);
}

// A run-up sets the frequency's parameter, if there is one, so the frequency must be that parameter alone.
void check_run_up(const NetworkReading& reading, const TomlSection& section) {
  const Parameters& parameters = reading.parameters;
  const auto& forces = reading.result.network.excitations;
  if (mechanics::has_records(reading.result.network))
    section.fail(rules::beyond_schema(rules::key_without_use), "sweep_to",
                 "a run-up consists of steps of constant frequency, but a record ([[excitation.record]]) "
                 "or a list of corners runs in its own time; leave out one of them");
  if (transient::asks_where_belts_are(reading.result.network))
    section.fail(
        rules::beyond_schema(rules::key_without_use), "sweep_to",
        "a run-up consists of steps of constant frequency, but an element or a signal asks where a node "
        "of constant velocity is, which moves on in its own time; leave out one of them");
  if (std::all_of(forces.begin(), forces.end(), [](const auto& force) { return force.order == 0; }))
    section.fail(rules::beyond_schema(rules::key_without_use), "sweep_to",
                 "the excitation is constant, so it has no frequency that could run");
  const Expression& frequency = reading.result.values.omega.expression;
  const auto sole = frequency.sole_parameter();
  const bool is_parameter = sole && parameters.list[*sole].is_number();
  if (!is_parameter && !frequency.reads().empty()) {
    section.fail(rules::wrong_dependence, "sweep_to",
                 "the excitation's frequency is computed from parameters; in a run-up it must be a number, "
                 "or one parameter, which then runs");
  }
  if (!is_parameter) return;
  const auto& [network, values, driving] = reading.result;
  for (std::size_t i = 0; i < network.excitations.size(); ++i) {
    if (network.excitations[i].kind == mechanics::ExcitationKind::force) continue;
    for (const StudyValue* value : {&values.amplitude[i], &values.phase[i], &values.rod[i]}) {
      const auto inputs = parameters.inputs_of(value->expression.reads());
      if (std::find(inputs.begin(), inputs.end(), *sole) == inputs.end()) continue;
      throw section.source().error_at(
          rules::wrong_dependence, value->position,
          "{}: depends on \"{}\", which runs from the frequency to sweep_to; only "
          "the motion's frequency may change in a run-up",
          value->where, parameters.list[*sole].name);
    }
  }
}

void read_transient(NetworkReading& reading, const TomlValue& root, TransientChoice& motion) {
  const TomlSection section(reading.context.source, find_entry(root, "transient")->value, "[transient]",
                            "transient");
  motion.duration = read_optional(reading, section, "duration", Quantity::time);
  motion.samples = static_cast<int>(section.integer("samples"));
  motion.sweep_to = read_optional(reading, section, "sweep_to", Quantity::angular_frequency);
  motion.sweep_rate = read_optional(reading, section, "sweep_rate", Quantity::angular_acceleration);
  if (motion.sweep_to) check_run_up(reading, section);
  if (!motion.duration && !motion.sweep_to && !mechanics::has_records(reading.result.network))
    section.fail_here(rules::beyond_schema(rules::missing_key),
                      "the key \"duration\" is missing (a time, s)");
}

}  // namespace

// The energies of a motion are recorded next to those of its elements, <element>_energy.
static void refuse_names_of_energies(const StudyContext& context, const Study& study) {
  const auto& elements = study.network.elements;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const std::string& name = elements[e].name;
    if (name != "initial" && name != "final") continue;
    throw context.source.error_at(
        rules::name_taken, study.values.value(e).position,
        "element \"{}\": the record of a motion already has a number {}_energy; rename the element", name,
        name);
  }
}

void read_motion(const StudyContext& context, const TomlValue& root, Study& study) {
  refuse_smooth_laws(study, kind_noun(study.kind()));
  if (!study.identify()) refuse_names_of_energies(context, study);
  NetworkReading reading(context, study.parameters);
  reading.result = {study.network, study.values};
  std::vector<InitialValues> initial = read_initial(reading, root);
  if (IdentifyChoice* identify = study.identify())
    identify->initial = std::move(initial);
  else if (MotionChoice* motion = study.motion())
    motion->initial = std::move(initial);
  if (auto* decay = std::get_if<DecayChoice>(&study.choice)) read_decay(reading, root, *decay);
  if (auto* transient = std::get_if<TransientChoice>(&study.choice))
    read_transient(reading, root, *transient);
}

void read_motion_output(const StudyContext& context, const TomlValue& root, Study& study) {
  const TomlEntry* entry = find_entry(root, "output");
  if (!entry) return;
  const TomlSection section(context.source, entry->value, "[output]", "output", kind_name(study.kind()));
  read_stored(section, *study.map());
  read_histories(context, section, "histories", study);
}

}  // namespace frahm::studies
