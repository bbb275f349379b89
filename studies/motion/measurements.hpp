#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "studies/reading/study/study.hpp"

// Simulated sensor measurements of the motion of a study, to try an experiment before it is made.
namespace frahm::studies {

// Normally distributed, independent from sample to sample, with this standard deviation.
struct SensorNoise {
  double share = 0.0;     // of each column's own standard deviation
  double absolute = 0.0;  // in the SI unit of the columns
  std::uint64_t seed = 1;
};

struct MeasurementOptions {
  double rate = 0.0;  // samples a second, > 0; 0: 100 in each period of the lowest natural mode
  std::optional<double> duration{};  // [s]; none: of the motion; of a periodic response ten periods
  SensorNoise noise{};
  std::vector<std::string> columns;  // empty: the displacement of each mass
};

struct MeasuredColumn {
  std::string name, unit;  // "main_displacement", "m"
  std::vector<double> values;
};

struct Measurements {
  std::vector<double> time;  // [s], from 0 in steps of 1 / rate
  std::vector<MeasuredColumn> columns;
  double rate = 0.0;
};

// For a decay or transient: <mass>_displacement, <mass>_velocity. Of a periodic response (a sweep or tuning,
// at these SI values of all parameters): <mass>_acceleration and <element>_force too.
// Throws StudyError for an unknown column (the known ones are listed), for a motion that is not computed, and
// for more than ten million samples.
Measurements measure(const Study& study, std::span<const double> parameters,
                     const MeasurementOptions& options);

}  // namespace frahm::studies
