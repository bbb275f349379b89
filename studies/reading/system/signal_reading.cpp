#include "studies/reading/system/signal_reading.hpp"

#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/system/direction_reading.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {

void read_signals(NetworkReading& reading, const TomlValue& root) {
  const TomlEntry* output = find_entry(root, "output");
  if (!output || !output->value.as<TomlTable>()) return;  // what else is wrong is reported as it is read
  std::size_t number = 0;
  for (const TomlValue* table : read_tables(reading.context.source, output->value, "output.signal")) {
    const TomlSection section(reading.context.source, *table,
                              label(*table, "signal", "name", "output.signal", ++number), "output.signal");
    const std::string name = section.identifier("name");
    take_name(reading, section, name, section.where());
    StudyDirection along =
        read_direction(reading.context, reading.parameters, reading.result.network, section);
    reading.result.network.signals.push_back({.name = name, .along = {}, .rotational = along.rotational});
    reading.result.values.signals.push_back(std::move(along));
  }
}

void check_output_has_signals_alone(const Study& study, const TomlEntry& output, const std::string& why) {
  const auto refuse = [&](Position position, const std::string& what) {
    throw study.source.error_at(rules::beyond_schema(rules::other_kind), position, "{} is not part of {}{}",
                                what, kind_noun(study.kind()), why);
  };
  if (!find_entry(output.value, "signal")) refuse(output.position, "the section \"output\"");
  for (const TomlEntry& entry : *output.value.as<TomlTable>()) {
    if (entry.key != "signal") refuse(entry.position, "[output]: \"" + entry.key + "\"");
  }
}

void set_signals(Study& study) {
  for (std::size_t i = 0; i < study.values.signals.size(); ++i)
    study.network.signals[i].along = direction_of(study, study.values.signals[i]);
}

}  // namespace frahm::studies
