#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>

namespace frahm::studies {

// A matrix from a file: Matrix Market (file.mtx), CSV (a row a line, without a header) or a dataset of two
// dimensions in HDF5 (file.h5:/path).
// name: as the study writes it, relative to `folder`; it stands in messages.
// Throws StudyError for a file that cannot be read, is of another form or holds what is not a finite number.
Eigen::MatrixXd read_matrix_file(const std::filesystem::path& folder, const std::string& name);

}  // namespace frahm::studies
