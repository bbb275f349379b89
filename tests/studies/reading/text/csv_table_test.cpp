#include "studies/reading/text/csv_table.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "studies/reading/text/study_source.hpp"
#include "tests/studies/temporary_folder.hpp"

namespace csv_table_test {
namespace {

using namespace frahm::studies;
using Cells = std::vector<std::string>;

std::vector<CsvRow> rows_of(const std::string& text) {
  const TemporaryFolder folder;
  folder.write("data.csv", text);
  return read_csv(folder / "data.csv", "data.csv");
}

std::string complaint_about(const std::string& text) {
  try {
    rows_of(text);
  } catch (const StudyError& error) {
    return error.what();
  }
  return "none";
}

TEST_CASE("rows know their lines, whatever comments and blank lines stand between") {
  const auto rows = rows_of("\xEF\xBB\xBF# made up\r\n\r\ntime,x\r\n\n0,1\n#\n  1 , 2  \n2,3");
  REQUIRE(rows.size() == 4);
  CHECK(rows[0].line == 3);
  CHECK(rows[0].cells == Cells{"time", "x"});
  CHECK(rows[1].line == 5);
  CHECK(rows[2].line == 7);
  CHECK(rows[2].cells == Cells{"1", "2"});
  CHECK(rows[3].cells == Cells{"2", "3"});
}

TEST_CASE("a tab separates before a semicolon, and that before a comma") {
  const auto rows = rows_of("a\tb;c,d\na;b,c\na,b\na\n");
  CHECK(rows[0].cells == Cells{"a", "b;c,d"});
  CHECK(rows[1].cells == Cells{"a", "b,c"});
  CHECK(rows[2].cells == Cells{"a", "b"});
  CHECK(rows[3].cells == Cells{"a"});
  CHECK(rows[3].separator == '\0');
}

TEST_CASE("empty cells count, and quotes protect what separates") {
  CHECK(rows_of(",1,\n").front().cells == Cells{"", "1", ""});
  CHECK(rows_of("1\t\t\n").front().cells == Cells{"1", "", ""});
  CHECK(rows_of("\"S, V\",8.75\n").front().cells == Cells{"S, V", "8.75"});
  CHECK(rows_of("\"a;b\\n\",8.75\n").front().cells == Cells{"a;b\\n", "8.75"});
}

TEST_CASE("a header has no number in it, not even with a decimal comma") {
  const auto header = [](const Cells& cells) { return is_header({1, ',', cells}); };
  CHECK(header({"time", "x [mm]"}));
  CHECK_FALSE(header({"S+C", "8.75"}));
  CHECK_FALSE(header({"0,001", "x"}));
  CHECK_FALSE(header({"x", "nan"}));
}

TEST_CASE("the name of a column stands before its unit") {
  CHECK(column_name("x [mm]").name == "x");
  CHECK(column_name("x [mm]").unit == "mm");
  CHECK(column_name("damping[N s/m]").name == "damping");
  CHECK(column_name("damping[N s/m]").unit == "N s/m");
  CHECK(column_name("x").name == "x");
  CHECK_FALSE(column_name("x").unit);
  CHECK_FALSE(column_name("x [mm] raw").unit);
}

TEST_CASE("a cell is a number as a whole or not at all") {
  CHECK(cell_number("-1.5e-3") == -1.5e-3);
  CHECK(cell_number("+2") == 2.0);
  CHECK(std::isinf(*cell_number("-inf")));
  for (const char* text : {"", "+", "+-1", "1,5", "1.5 mm", "0x10", "--1"}) {
    INFO(text);
    CHECK_FALSE(cell_number(text));
  }
  CHECK(cell_problem("1,5") == "\"1,5\" is not a number; decimals are written with a point");
  CHECK(cell_problem("-") == "\"-\" is not a number");
  CHECK(cell_problem("nan") == "\"nan\" is not a finite number");
  CHECK(cell_problem("") == "is empty; must be a finite number");
}

TEST_CASE("what is no table of texts is refused with its line") {
  CHECK_THAT(complaint_about("a,b\n1,\"2\n"), Catch::StartsWith("data.csv:2: a quote is not closed"));
  CHECK_THAT(complaint_about(std::string("a\0b\n", 4)), Catch::StartsWith("data.csv: is not UTF-8 text"));
  CHECK(complaint_about("") == "none");
  CHECK_THROWS_AS(read_csv("no_such_file.csv", "no_such_file.csv"), StudyError);
  CHECK_THROWS_AS(read_csv(std::filesystem::temp_directory_path(), "folder"), StudyError);
}

}  // namespace
}  // namespace csv_table_test
