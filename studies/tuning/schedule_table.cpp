#include "studies/tuning/schedule_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <numbers>

#include "studies/reading/quantities/unit_words.hpp"

namespace frahm::studies {
namespace {

constexpr double rpm = std::numbers::pi / 30.0;  // [rad/s]
constexpr double rows_wanted = 200.0;
constexpr double most_rows = 1e6;
constexpr double same_place = 1e-9;  // of a step: a whole step this near to an end is that end

bool is_frequency(const Study& study) {
  const auto sole = study.values.omega.expression.sole_parameter();
  return !study.dimensionless && sole && *sole == study.tune()->band->parameter;
}

// 1, 2 or 5 times a power of ten, not above `size`.
double round_step(double size) {
  const double decade = std::pow(10.0, std::floor(std::log10(size)));
  for (const double digit : {5.0, 2.0}) {
    if (digit * decade <= size) return digit * decade;
  }
  return decade;
}

double step_of(const Study& study, std::optional<double> asked) {
  const BandChoice& band = *study.tune()->band;
  const double width = (band.range.to - band.range.from) / band.unit.si_factor;
  if (!asked) return is_frequency(study) ? rpm / band.unit.si_factor : round_step(width / rows_wanted);
  if (!(*asked > 0.0) || !std::isfinite(*asked) || width / *asked > most_rows)
    throw StudyError(rules::wrong_option, "--step {}: must be > 0 and at least a millionth of the band",
                     *asked);
  return *asked;
}

// The rows' values in the unit of the band.
std::vector<double> places_of(const BandChoice& band, double step) {
  const double from = band.range.from / band.unit.si_factor, to = band.range.to / band.unit.si_factor;
  std::vector<double> places{from};
  for (double k = std::floor(from / step) + 1.0; k * step < to - same_place * step; ++k) {
    if (k * step > from + same_place * step) places.push_back(std::abs(step - 1.0) < 1e-12 ? k : k * step);
  }
  places.push_back(to);
  return places;
}

bool has_range(const ColumnChoice& column) {
  return std::isfinite(column.lower) || std::isfinite(column.upper);
}

const char* range_word(const ColumnChoice& column, double value) {
  if (std::isnan(value)) return "";
  return value < column.lower ? "below" : value > column.upper ? "above" : "within";
}

std::string header(const Study& study, bool tells_rpm) {
  const TuneChoice& tune = *study.tune();
  const auto name = [&](std::size_t parameter) { return study.parameters.list[parameter].name; };
  std::string text = in_brackets(name(tune.band->parameter), tune.band->unit.text);
  if (tells_rpm) text += ",excitation [rpm]";
  for (const DesignChoice& design : tune.designs) {
    if (design.is_scheduled())
      text += fmt::format(",{}", in_brackets(name(design.parameter), design.unit.text));
  }
  for (const ColumnChoice& column : tune.columns) {
    text += fmt::format(",{}", in_brackets(column.name, column.unit));
    if (has_range(column)) text += fmt::format(",{}_range", column.name);
  }
  return text + "\n";
}

}  // namespace

std::string schedule_table(const StoredTuning& stored, std::optional<double> step) {
  const Study& study = stored.study;
  const TuneChoice& tune = *study.tune();
  if (!tune.has_schedule())
    throw StudyError(rules::missing_key, "{}: nothing is scheduled: no [[design]] has a schedule",
                     study.source.name);
  const BandChoice& band = *tune.band;
  const bool tells_rpm = !study.dimensionless && std::abs(band.unit.si_factor / rpm - 1.0) > 1e-12;
  std::string text = header(study, tells_rpm);
  const auto out = std::back_inserter(text);
  for (const double place : places_of(band, step_of(study, step))) {
    const double si = place * band.unit.si_factor;
    const std::vector<double> parameters = parameters_of(study, stored.design, 0, si);
    const auto value = [&](const StudyValue& formula) {
      return formula.expression.evaluate(std::span<const double>(parameters));
    };
    fmt::format_to(out, "{:.12g}", place);
    if (tells_rpm) fmt::format_to(out, ",{:.12g}", value(study.values.omega) / rpm);
    for (const DesignChoice& design : tune.designs) {
      if (design.is_scheduled())
        fmt::format_to(out, ",{:.12g}", parameters[design.parameter] / design.unit.si_factor);
    }
    for (const ColumnChoice& column : tune.columns) {
      const double number = value(column.value);
      fmt::format_to(out, ",{}", std::isnan(number) ? "" : fmt::format("{:.12g}", number));
      if (has_range(column)) fmt::format_to(out, ",{}", range_word(column, number));
    }
    text += '\n';
  }
  return text;
}

}  // namespace frahm::studies
