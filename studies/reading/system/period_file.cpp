#include "studies/reading/system/period_file.hpp"

#include <fmt/format.h>

#include "studies/reading/data_files/record_columns.hpp"
#include "studies/reading/system/driving_record.hpp"
#include "studies/reading/system/period_series.hpp"
#include "studies/reading/system/recorded_excitation.hpp"

namespace frahm::studies {
namespace {

using transient::RecordOf;

// In the order of words::course_quantities.
constexpr RecordOf quantities[] = {RecordOf::displacement, RecordOf::velocity, RecordOf::acceleration};

}  // namespace

void read_period_file(NetworkReading& reading, const TomlSection& section, const mechanics::Node& node) {
  const RecordFile file{section.text("file"), section.require("file").position};
  Period period;
  period.node = node;
  period.key = "file";
  period.file = file.name;
  if (node.kind == mechanics::NodeKind::prescribed)
    period.of = quantities[static_cast<std::size_t>(section.choice_as<int>("quantity"))];
  const Samples samples = read_samples(reading.context, section, file, reading.folder, period.of,
                                       quantity_of_course(reading.result.network, period.of, node.index));
  if (samples.time.size() < 2)
    throw data_error(rules::too_few, section, file.position,
                     fmt::format("{}: {} row; at least two are needed", file.name, samples.time.size()));
  for (std::size_t i = 0; i < samples.time.size(); ++i)
    period.corners.push_back({samples.time[i] - samples.time.front(), samples.values[i]});
  add_period(reading, section, period);
}

}  // namespace frahm::studies
