#include "studies/motion/driving_record_columns.hpp"

#include <fmt/format.h>

#include <map>

#include "solvers/mechanics/rotation.hpp"
#include "studies/motion/one_motion.hpp"

namespace frahm::studies {
namespace {

using transient::RecordOf;

struct Recorded {
  std::string_view word, unit;
};

Recorded recorded(RecordOf of, bool on_rotation) {
  switch (of) {
    case RecordOf::displacement:
      return {"displacement", "m"};
    case RecordOf::velocity:
      return {"velocity", "m s-1"};
    case RecordOf::acceleration:
      return {"acceleration", "m s-2"};
    case RecordOf::force:
      break;
  }
  return {"force", on_rotation ? "N m" : "N"};
}

}  // namespace

void add_driving_records(const Study& study, MotionColumns& columns) {
  const mechanics::Network& network = study.network;
  const mechanics::NetworkValues values = motion_values(study);
  std::map<std::string, int> times_named;
  for (const transient::RecordedExcitation& driven : driven_by(study.transient()->records, 0)) {
    const mechanics::Excitation& component = network.excitations[driven.excitation];
    const transient::Record& record = *driven.record;
    const bool is_force = record.of == RecordOf::force;
    const std::string& node =
        is_force ? mechanics::forced_node(network, component.node) : network.prescribed[component.node];
    const auto [word, unit] = recorded(record.of, is_force && mechanics::rotates(network, component.node));
    const std::string what = fmt::format("{}_{}", node, word);
    const int number = ++times_named[what];
    const std::string sort = number == 1 ? std::string(word) : fmt::format("{}_{}", word, number);
    std::vector<double> scaled = record.values;
    for (double& value : scaled) value *= values.excitation[driven.excitation].amplitude;
    const Named times("*_recorded_*_time", {node, sort}, {record.name});
    columns.add(times, "s", times.name(), record.time);
    columns.add({"*_recorded_*", {node, sort}, {std::string(word), node, record.name}}, unit, times.name(),
                std::move(scaled));
  }
}

}  // namespace frahm::studies
