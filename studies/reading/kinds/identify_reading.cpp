#include "studies/reading/kinds/identify_reading.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "studies/reading/data_files/identify_methods.hpp"
#include "studies/reading/keys/study_keys.hpp"
#include "studies/reading/kinds/fixed_estimates.hpp"
#include "studies/reading/kinds/identified_parameters.hpp"
#include "studies/reading/kinds/record_reading.hpp"
#include "studies/reading/study/study_values.hpp"
#include "studies/reading/system/network_reading.hpp"
#include "studies/reading/system/unfit_elements.hpp"
#include "studies/reading/text/spelling.hpp"

namespace frahm::studies {
namespace {

using Method = IdentifyMethod;

void read_method(const TomlSection& section, IdentifyChoice& choice) {
  choice.method = section.choice_as<Method>("method");
  choice.start = section.choice_as<IdentifyStart>("start");
  choice.curve = section.choice_as<CurveOf>("curve");
  choice.sensor_offset = section.boolean("sensor_offset");
  if (section.find("cycles")) choice.cycles = static_cast<std::size_t>(section.integer("cycles"));
}

void read_known_values(NetworkReading& reading, const TomlSection& section, IdentifyChoice& choice) {
  choice.mass = read_optional(reading, section, "mass", Quantity::mass);
  choice.stiffness = read_optional(reading, section, "stiffness", Quantity::stiffness);
  choice.reference_frequency =
      read_optional(reading, section, "reference_frequency", Quantity::angular_frequency);
}

// The file's name without its ending, as a name: "free decay-1.csv" -> free_decay_1.
std::string name_of(const std::filesystem::path& file) {
  std::string name = file.stem().string();
  for (char& c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!plain) c = '_';
  }
  return is_identifier(name) ? name : "record_" + name;
}

RecordChoice read_record_heading(NetworkReading& reading, const TomlSection& section,
                                 const IdentifyChoice& choice) {
  RecordChoice record;
  record.position = section.position();
  record.file = section.text("file");
  record.name = section.find("name") ? section.identifier("name") : name_of(record.file);
  for (const RecordChoice& other : choice.records) {
    if (other.name != record.name) continue;
    const std::string problem =
        fmt::format("the name \"{}\" is taken by the record of line {}", record.name, other.position.line);
    section.find("name") ? section.fail(rules::name_taken, "name", "{}", problem)
                         : section.fail_here(rules::name_taken, "{}", problem + "; give each a \"name\"");
  }
  record.added_mass = read_optional(reading, section, "added_mass", Quantity::mass);
  record.static_displacement = read_optional(reading, section, "static_displacement", Quantity::length);
  return record;
}

void check_system(const TomlSection& section, const Study& study, const IdentifyChoice& choice) {
  if (choice.method != Method::grey_box || !study.network.masses.empty()) return;
  section.fail(rules::missing_section, "method",
               "a grey box fits parameters of a system, but the study has none; describe it by [[mass]] and "
               "[[element]]");
}

// A hysteretic element has its damping at one frequency. Without a forcing at a known frequency it must be
// given.
void check_reference_frequency(const TomlSection& section, const Study& study, const IdentifyChoice& choice) {
  if (choice.reference_frequency || !mechanics::frequency_dependent_element(study.network)) return;
  for (const RecordChoice& record : choice.records) {
    const bool free = record.motion == identification::MotionKind::free;
    if (!free && !study.network.excitations.empty()) continue;
    section.fail_here(rules::beyond_schema(rules::missing_key),
                      "the key \"reference_frequency\" is missing: the study has a hysteretic element, but "
                      "the record \"{}\" has no known frequency for its loss factor",
                      record.name);
  }
}

// Liang and Feeny's method starts a fit of one mass whose free vibration was measured.
void check_start(const TomlSection& section, const Study& study, const IdentifyChoice& choice) {
  if (choice.start != IdentifyStart::free_decay) return;
  if (study.network.masses.size() != 1)
    section.fail(rules::unfit_for_method, "start",
                 "\"free_decay\" is for a system of one mass; this one has {}", study.network.masses.size());
  const std::string role = study.network.masses.front() + "_displacement";
  const bool has_one =
      std::any_of(choice.records.begin(), choice.records.end(), [&](const RecordChoice& record) {
        return record.motion == identification::MotionKind::free && record.find(role);
      });
  if (!has_one)
    section.fail(rules::unfit_for_method, "start",
                 "\"free_decay\" needs a record with motion = \"free\" and {}", role);
}

// The method's formula needs one record, or a trace from each.
void check_count(const Study& study, const std::vector<TomlSection>& records) {
  const IdentifyChoice& choice = *study.identify();
  const bool several_traces = method_row(study).several_traces;
  for (std::size_t i = 1; i < records.size(); ++i) {
    if (several_traces && choice.records[0].find("time") && choice.records[i].find("time")) continue;
    records[i].fail_here(rules::unfit_for_method, "the method \"{}\" takes one record{}",
                         method_name(choice.method), several_traces ? " with a table, or traces only" : "");
  }
}

// A force at resonance is compared with displacements as force / stiffness.
void check_stiffness(const TomlSection& section, const IdentifyChoice& choice) {
  if (choice.method != Method::forced_resonance || choice.stiffness) return;
  if (choice.records.front().find("force"))
    section.fail_here(
        rules::beyond_schema(rules::missing_key),
        "the key \"stiffness\" is missing (a stiffness, N/m): the displacement that a force would cause at "
        "rest is force / stiffness");
}

std::vector<TomlSection> sections_of(const TomlSection& identify, const TomlValue& root, const char* kind,
                                     const char* naming_key) {
  std::vector<TomlSection> sections;
  const std::string path = fmt::format("identify.{}", kind);
  const TomlValue& parent = find_entry(root, "identify")->value;
  for (const TomlValue* table : read_tables(identify.source(), parent, path)) {
    const std::string where =
        label(*table, fmt::format("[[{}]]", path), naming_key, path, sections.size() + 1);
    sections.emplace_back(identify.source(), *table, where, path);
  }
  return sections;
}

}  // namespace

std::string method_name(IdentifyMethod method) {
  return study_key("identify", "method").words[static_cast<std::size_t>(method)].word;
}

TomlSection identify_section(const StudySource& source, const TomlValue& root) {
  return {source, find_entry(root, "identify")->value, "[identify]", "identify"};
}

std::vector<TomlSection> record_sections(const TomlSection& identify, const TomlValue& root) {
  return sections_of(identify, root, "record", "name");
}

std::vector<TomlSection> parameter_sections(const TomlSection& identify, const TomlValue& root) {
  return sections_of(identify, root, "parameter", "parameter");
}

void read_identification(const StudyContext& context, const TomlValue& root, Study& study) {
  const TomlSection section = identify_section(context.source, root);
  IdentifyChoice& choice = *study.identify();
  read_method(section, choice);
  check_system(section, study, choice);
  section.keep_to(method_name(choice.method));
  NetworkReading reading(context, study.parameters);
  reading.result = {study.network, study.values};
  read_known_values(reading, section, choice);
  for (const TomlSection& record : record_sections(section, root))
    choice.records.push_back(read_record_heading(reading, record, choice));
}

void read_measurements(const StudyContext& context, const TomlValue& root,
                       const std::filesystem::path& folder, DataFiles data, Study& study) {
  const TomlSection section = identify_section(context.source, root);
  IdentifyChoice& choice = *study.identify();
  IdentifyReading reading{context, folder, data, study, choice};
  const std::vector<TomlSection> records = record_sections(section, root);
  const auto read_all_records = [&] {
    for (std::size_t i = 0; i < records.size(); ++i) read_record(reading, records[i], choice.records[i]);
  };
  // A record of a grey box sets no parameter that is fitted; a formula's estimates depend on its data.
  const bool formula = choice.method != Method::grey_box;
  if (formula) read_all_records();
  for (const TomlSection& parameter : parameter_sections(section, root))
    read_identified_parameters(reading, parameter);
  if (!formula) read_all_records();
  if (data == DataFiles::leave) return;
  check_count(study, records);
  check_stiffness(section, choice);
  check_reference_frequency(section, study, choice);
  if (const std::string one = needs_one_response(study); !one.empty()) refuse_several_responses(study, one);
  check_start(section, study, choice);
  if (section.find("fixed_from")) read_fixed(reading, section);
}

const DataColumn* RecordChoice::find(const std::string& role) const {
  const auto column =
      std::find_if(columns.begin(), columns.end(), [&](const DataColumn& each) { return each.role == role; });
  return column == columns.end() ? nullptr : &*column;
}

std::vector<const StudyValue*> IdentifyChoice::values() const {
  std::vector<const StudyValue*> all;
  for (const auto* value : {&mass, &stiffness, &reference_frequency}) {
    if (*value) all.push_back(&**value);
  }
  for (const RecordChoice& record : records) {
    for (const auto* value : {&record.added_mass, &record.static_displacement}) {
      if (*value) all.push_back(&**value);
    }
  }
  return all;
}

}  // namespace frahm::studies
