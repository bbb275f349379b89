// The page of a result is made of its file alone: the study in it is not read again.
#include <catch2/catch.hpp>
#include <filesystem>
#include <iostream>
#include <sstream>

#include "results/hdf5.hpp"
#include "results/report/page_data.hpp"
#include "studies/program/report_content.hpp"
#include "studies/provenance/stored_study.hpp"
#include "studies/reading/text/study_source.hpp"
#include "tests/end_to_end/small_runs.hpp"
#include "tests/studies/small_tunings.hpp"

namespace page_of_file_test {
namespace {

namespace results = frahm::results;
namespace studies = frahm::studies;
using runs::Folder, runs::Names, runs::replaced, runs::run;

struct Page {
  std::string data, note;  // the note: on standard error
};

Page page_of(const std::string& file) {
  const results::MapReader result(file);
  std::ostringstream note;
  std::streambuf* const before = std::cerr.rdbuf(note.rdbuf());
  const std::string data = results::page_data(result, studies::page_content(result, file, {}, false));
  std::cerr.rdbuf(before);
  return {data, note.str()};
}

const std::string tables = "t = 5\nkt = { table = \"table.csv\", of = \"t\" }\n";
const std::string oscillator =
    replaced(small_studies::oscillator("\"kt\""), "[parameters]\n", "[parameters]\n" + tables);

// A slider that a crank drives, on a spring and a contact.
const std::string motion =
    "[study]\nschema = 1\nkind = \"transient\"\n[parameters]\n" + tables +
    "[[mass]]\nname = \"m\"\nmass = 1\n"
    "[[element]]\nname = \"k\"\ntype = \"spring\"\nbetween = [\"slider\", \"m\"]\nstiffness = \"kt\"\n"
    "[[element]]\nname = \"joint\"\ntype = \"coulomb\"\nbetween = [\"ground\", \"m\"]\nforce = 0.01\n"
    "[excitation]\nfrequency = { value = 60, unit = \"rpm\" }\n"
    "[[excitation.motion]]\nnode = \"slider\"\nprofile = \"crank\"\ncrank = 0.1\nrod = 0.5\n"
    "[transient]\nduration = 1\n";

// Runs a study that reads table.csv. Its page is the same without that table, and says these things.
void check_page(const std::string& text, const Names& says, const Names& command = {}) {
  const Folder folder;
  folder.write("table.csv", "t,kt\n0,1\n10,1\n");
  const std::string study = folder.write("study.toml", text), file = folder / "result.h5";
  if (command.empty()) {
    const auto outcome = run(study, file);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
  } else {
    Names arguments{"branch", study, "-o", file, "--progress", "none"};
    arguments.insert(arguments.end(), command.begin(), command.end());
    REQUIRE(runs::frahm(arguments).code == 0);
  }
  const Page page = page_of(file);
  for (const std::string& part : says) CHECK_THAT(page.data, Catch::Contains(part));
  CHECK(page.note.empty());
  std::filesystem::remove(folder / "table.csv");
  CHECK_THROWS_AS(studies::read_stored_study(results::MapReader(file), file), studies::StudyError);
  const Page again = page_of(file);
  CHECK(again.data == page.data);
  CHECK(again.note.empty());
}

TEST_CASE("the page of a result of each kind needs no study that can be read") {
  using small_studies::axis;
  check_page(oscillator + axis("f", 0.1, 0.3, 3) + axis("r", 0.3, 1.5, 7) +
                 "[report]\nheadline = \"spring\"\nquantities = [\"main_*\", \"status\"]\n",
             {"\"parameters\":[\"f\",\"r\"]", "\"variables\":[{\"name\":\"spring_stroke\"",
              "\"left_out\":[{\"name\":\"friction_stops\""});
  check_page(oscillator + axis("r", 0.3, 1.5, 3) +
                 "[[axis]]\nsamples = 8\nof = [{ parameter = \"f\", distribution = \"uniform\", lower = "
                 "0.1, upper = 0.2 }]\n",
             {"\"samples\":1", "\"statistics\":"});
  check_page(oscillator + axis("r", 0.3, 1.5, 7), {"\"map\":null", "\"branches\":"}, {"--along", "r"});
  check_page(motion, {"\"crank\":{", "\"slider_taylor_2_error\"", "\"study\":{", "\"excitation_frequency\"",
                      "\"frequency_unit\""});
  check_page(replaced(motion, "[transient]\nduration = 1\n",
                      "[transient]\nduration = 1\n[[axis]]\nparameter = \"t\"\nvalues = [1, 2]\n"),
             {"\"parameters\":[\"t\"]", "\"crank\":{"});
  check_page("[study]\nschema = 1\nkind = \"decay\"\n[parameters]\n" + tables +
                 "[[mass]]\nname = \"m\"\nmass = 1\n"
                 "[[element]]\nname = \"k\"\ntype = \"spring\"\nbetween = [\"ground\", \"m\"]\n"
                 "stiffness = \"kt\"\n[decay]\nduration = 3\n[[initial]]\nnode = \"m\"\ndisplacement = 1\n",
             {"\"decay\":{", "\"given_duration\""});
  using namespace small_tunings;
  check_page(replaced(replaced(heading + absorber + minimax + of_f + of_zeta, "[parameters]\n",
                               "[parameters]\n" + tables),
                      "stiffness = 1\n", "stiffness = \"kt\"\n") +
                 "[[constraint]]\nquantity = \"tmd_peak\"\nupper = 50\nband = { from = 0.8, to = 1.1 }\n",
             {"\"optimum\":{", "\"tmd_peak_band_from\""});
}

TEST_CASE("the page of an identification needs neither its study nor its data") {
  const Folder folder;
  std::string trace = "time [s],displacement [m]\n";
  for (int i = 0; i <= 400; ++i)
    trace += std::to_string(0.1 * i) + "," + std::to_string(0.02 * std::exp(-0.005 * i) * std::cos(0.1 * i)) +
             "\n";
  folder.write("turns.csv", trace);
  const std::string study = folder.write("study.toml",
                                         "study = { schema = 1, kind = \"identify\" }\n"
                                         "identify = { method = \"log_decrement\", cycles = 1, "
                                         "record = [{ name = \"d\", file = \"turns.csv\" }] }\n"),
                    file = folder / "result.h5";
  REQUIRE(run(study, file).code == 0);
  const Page page = page_of(file);
  CHECK_THAT(page.data, Catch::Contains("\"identification\":{"));
  for (const char* name : {"turns.csv", "study.toml"}) std::filesystem::remove(folder / name);
  CHECK(page_of(file).data == page.data);
  CHECK(page.note.empty());
}

// As an earlier version has written it.
void remove_page_group(const std::string& file) {
  results::hdf5::File result = results::hdf5::File::open_to_change(file);
  result.root().remove("page");
  result.close();
}

TEST_CASE("a file of an earlier version says that its page lacks something, until its study is run again") {
  const Folder folder;
  using small_studies::axis;
  const std::string study = folder.write("study.toml", small_studies::oscillator() + axis("f", 0.1, 0.3, 3) +
                                                           axis("r", 0.3, 1.5, 7) +
                                                           "[report]\nheadline = \"spring\"\n"),
                    file = folder / "result.h5";
  REQUIRE(run(study, file).code == 0);
  const Page page = page_of(file);
  remove_page_group(file);
  const Page early = page_of(file);
  CHECK_THAT(early.note, Catch::Contains("result.h5 is of an earlier version") &&
                             Catch::Contains("frahm run STUDY adds it"));
  CHECK_THAT(early.data, Catch::Contains("\"variables\":[{\"name\":\"main_peak\""));
  const auto told = run(study, file);
  CHECK(told.code == 0);
  CHECK_THAT(told.out, Catch::Contains("nothing is computed") &&
                           Catch::Contains("what the report shows of the study: new"));
  CHECK(page_of(file).data == page.data);
  CHECK(page_of(file).note.empty());
  CHECK_THAT(run(study, file).out, Catch::Contains("computed already") && !Catch::Contains("written"));
}

}  // namespace
}  // namespace page_of_file_test
