#include "studies/reading/data_files/matrix_file.hpp"

#include <cmath>

#include "results/data_reader.hpp"
#include "studies/reading/data_files/matrix_market.hpp"
#include "studies/reading/text/csv_table.hpp"
#include "studies/reading/text/readable_file.hpp"
#include "studies/reading/text/study_source.hpp"

namespace frahm::studies {
namespace {

Eigen::MatrixXd read_csv_matrix(const std::filesystem::path& path, const std::string& name) {
  const std::vector<CsvRow> rows = read_csv(path, name);
  if (rows.empty()) throw StudyError(rules::empty, "{}: holds no numbers", name);
  const std::size_t columns = rows.front().cells.size();
  Eigen::MatrixXd matrix(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::vector<std::string>& cells = rows[i].cells;
    if (cells.size() != columns)
      throw StudyError(rules::wrong_row, "{}:{}: the row has length {}, but the first one has length {}",
                       name, rows[i].line, cells.size(), columns);
    for (std::size_t j = 0; j < columns; ++j) {
      const auto value = cell_number(cells[j]);
      if (!value || !std::isfinite(*value))
        throw StudyError(rules::wrong_row, "{}:{}: number {} {}", name, rows[i].line, j + 1,
                         cell_problem(cells[j]));
      matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = *value;
    }
  }
  return matrix;
}

Eigen::MatrixXd read_hdf5_matrix(const std::filesystem::path& path, const std::string& name,
                                 const std::string& dataset) {
  check_readable(path, name);
  try {
    const results::DataMatrix data = results::DataReader(path).read_matrix(dataset);
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    return Eigen::Map<const Rows>(data.values.data(), static_cast<Eigen::Index>(data.rows),
                                  static_cast<Eigen::Index>(data.columns));
  } catch (const std::runtime_error& error) {  // StoreError
    throw StudyError(rules::wrong_file, "{}", error.what());
  }
}

Eigen::MatrixXd read_any(const std::filesystem::path& folder, const std::string& name) {
  const std::size_t colon = name.rfind(':');
  if (colon != std::string::npos)
    return read_hdf5_matrix(folder / name.substr(0, colon), name.substr(0, colon), name.substr(colon + 1));
  const std::filesystem::path path = folder / name;
  if (path.extension() == ".mtx") return read_matrix_market(path, name);
  if (path.extension() == ".csv") return read_csv_matrix(path, name);
  throw StudyError(rules::wrong_file,
                   "\"{}\" is not a matrix; a matrix is a file.mtx (Matrix Market), a file.csv or a dataset "
                   "of HDF5, file.h5:/path",
                   name);
}

}  // namespace

Eigen::MatrixXd read_matrix_file(const std::filesystem::path& folder, const std::string& name) {
  Eigen::MatrixXd matrix = read_any(folder, name);
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      if (!std::isfinite(matrix(i, j)))
        throw StudyError(rules::not_finite, "{}: entry ({}, {}) is not a finite number", name, i + 1, j + 1);
    }
  }
  return matrix;
}

}  // namespace frahm::studies
