#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "studies/reading/data_files/record_form.hpp"
#include "studies/reading/data_files/wanted_columns.hpp"
#include "studies/reading/keys/toml_section.hpp"

// The columns of a record as stored in its file, in the file's units.
namespace frahm::studies {

struct RawColumn {
  const Role* role = nullptr;       // of the form
  std::string called;               // in messages: `column 2 "x [mm]"`, `"transient/time"`
  std::optional<std::string> unit;  // as the file says
  std::vector<double> values;       // finite
};

struct RawRecord {
  std::string file;               // as the study names it
  bool has_lines = true;          // a text file: its rows are lines
  std::size_t header = 0;         // its line; 0: none
  std::vector<std::size_t> rows;  // line, or number of the value from 1, of each row used
  std::vector<RawColumn> columns;
  std::vector<std::string> labels;  // of each row used, if the file has labels
  std::size_t doubtful = 0;         // rows left out
  bool first_is_doubtful = false;   // the first row is one of them

  // `low.csv:12: column 2 "x [mm]"`, or `low.h5: "transient/time": value 12`.
  std::string where(const RawColumn& column, std::size_t row) const;
};

// The error at the file that a record names, or at one named elsewhere.
StudyError data_error(Rule rule, const TomlSection& record, const std::string& message);
StudyError data_error(Rule rule, const TomlSection& record, Position file, const std::string& message);

// A file of measurements as it is read.
struct ColumnReading {
  const TomlSection& record;
  const std::vector<RecordForm>& forms;
  Position file;                          // of its name in the study
  RawRecord result = {};                  // its file is set
  std::vector<WantedColumn> wanted = {};  // empty: those of the record's `columns`

  template <class... Args>
  [[noreturn]] void fail_at_file(Rule rule, fmt::format_string<Args...> message, Args&&... args) const {
    throw data_error(rule, record, file, fmt::format(message, std::forward<Args>(args)...));
  }
  template <class... Args>
  [[noreturn]] void fail(Rule rule, Position position, fmt::format_string<Args...> message,
                         Args&&... args) const {
    throw record.source().error_at(rule, position, "{}: {}", record.where(),
                                   fmt::format(message, std::forward<Args>(args)...));
  }
};

// Those of a file by its ending: .h5, .hdf5 and .nc are HDF5, others CSV.  folder: of the study.
// Throws StudyError for a file that cannot be read, and for columns that are missing or not numbers.
RawRecord read_columns(ColumnReading reading, const std::filesystem::path& folder);

// The columns of a record's `file`, chosen by the record's `columns`, otherwise by headers that are names of
// roles.
RawRecord read_columns(const TomlSection& record, const std::filesystem::path& folder,
                       const std::vector<RecordForm>& forms);

}  // namespace frahm::studies
