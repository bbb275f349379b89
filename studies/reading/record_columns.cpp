#include "studies/reading/record_columns.hpp"

#include <fmt/format.h>

namespace frahm::studies {

std::string RawRecord::where(const RawColumn& column, std::size_t row) const {
  return has_lines ? fmt::format("{}:{}: {}", file, rows[row], column.called)
                   : fmt::format("{}: {}: value {}", file, column.called, rows[row]);
}

StudyError data_error(Rule rule, const TomlSection& record, const std::string& message) {
  return record.source().error_at(rule, record.require("file").position, "{}: {}", record.where(), message);
}

RawRecord read_columns(const TomlSection& record, const std::filesystem::path& folder,
                       const std::vector<RecordForm>& forms) {
  ColumnReading reading{record, forms};
  reading.result.file = record.text("file");
  const std::filesystem::path path = folder / reading.result.file;
  const std::string ending = path.extension().string();
  const bool is_hdf5 = ending == ".h5" || ending == ".hdf5" || ending == ".nc";
  return is_hdf5 ? read_hdf5_columns(std::move(reading), path) : read_csv_columns(reading, path);
}

}  // namespace frahm::studies
