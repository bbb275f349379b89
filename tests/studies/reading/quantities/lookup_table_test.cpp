#include "studies/reading/quantities/lookup_table.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>

#include "studies/reading/text/study_source.hpp"

namespace lookup_table_test {
namespace {

using frahm::studies::Dual;
using frahm::studies::LookupTable;
using frahm::studies::read_lookup_table;
using frahm::studies::StudyError;

// A file of the given text in the folder of temporary files, gone at the end.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text)
      : path_(std::filesystem::temp_directory_path() /
              ("frahm_lookup_table_" + std::to_string(getpid()) + "_test.csv")) {
    std::ofstream(path_) << text;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

std::string complaint_about(const std::string& text) {
  const TemporaryFile file(text);
  try {
    read_lookup_table(file.path());
  } catch (const StudyError& error) {
    return error.what();
  }
  return "none";
}

TEST_CASE("a table is linear between its points, exact at them and nothing outside") {
  const LookupTable table{{1.0, 2.0, 4.0}, {10.0, 20.0, 0.0}};
  CHECK(table.at(1.0) == 10.0);
  CHECK(table.at(1.5) == 15.0);
  CHECK(table.at(2.0) == 20.0);
  CHECK(table.at(3.0) == 10.0);
  CHECK(table.at(4.0) == 0.0);
  CHECK(std::isnan(table.at(0.999)));
  CHECK(std::isnan(table.at(4.001)));
  CHECK(std::isnan(table.at(std::nan(""))));
}

TEST_CASE("a table carries its slope, at a point that of the piece on the right") {
  const LookupTable table{{1.0, 2.0, 4.0}, {10.0, 20.0, 0.0}};
  CHECK(table.at(Dual{1.5, 3.0}).derivative == 30.0);
  CHECK(table.at(Dual{2.0, 1.0}).derivative == -10.0);
  CHECK(table.at(Dual{4.0, 1.0}).derivative == -10.0);
}

TEST_CASE("a table is read from a file with or without a header") {
  for (const char* text :
       {"omega,I\n15,4.72\n35,12.9\n", "15;4.72\n35;12.9", "# schedule\n\n15\t4.72\r\n35 , 12.9\r\n"}) {
    INFO(text);
    const TemporaryFile file(text);
    const LookupTable table = read_lookup_table(file.path()).table;
    CHECK(table.x == std::vector<double>{15.0, 35.0});
    CHECK(table.y == std::vector<double>{4.72, 12.9});
  }
}

TEST_CASE("the header of a table gives the units of its columns") {
  const TemporaryFile file("speed [rad/s],k [kN/m]\n10,1\n20,2\n");
  const auto read = read_lookup_table(file.path());
  CHECK(read.x_unit == "rad/s");
  CHECK(read.y_unit == "kN/m");
  CHECK(read.table.y == std::vector<double>{1.0, 2.0});
}

TEST_CASE("a wrong table is told with file and line") {
  CHECK_THAT(complaint_about("1,2\n3\n"), Catch::Contains("test.csv:2: a row has two columns"));
  CHECK_THAT(complaint_about("1,2\n3,x\n"),
             Catch::Contains("test.csv:2: both columns must be numbers, found \"3,x\""));
  CHECK_THAT(complaint_about("a,b\nc,d\n"), Catch::Contains("test.csv:2: both columns must be numbers"));
  CHECK_THAT(complaint_about("1,2\n1,3\n"), Catch::Contains("test.csv:2: the first column must increase"));
  CHECK_THAT(complaint_about("1,2\n2,3,4\n"), Catch::Contains("test.csv:2: both columns must be numbers"));
  CHECK_THAT(complaint_about("1,2\n2,nan\n"), Catch::Contains("test.csv:2: both columns must be numbers"));
  CHECK_THAT(complaint_about("1,2\n"), Catch::Contains("at least two rows"));
  CHECK_THROWS_AS(read_lookup_table("no_such_table.csv"), StudyError);
}

}  // namespace
}  // namespace lookup_table_test
