#include "studies/reading/system/driving_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solvers/transient/record_course.hpp"
#include "studies/reading/data_files/column_in_si.hpp"
#include "studies/reading/data_files/record_columns.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/study/parameter_reading.hpp"
#include "studies/reading/study/study_context.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {
namespace {

using transient::Record, transient::RecordOf;

// A window of displacements begins and ends at samples, which may be written with fewer digits than these.
constexpr double at_sample = 1e-6;  // of the interval next to it

// The column of a key, by number or by name.
WantedColumn wanted_column(const TomlSection& section, const std::string& key, const std::string& role,
                           std::size_t otherwise) {
  WantedColumn wanted{
      .role = role, .number = otherwise, .name = "", .position = section.position(), .key = key};
  const TomlValue* value = section.find(key);
  if (!value) return wanted;
  wanted.position = value->position;
  if (value->as<std::string>()) {
    wanted.number.reset();
    wanted.name = section.text(key);
    return wanted;
  }
  wanted.number = static_cast<std::size_t>(section.integer(key));
  return wanted;
}

// In UDUNITS "g" is the gram. Where an acceleration is expected it is the standard acceleration of gravity,
// as in every catalogue of earthquakes.
std::string acceleration_unit(const std::string& unit) {
  return unit == "g" ? "gravity" : unit;
}

void take_g(RecordOf of, RawColumn& column, std::optional<TomlValue>& unit) {
  if (of != RecordOf::acceleration) return;
  if (column.unit) column.unit = acceleration_unit(*column.unit);
  if (unit && unit->as<std::string>()) unit->content = acceleration_unit(*unit->as<std::string>());
}

void check_count(const TomlSection& section, const RecordFile& file, const Record& record) {
  const std::size_t least = transient::least_samples(record), count = record.time.size();
  if (count >= least) return;
  const bool has_window = section.find("from") || section.find("to");
  throw data_error(
      rules::too_few, section, file.position,
      fmt::format("{}: {} sample{}{}; at least {} are needed{}", file.name, count, count == 1 ? "" : "s",
                  has_window ? " in the window" : "", least == 3 ? "three" : "two",
                  least == 3 ? ", for the cubic spline through displacements" : ""));
}

// A time [s] of the window.
double window_time(const StudyContext& context, const TomlSection& section, const std::string& key,
                   double otherwise) {
  const TomlValue* value = section.find(key);
  if (!value) return otherwise;
  const std::string where = fmt::format("{}: {}", section.where(), key);
  const NumberWithUnit number = read_number_with_unit(context, where, *value);
  try {
    return number.value * (number.unit ? si_factor(*number.unit, Quantity::time) : 1.0);
  } catch (const UnitError& error) {
    throw context.source.error_at(error.rule(), number.unit_position, "{}: {}", where, error.what());
  }
}

// The linear interpolation at a time within.
double value_at(const Record& record, double time) {
  const auto behind = std::lower_bound(record.time.begin(), record.time.end(), time);
  const auto i = static_cast<std::size_t>(behind - record.time.begin());
  if (record.time[i] == time) return record.values[i];
  const double part = (time - record.time[i - 1]) / (record.time[i] - record.time[i - 1]);
  return std::lerp(record.values[i - 1], record.values[i], part);
}

// The sample at an end of the window of a spline through displacements, which has no other end than its
// samples.
double nearest_sample(const TomlSection& section, const RecordFile& file, const Record& record,
                      const std::string& key, double time) {
  const auto distance = [&](double sample) { return std::abs(sample - time); };
  const auto nearest = std::ranges::min_element(record.time, {}, distance);
  const auto beside = nearest + 1 == record.time.end() ? nearest - 1 : nearest + 1;
  if (distance(*nearest) > at_sample * std::abs(*beside - *nearest))
    section.fail(rules::wrong_order, key,
                 "{} s is between two samples of {}; a window of displacements must begin and end at samples "
                 "of their spline, and the nearest here is at {} s",
                 time, file.name, *nearest);
  return *nearest;
}

// An end of the window, which the record reaches.
double window_end(const StudyContext& context, const TomlSection& section, const RecordFile& file,
                  const Record& record, const std::string& key, double otherwise) {
  const double time = window_time(context, section, key, otherwise);
  if (!section.find(key)) return time;
  if (time < record.time.front() || time > record.time.back())
    section.fail(rules::beyond_schema(rules::out_of_range), key,
                 "{} s is outside {}, which goes from {} to {} s", time, file.name, record.time.front(),
                 record.time.back());
  return record.is_spline() && record.time.size() > 1 ? nearest_sample(section, file, record, key, time)
                                                      : time;
}

// How a displacement goes from sample to sample; nothing else has a choice.
transient::Interpolation interpolation_of(const TomlSection& section, const RecordedPlace& place,
                                          const mechanics::Network& network) {
  if (!section.find("interpolation")) return {};
  const auto interpolation = section.choice_as<transient::Interpolation>("interpolation");
  if (interpolation == transient::Interpolation::spline) return interpolation;
  const std::string why = transient::why_no_jump(network, find_node(network, place.node)->index);
  if (!why.empty()) section.fail(rules::unfit_for_method, "interpolation", "{}", why);
  return interpolation;
}

}  // namespace

Record in_window(const StudyContext& context, const TomlSection& section, const RecordFile& file,
                 Record record) {
  check_count(section, file, record);
  const double from = window_end(context, section, file, record, "from", record.time.front());
  const double to = window_end(context, section, file, record, "to", record.time.back());
  if (!(from < to))
    section.fail(rules::wrong_order, section.find("to") ? "to" : "from",
                 "the window from {} s to {} s of {} is empty", from, to, file.name);
  Record cut{record.name, record.of, {0.0}, {value_at(record, from)}, record.interpolation};
  for (std::size_t i = 0; i < record.time.size(); ++i) {
    if (record.time[i] <= from || record.time[i] >= to) continue;
    cut.time.push_back(record.time[i] - from);
    cut.values.push_back(record.values[i]);
  }
  cut.time.push_back(to - from);
  cut.values.push_back(value_at(record, to));
  check_count(section, file, cut);
  if (const std::string why = transient::why_no_spline(cut); !why.empty())
    throw data_error(rules::unfit_for_method, section, file.position, fmt::format("{}: {}", file.name, why));
  return cut;
}

Samples read_samples(const StudyContext& context, const TomlSection& section, const RecordFile& file,
                     const std::filesystem::path& folder, RecordOf of, Quantity quantity) {
  const std::vector<RecordForm> forms{{{{.name = "time", .quantity = Quantity::time, .increases = true},
                                        {.name = "value", .quantity = quantity}},
                                       1,
                                       true}};
  ColumnReading reading{.record = section, .forms = forms, .file = file.position};
  reading.result.file = file.name;
  reading.wanted = {wanted_column(section, "time", "time", 1), wanted_column(section, "column", "value", 2)};
  RawRecord raw = read_columns(std::move(reading), folder);
  if (raw.doubtful > 0)
    throw data_error(rules::doubtful_row, section, file.position,
                     fmt::format("{}: rows marked as doubtful: {}; a record drives the motion at all times, "
                                 "so none of its rows can be left out",
                                 file.name, raw.doubtful));
  std::optional<TomlValue> unit;
  if (const TomlValue* value = section.find("unit")) unit = *value;
  take_g(of, raw.columns[1], unit);
  const NamedFile named{section, file.position};
  return {in_si(context, named, raw, raw.columns[0], {}),
          in_si(context, named, raw, raw.columns[1], {unit ? &*unit : nullptr})};
}

Record read_driving_record(const StudyContext& context, const TomlSection& section, const RecordFile& file,
                           const std::filesystem::path& folder, const mechanics::Network& network) {
  const RecordedPlace place = place_of(section);
  const transient::Interpolation interpolation = interpolation_of(section, place, network);
  Samples samples = read_samples(context, section, file, folder, place.of, quantity_of(place, network));
  return in_window(context, section, file,
                   {.name = file.name,
                    .of = place.of,
                    .time = std::move(samples.time),
                    .values = std::move(samples.values),
                    .interpolation = interpolation});
}

}  // namespace frahm::studies
