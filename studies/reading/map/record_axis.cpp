#include "studies/reading/map/record_axis.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/map/generated_record_reading.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_context.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {
namespace {

using transient::Record, transient::RecordOf;

std::vector<RecordFile> read_files(const TomlSection& section, const TomlArray& list) {
  if (list.empty())
    section.fail(rules::empty, "records", "the array is empty; an axis needs at least one record");
  std::vector<RecordFile> files;
  for (const TomlValue& item : list) {
    const std::string name = read_text(section.source(), fmt::format("{}: records", section.where()), item);
    for (const RecordFile& other : files) {
      if (other.name == name)
        throw section.source().error_at(rules::given_twice, item.position,
                                        "{}: records: \"{}\" appears twice", section.where(), name);
    }
    files.push_back({name, item.position});
  }
  return files;
}

}  // namespace

WrittenRecordAxis read_records(const StudyContext& context, const TomlSection& section) {
  WrittenRecordAxis axis{section.position(), {}};
  const TomlValue& records = section.require("records");
  if (const auto* list = records.as<TomlArray>()) {
    axis.records = read_files(section, *list);
  } else if (records.as<TomlTable>()) {
    axis.records = read_generated(context, section);
  } else {
    section.fail(rules::wrong_type, "records",
                 "expected an array of files or a table such as {{ generate = \"white\", count = 20, ... }}, "
                 "found {}",
                 described(records));
  }
  return axis;
}

namespace {

// What a generated record is not asked for.
void check_generated(const TomlSection& section, const GeneratedRecords& generated) {
  for (const char* key : {"time", "column", "unit", "interpolation"}) {
    if (section.find(key))
      section.fail(rules::beyond_schema(rules::key_without_use), key,
                   "belongs to files; the axis generates the records, in SI");
  }
  const RecordedPlace place = place_of(section);
  const bool white = generated.kind == "white";
  if (place.of == RecordOf::acceleration || (white && place.of == RecordOf::force)) return;
  section.fail(rules::unfit_for_method, place.key, "\"{}\" generates accelerations of supports{}",
               generated.kind, white ? " and forces on masses" : "");
}

// Components of one axis are independent: each has streams of its own.
Record generated_record(const GeneratedRecords& generated, RecordOf of, std::size_t component,
                        std::size_t index) {
  transient::RandomSampling sampling = generated.sampling;
  sampling.stream = static_cast<std::uint32_t>(component * generated.count + index);
  return {.name = fmt::format("{} {}", generated.kind, index),
          .of = of,
          .time = transient::sample_times(sampling),
          .values = generated.kind == "white" ? transient::white_noise(sampling, generated.ground.intensity)
                                              : transient::ground_acceleration(sampling, generated.ground)};
}

Record record_of_file(const StudyContext& context, const TomlSection& section,
                      const std::filesystem::path& folder, const mechanics::Network& network) {
  const RecordFile file{section.text("file"), section.require("file").position};
  return read_driving_record(context, section, file, folder, network);
}

std::vector<Record> records_of_axis(const StudyContext& context, const TomlSection& section,
                                    const WrittenRecordAxis& axis, std::size_t component,
                                    const std::filesystem::path& folder, const mechanics::Network& network) {
  std::vector<Record> records;
  if (const auto* files = std::get_if<std::vector<RecordFile>>(&axis.records)) {
    for (const RecordFile& file : *files)
      records.push_back(read_driving_record(context, section, file, folder, network));
    return records;
  }
  const auto& generated = std::get<GeneratedRecords>(axis.records);
  check_generated(section, generated);
  for (std::size_t i = 0; i < generated.count; ++i) {
    Record record = generated_record(generated, place_of(section).of, component, i);
    const RecordFile named{record.name, section.position()};
    records.push_back(in_window(context, section, named, std::move(record)));
  }
  return records;
}

// The indices of the recorded components in Network::excitations, in the order of their tables; corners stand
// before them.
std::vector<std::size_t> recorded_components(const mechanics::Network& network, std::size_t corners) {
  std::vector<std::size_t> components;
  for (std::size_t i = 0; i < network.excitations.size(); ++i) {
    if (!mechanics::is_recorded(network.excitations[i].kind)) continue;
    if (corners > 0)
      --corners;
    else
      components.push_back(i);
  }
  return components;
}

void check_name_of_dimension(const StudyContext& context, const Study& study, const WrittenRecordAxis& axis) {
  if (!study.parameters.find(record_dimension)) return;
  throw context.source.error_at(
      rules::name_taken, axis.position,
      "axis of records: its name in the map, \"{0}\", is that of the parameter \"{0}\"; rename the parameter",
      record_dimension);
}

}  // namespace

std::size_t WrittenRecordAxis::size() const {
  if (const auto* files = std::get_if<std::vector<RecordFile>>(&records)) return files->size();
  return std::get<GeneratedRecords>(records).count;
}

std::vector<std::string> WrittenRecordAxis::names() const {
  std::vector<std::string> names;
  if (const auto* files = std::get_if<std::vector<RecordFile>>(&records)) {
    for (const RecordFile& file : *files) names.push_back(file.name);
    return names;
  }
  const auto& generated = std::get<GeneratedRecords>(records);
  for (std::size_t i = 0; i < generated.count; ++i) names.push_back(fmt::format("{} {}", generated.kind, i));
  return names;
}

bool is_record_axis(const TomlValue& table) {
  return table.as<TomlTable>() && find_entry(table, "records");
}

std::optional<WrittenRecordAxis> read_record_axis(const StudyContext& context, const TomlValue& root) {
  std::optional<WrittenRecordAxis> axis;
  for (const TomlValue* table : read_tables(context.source, root, "axis")) {
    if (!is_record_axis(*table)) continue;
    if (axis)
      throw context.source.error_at(rules::given_twice, table->position,
                                    "axis of records: there is already one (line {})", axis->position.line);
    axis = read_records(context, {context.source, *table, "axis of records", "axis", "records"});
  }
  return axis;
}

void add_record_axis(const StudyContext& context, const TomlValue& root, const TomlValue& table,
                     Study& study) {
  if (!study.transient())
    throw context.source.error_at(rules::beyond_schema(rules::other_kind), table.position,
                                  "axis of records: is not part of {}; it is for kind = \"transient\"",
                                  kind_noun(study.kind()));
  const auto axis = read_record_axis(context, root);
  check_name_of_dimension(context, study, *axis);
  auto& dimensions = study.map()->dimensions;
  study.map()->records = {axis->names(), dimensions.size(), axis->position};
  dimensions.push_back({record_dimension, {}, axis->size()});
}

std::vector<DrivingRecord> read_driving_records(const StudyContext& context, const TomlValue& root,
                                                const std::filesystem::path& folder, DataFiles data,
                                                const mechanics::Network& network,
                                                std::vector<DrivingRecord> corners,
                                                const std::optional<WrittenRecordAxis>& axis,
                                                const char* giver) {
  const TomlEntry* excitation = find_entry(root, "excitation");
  const auto sections = record_sections(context.source, excitation->value);
  const auto components = recorded_components(network, corners.size());
  std::vector<DrivingRecord> all = std::move(corners);
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const TomlSection& section = sections[i];
    DrivingRecord driving{.excitation = components[i], .on_axis = !section.find("file")};
    if (driving.on_axis && !axis)
      section.fail_here(rules::beyond_schema(rules::missing_key),
                        "the key \"file\" is missing: give the file of the record, unless {} gives records",
                        giver);
    if (data == DataFiles::read)
      driving.records = driving.on_axis ? records_of_axis(context, section, *axis, i, folder, network)
                                        : std::vector{record_of_file(context, section, folder, network)};
    all.push_back(std::move(driving));
  }
  if (axis && !std::ranges::any_of(all, &DrivingRecord::on_axis))
    throw context.source.error_at(rules::beyond_schema(rules::key_without_use), axis->position,
                                  "axis of records: no [[excitation.record]] takes its record from it: leave "
                                  "out the \"file\" of one");
  return all;
}

std::vector<transient::RecordedExcitation> driven_by(const std::vector<DrivingRecord>& driving,
                                                     std::size_t of_axis) {
  std::vector<transient::RecordedExcitation> all;
  for (const DrivingRecord& each : driving) {
    if (!each.records.empty()) all.push_back({each.excitation, &each.records[each.on_axis ? of_axis : 0]});
  }
  return all;
}

double end_of_records(const std::vector<DrivingRecord>& driving) {
  double end = 0.0;
  for (const DrivingRecord& each : driving) {
    for (const Record& record : each.records) end = std::max(end, record.time.back());
  }
  return end;
}

}  // namespace frahm::studies
