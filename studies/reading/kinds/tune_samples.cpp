#include "studies/reading/kinds/tune_samples.hpp"

#include <fmt/format.h>

#include <utility>

#include "studies/reading/kinds/tune_reading.hpp"
#include "studies/reading/map/sample_axis_reading.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {
namespace {

// The one [[axis]] that a tuning may have.
const TomlValue& axis_of_samples(const TuneReading& reading) {
  const StudySource& source = reading.context.source;
  const std::vector<const TomlValue*> tables = read_tables(source, reading.root, "axis");
  for (const TomlValue* table : tables) {
    if (!is_axis_of_samples(*table))
      throw source.error_at(rules::beyond_schema(rules::other_kind), table->position,
                            "an [[axis]] of a tuning must have samples, as in samples = 100; the range of "
                            "what is tuned belongs in [[design]]");
  }
  if (tables.size() > 1)
    throw source.error_at(rules::given_twice, tables[1]->position,
                          "a tuning has one axis of samples; list all uncertain parameters there");
  if (!reading.choice.scenarios.empty())
    throw source.error_at(rules::beyond_schema(rules::key_without_use), tables[0]->position,
                          "each sample is a scenario; leave out either the samples or the [[scenario]]");
  return *tables.front();
}

void check_not_tuned(const TuneReading& reading, const ParameterAxis& axis) {
  if (!of_parameter(reading.choice.designs, axis.parameter)) return;
  const std::string& name = reading.study.parameters.list[axis.parameter].name;
  throw reading.context.source.error_at(
      rules::wrong_dependence, axis.position,
      "\"{}\" is tuned, so samples cannot set it; let a factor on it scatter", name);
}

}  // namespace

void read_samples(TuneReading& reading, const std::filesystem::path& folder, DataFiles data) {
  if (read_tables(reading.context.source, reading.root, "axis").empty()) return;
  const TomlValue& table = axis_of_samples(reading);
  // They are read as those of a map, whose axes they are.
  Study& study = reading.study;
  study.choice = SweepChoice{};
  read_axis_of_samples(reading.context, table, 1, folder, data, study);
  const MapChoice map = std::move(*study.map());
  study.choice = TuneChoice{};
  for (const ParameterAxis& axis : map.axes) check_not_tuned(reading, axis);
  TuneChoice& choice = reading.choice;
  choice.drawn = map.samples->drawn;
  for (std::size_t i = 0; i < map.dimensions.front().size; ++i) {
    ScenarioChoice& sample = choice.scenarios.emplace_back();
    sample.name = fmt::format("sample_{}", i);
    for (const ParameterAxis& axis : map.axes) sample.set.push_back({axis.parameter, axis.si_values[i]});
  }
}

void refuse_samples(const TuneReading& reading) {
  if (const TomlEntry* entry = find_entry(reading.root, "axis"))
    throw reading.context.source.error_at(
        rules::beyond_schema(rules::other_kind), entry->position,
        "the section \"axis\" is not part of a tuning over a band: the band and the bounds of [[design]] are "
        "its ranges, and samples belong to a tuning over records");
}

}  // namespace frahm::studies
