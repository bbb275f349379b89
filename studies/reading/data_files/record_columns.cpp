#include "studies/reading/data_files/record_columns.hpp"

#include <fmt/format.h>

#include "studies/reading/data_files/csv_columns.hpp"
#include "studies/reading/data_files/hdf5_columns.hpp"

namespace frahm::studies {

std::string RawRecord::where(const RawColumn& column, std::size_t row) const {
  return has_lines ? fmt::format("{}:{}: {}", file, rows[row], column.called)
                   : fmt::format("{}: {}: value {}", file, column.called, rows[row]);
}

StudyError data_error(Rule rule, const TomlSection& record, const std::string& message) {
  return data_error(rule, record, record.require("file").position, message);
}

StudyError data_error(Rule rule, const TomlSection& record, Position file, const std::string& message) {
  return record.source().error_at(rule, file, "{}: {}", record.where(), message);
}

RawRecord read_columns(ColumnReading reading, const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / reading.result.file;
  const std::string ending = path.extension().string();
  const bool is_hdf5 = ending == ".h5" || ending == ".hdf5" || ending == ".nc";
  return is_hdf5 ? read_hdf5_columns(std::move(reading), path) : read_csv_columns(reading, path);
}

RawRecord read_columns(const TomlSection& record, const std::filesystem::path& folder,
                       const std::vector<RecordForm>& forms) {
  ColumnReading reading{.record = record, .forms = forms, .file = record.require("file").position};
  reading.result.file = record.text("file");
  return read_columns(std::move(reading), folder);
}

}  // namespace frahm::studies
