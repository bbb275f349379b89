#include "studies/reading/kinds/record_reading.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "solvers/transient/record_course.hpp"
#include "studies/reading/data_files/column_in_si.hpp"
#include "studies/reading/data_files/identify_methods.hpp"
#include "studies/reading/data_files/record_columns.hpp"
#include "studies/reading/kinds/identify_reading.hpp"
#include "studies/reading/study/assignment_reading.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/text/spelling.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {
namespace {

using identification::MotionKind;

const TomlEntry* unit_entry(const TomlSection& section, const std::string& role) {
  const TomlValue* units = section.find("units");
  return units ? find_entry(*units, role) : nullptr;
}

// Every entry of `units` must belong to a column of numbers.
void check_units(const TomlSection& section, const RawRecord& raw) {
  const TomlValue* units = section.find("units");
  if (!units) return;
  const auto* entries = units->as<TomlTable>();
  if (!entries)
    section.fail(rules::wrong_type, "units", "expected a table such as {{ displacement = \"mm\" }}, found {}",
                 described(*units));
  std::vector<std::string> roles;
  for (const RawColumn& column : raw.columns) roles.push_back(column.role->name);
  for (const TomlEntry& entry : *entries) {
    if (place_among(roles, entry.key)) continue;
    throw section.source().error_at(rules::unknown_name, entry.position, "{}: units: {}", section.where(),
                                    none_called("column of numbers", entry.key, roles));
  }
}

void check_count(const TomlSection& section, const RawRecord& raw, const RecordForm& form) {
  if (raw.rows.size() >= form.least_rows) return;
  const bool at_line = raw.has_lines && !raw.rows.empty();
  throw data_error(rules::too_few, section,
                   fmt::format("{}{}: {} of numbers{}; at least {} needed", raw.file,
                               at_line ? fmt::format(":{}", raw.rows.back()) : "",
                               raw.rows.empty() ? "no row" : "a single row",
                               raw.doubtful > 0 ? " that is not doubtful" : "",
                               form.least_rows == 1 ? "one is" : "two are"));
}

void take_columns(const IdentifyReading& reading, const TomlSection& section, RawRecord& raw,
                  RecordChoice& record) {
  check_units(section, raw);
  for (RawColumn& column : raw.columns) {
    const TomlEntry* entry = unit_entry(section, column.role->name);
    const GivenUnit given{entry ? &entry->value : nullptr, "units: " + column.role->name};
    record.columns.push_back(
        {column.role->name,
         in_si(reading.context, {section, section.require("file").position}, raw, column, given)});
  }
  record.labels = std::move(raw.labels);
  record.doubtful = raw.doubtful;
}

// A measured excitation replaces the study's whole excitation.
void refuse_other_excitation(const IdentifyReading& reading, const TomlSection& section,
                             const RecordChoice& record) {
  const mechanics::Network& network = reading.study.network;
  for (const mechanics::Excitation& excitation : network.excitations) {
    const bool force = excitation.kind == mechanics::ExcitationKind::force;
    const std::string& node =
        force ? mechanics::forced_node(network, excitation.node) : network.prescribed[excitation.node];
    if (record.find(node + (force ? "_force" : "_displacement"))) continue;
    section.fail(rules::unfit_for_method, "file",
                 "an excitation was measured and replaces [excitation], but \"{}\" is also excited and was "
                 "not measured",
                 node);
  }
}

// For the displacements of supports that were measured and drive the motion.
void read_interpolation(const Study& study, const TomlSection& section, RecordChoice& record) {
  bool is_used = false;
  record.interpolation = section.choice_as<transient::Interpolation>("interpolation");
  for (std::size_t s = 0; s < study.network.prescribed.size(); ++s) {
    const DataColumn* column = record.find(study.network.prescribed[s] + "_displacement");
    if (column == nullptr || !is_excitation(study, column->role)) continue;
    is_used = true;
    const transient::Record driving{.name = record.name,
                                    .of = transient::RecordOf::displacement,
                                    .time = record.find("time")->values,
                                    .values = column->values,
                                    .interpolation = record.interpolation};
    const bool counts = driving.time.size() >= transient::least_samples(driving);
    const std::string strays = counts ? transient::why_no_spline(driving) : "";
    if (!strays.empty())
      throw data_error(rules::unfit_for_method, section, fmt::format("{}: {}", column->role, strays));
    const std::string why = driving.jumps() ? transient::why_no_jump(study.network, s) : "";
    if (!why.empty()) section.fail(rules::unfit_for_method, "interpolation", "{}", why);
  }
  if (section.find("interpolation") && !is_used)
    section.fail(rules::beyond_schema(rules::key_without_use), "interpolation",
                 "has no effect: no displacement of a support was measured, which would drive the motion");
}

// For a grey box: the cause of the motion, and the columns it needs.
void read_motion_kind(const IdentifyReading& reading, const TomlSection& section, RecordChoice& record) {
  const Study& study = reading.study;
  const auto& columns = record.columns;
  const auto any = [&](auto is) {
    return std::any_of(columns.begin(), columns.end(),
                       [&](const DataColumn& column) { return is(study, column.role); });
  };
  if (!any(is_motion))
    section.fail(rules::unknown_column, section.find("columns") ? "columns" : "file",
                 "no motion of a mass was measured; the columns are {}",
                 described(method_row(study).forms.front()));
  const bool measured = any(is_excitation), stated = !study.network.excitations.empty();
  const std::string word = section.choice("motion", measured || stated ? "forced" : "free");
  record.motion = word == "free"     ? MotionKind::free
                  : word == "forced" ? MotionKind::forced
                                     : MotionKind::periodic;
  if (record.motion != MotionKind::forced && measured)
    section.fail(rules::unfit_for_method, "motion", "\"{}\", but a measured excitation needs \"forced\"",
                 word);
  if (record.motion != MotionKind::free && !measured && !stated)
    section.fail(rules::beyond_schema(rules::missing_section), "motion",
                 "\"{}\", but the study has no [excitation] and none was measured", word);
  if (measured && record.doubtful > 0)
    section.fail(rules::doubtful_row, "file",
                 "a measured excitation drives the motion at all times, so none of its rows can be left out "
                 "as doubtful");
  if (measured) refuse_other_excitation(reading, section, record);
  read_interpolation(study, section, record);
  if (record.motion == MotionKind::free && study.initial().empty())
    section.fail_here(
        rules::beyond_schema(rules::missing_section),
        "a free motion starts from [[initial]] values, but the study has none, so nothing would move");
}

Assignment read_setting(const IdentifyReading& reading, const TomlSection& section, const TomlEntry& entry) {
  return read_assignment(
      reading.context, reading.study, section.where() + ": set", entry, [&](std::size_t parameter) {
        return of_parameter(reading.choice.parameters, parameter) ? "it is fitted, so a record cannot set it"
                                                                  : "";
      });
}

void read_settings(const IdentifyReading& reading, const TomlSection& section, RecordChoice& record) {
  const TomlValue* set = section.find("set");
  if (!set) return;
  const auto* entries = set->as<TomlTable>();
  if (!entries)
    section.fail(rules::wrong_type, "set", "expected a table such as {{ I = 4.72 }}, found {}",
                 described(*set));
  for (const TomlEntry& entry : *entries) record.set.push_back(read_setting(reading, section, entry));
}

// Each key of a record belongs to the methods, and the forms of their data, that use it.
void check_keys(const IdentifyReading& reading, const TomlSection& section,
                const std::vector<RecordForm>& forms, const RecordForm& form) {
  section.keep_to(method_name(reading.choice.method));
  for (const RecordForm& each : forms) {
    if (each.key.empty() || (section.find(each.key) != nullptr) == (each.key == form.key)) continue;
    if (section.find(each.key))
      section.fail(rules::beyond_schema(rules::key_without_use), each.key, "has no use here; {}",
                   each.meaning_of_key);
    section.fail_here(rules::beyond_schema(rules::missing_key), "the key \"{}\" is missing; {}", each.key,
                      each.meaning_of_key);
  }
}

}  // namespace

void read_record(IdentifyReading& reading, const TomlSection& section, RecordChoice& record) {
  if (reading.data == DataFiles::leave) return read_settings(reading, section, record);
  const std::vector<RecordForm> forms = method_row(reading.study).forms;
  reading.choice.files.push_back(reading.folder / record.file);
  RawRecord raw = read_columns(section, reading.folder, forms);
  std::vector<std::string> roles;
  for (const RawColumn& column : raw.columns) roles.push_back(column.role->name);
  const RecordForm& form = form_of(forms, roles);
  if (form.find("extremum") && raw.doubtful > 0)
    section.fail(
        rules::doubtful_row, "file",
        "turning points follow each other, so none can be left out as doubtful; cut the table there");
  check_count(section, raw, form);
  check_keys(reading, section, forms, form);
  take_columns(reading, section, raw, record);
  if (reading.choice.method != IdentifyMethod::grey_box) return;
  read_motion_kind(reading, section, record);
  if (raw.first_is_doubtful && record.motion != MotionKind::periodic)
    section.fail(rules::doubtful_row, "file",
                 "the motion begins at the first row, which cannot be doubtful; cut off this row, and "
                 "[[initial]] holds at the next");
  read_settings(reading, section, record);
}

}  // namespace frahm::studies
