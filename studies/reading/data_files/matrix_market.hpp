#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>

namespace frahm::studies {

// The adapter of the library that reads Matrix Market.
Eigen::MatrixXd read_matrix_market(const std::filesystem::path& path, const std::string& name);

}  // namespace frahm::studies
