#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <string>

#include "studies/reading/study_reading.hpp"

namespace frahm::studies {

// An [[axis]] of samples while it is read; its axes stand in the study.
struct SampleReading {
  const StudyContext& context;
  const TomlSection& section;
  Study& study;
  std::string zip;
  Position zip_position;
  SampleChoice choice;
};

// A new axis of a parameter, without values. Valid until the next one.
ParameterAxis& add_axis(SampleReading& reading, std::size_t parameter);

// What is reported of an axis, with its unit.
std::string with_unit_of(const ParameterAxis& axis, const std::string& told);

// Estimates of an identification that scatter together, in SI.
struct JointEstimates {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

// `fixed_from`, the result of an identification, and `parameters`, those of its estimates that scatter: each
// gets an axis. Of no size without these keys.
JointEstimates read_joint_estimates(SampleReading& reading, const std::filesystem::path& folder,
                                    DataFiles data);

}  // namespace frahm::studies
