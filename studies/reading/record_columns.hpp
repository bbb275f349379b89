#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "studies/reading/record_form.hpp"
#include "studies/reading/toml_section.hpp"

// The columns of a record as its file has them: numbers in the file's own units.
namespace frahm::studies {

struct RawColumn {
  const Role* role = nullptr;       // of the form
  std::string called;               // in messages: `column 2 "x [mm]"`, `"transient/time"`
  std::optional<std::string> unit;  // as the file says
  std::vector<double> values;       // finite
};

struct RawRecord {
  std::string file;               // as the study names it
  bool has_lines = true;          // a text: its rows are lines
  std::size_t header = 0;         // its line; 0: none
  std::vector<std::size_t> rows;  // line, or number of the value from 1, of each row kept
  std::vector<RawColumn> columns;
  std::vector<std::string> labels;  // of each row kept, if there is such a column
  std::size_t doubtful = 0;         // rows left out
  bool first_is_doubtful = false;   // the first row is one of them

  // `low.csv:12: column 2 "x [mm]"`, or `low.h5: "transient/time": value 12`.
  std::string where(const RawColumn& column, std::size_t row) const;
};

// The error at the file that a record names.
StudyError data_error(Rule rule, const TomlSection& record, const std::string& message);

// A file of measurements as it is read.
struct ColumnReading {
  const TomlSection& record;
  const std::vector<RecordForm>& forms;
  RawRecord result = {};

  [[noreturn]] void fail(Rule rule, const std::string& message) const;  // at the file
  [[noreturn]] void fail(Rule rule, Position position,
                         const std::string& message) const;  // at a place of the study
};

// The columns of a file of each kind; result.file is known.
RawRecord read_csv_columns(const ColumnReading& reading, const std::filesystem::path& path);
RawRecord read_hdf5_columns(ColumnReading reading, const std::filesystem::path& path);

// The columns of a record's file, by its ending: .h5, .hdf5 and .nc are HDF5, others CSV. They are those that
// the record's `columns` name, else those whose header is the name of a role.  folder: of the study.
// Throws StudyError for a file that cannot be read, and for columns that are missing or not numbers.
RawRecord read_columns(const TomlSection& record, const std::filesystem::path& folder,
                       const std::vector<RecordForm>& forms);

}  // namespace frahm::studies
