// Any bytes as a CSV file: its rows, the names and units of its columns, its numbers; then as a lookup table.
#include <cstddef>
#include <cstdint>
#include <string>

#include "studies/reading/quantities/lookup_table.hpp"
#include "studies/reading/quantities/units.hpp"
#include "studies/reading/text/csv_table.hpp"
#include "studies/reading/text/study_source.hpp"
#include "tests/fuzz/file_in_memory.hpp"
#include "tests/fuzz/outcome.hpp"

namespace {

using namespace frahm;

void parse_unit(const std::string& text) {
  static const studies::UnitSystem units;
  try {
    units.parse(text);
  } catch (const studies::UnitError&) {  // the study's author is told
  }
}

void read_rows(const std::filesystem::path& path) {
  const auto rows = studies::read_csv(path, "input.csv");
  if (rows.empty()) return;
  studies::is_header(rows.front());
  for (const auto& cell : rows.front().cells) {
    const studies::ColumnName name = studies::column_name(cell);
    if (name.unit) parse_unit(*name.unit);
  }
  for (const auto& row : rows) {
    for (const auto& cell : row.cells) {
      if (!studies::cell_number(cell)) studies::cell_problem(cell);
    }
  }
  studies::check_even(rows, "input.csv");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::FileInMemory file({data, size});
  try {
    read_rows(file.path());
    studies::read_lookup_table(file.path());
    fuzz::count(fuzz::Outcome::read);
  } catch (const studies::StudyError&) {
    fuzz::count(fuzz::Outcome::refused);
  }
  return 0;
}
