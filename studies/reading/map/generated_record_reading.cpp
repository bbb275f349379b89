#include "studies/reading/map/generated_record_reading.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "studies/reading/study/parameter_reading.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {
namespace {

using transient::Envelope;

constexpr double most_samples = 1e8;  // of all records: a gigabyte

// A number > 0, in SI where a unit is given.
double read_positive(const StudyContext& context, const TomlSection& section, const std::string& key,
                     Quantity quantity) {
  const std::string where = fmt::format("{}: {}", section.where(), key);
  const NumberWithUnit number = read_number_with_unit(context, where, section.require(key));
  double value = number.value;
  try {
    if (number.unit) value *= si_factor(*number.unit, quantity);
  } catch (const UnitError& error) {
    throw context.source.error_at(error.rule(), number.unit_position, "{}: {}", where, error.what());
  }
  if (!(value > 0.0)) section.fail(rules::out_of_range, key, "{} is not possible; must be > 0", number.value);
  return value;
}

// The time from which on a record fades, after its rise and before its end.
void read_level(const StudyContext& context, const TomlSection& section, double duration,
                Envelope& envelope) {
  envelope.rise = read_positive(context, section, "rise", Quantity::time);
  envelope.level_end = read_positive(context, section, "level_end", Quantity::time);
  if (envelope.level_end < envelope.rise || envelope.level_end >= duration)
    section.fail(rules::wrong_order, "level_end",
                 "{} s is not between \"rise\", {} s, and the duration, {} s", envelope.level_end,
                 envelope.rise, duration);
}

Envelope read_envelope(const StudyContext& context, const TomlSection& generated, double duration) {
  Envelope envelope;
  const TomlValue* value = generated.find("envelope");
  if (!value) return envelope;
  const TomlSection section(context.source, *value, generated.where() + ": envelope",
                            "axis.records.envelope");
  const std::string shape = section.choice("shape");
  section.keep_to(shape);
  const bool is_jennings = shape == "jennings";
  envelope.shape = is_jennings ? Envelope::Shape::jennings : Envelope::Shape::trapezoid;
  read_level(context, section, duration, envelope);
  if (is_jennings) envelope.decay = read_positive(context, section, "decay", Quantity::rate);
  return envelope;
}

void read_ground(const StudyContext& context, const TomlSection& section, GeneratedRecords& generated) {
  transient::GroundNoise& ground = generated.ground;
  ground.ground_frequency = read_positive(context, section, "ground_frequency", Quantity::angular_frequency);
  ground.ground_damping = section.number("ground_damping");
  if (section.find("corner_frequency") || section.find("corner_damping")) {
    ground.corner_frequency =
        read_positive(context, section, "corner_frequency", Quantity::angular_frequency);
    ground.corner_damping = section.number("corner_damping");
  }
  // Half the rate is the highest frequency that samples tell apart.
  const double highest = std::numbers::pi * generated.sampling.rate;
  if (ground.ground_frequency >= highest)
    section.fail(rules::beyond_schema(rules::out_of_range), "rate",
                 "{} per second is too low for the ground's {:.6g} rad/s: samples can distinguish "
                 "frequencies only up to half their rate, {:.6g} rad/s",
                 generated.sampling.rate, ground.ground_frequency, highest);
  ground.envelope = read_envelope(context, section, generated.sampling.duration);
}

void check_size(const TomlSection& section, const GeneratedRecords& generated) {
  const double intervals = generated.sampling.duration * generated.sampling.rate;
  if (intervals < 1.0)
    section.fail(rules::too_few, "duration", "{} s contain no interval at {} samples per second",
                 generated.sampling.duration, generated.sampling.rate);
  const double samples = intervals * static_cast<double>(generated.count);
  if (samples > most_samples)
    section.fail(rules::too_large, "count", "{} records have {:.3g} samples, but at most {:.0e} are allowed",
                 generated.count, samples, most_samples);
}

}  // namespace

GeneratedRecords read_generated(const StudyContext& context, const TomlSection& axis) {
  const TomlSection section(context.source, axis.require("records"), axis.where() + ": records",
                            "axis.records");
  GeneratedRecords generated;
  generated.kind = section.choice("generate");
  section.keep_to(generated.kind);
  generated.count = static_cast<std::size_t>(section.integer("count"));
  generated.sampling.seed = static_cast<std::uint64_t>(section.integer("seed"));
  generated.sampling.duration = read_positive(context, section, "duration", Quantity::time);
  generated.sampling.rate = section.number("rate");
  generated.ground.intensity = section.number("intensity");
  check_size(section, generated);
  if (generated.kind == "kanai_tajimi") read_ground(context, section, generated);
  return generated;
}

}  // namespace frahm::studies
