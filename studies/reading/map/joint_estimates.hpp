#pragma once

#include <Eigen/Core>
#include <filesystem>

#include "studies/reading/map/sample_axis_reading.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

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
