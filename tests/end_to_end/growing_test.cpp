// run --from: a map that takes over the points an earlier result holds.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/end_to_end/grown_maps.hpp"
#include "tests/end_to_end/runs.hpp"
#include "tests/studies/small_studies.hpp"

namespace growing_test {
namespace {

using grown_maps::Points, grown_maps::points_of, grown_maps::provenance, grown_maps::run,
    grown_maps::same_point, grown_maps::variable_size;
using runs::Folder, runs::frahm, runs::Map, runs::read_map, runs::reduced, runs::replaced;
using small_studies::axis, small_studies::axis_of, small_studies::oscillator;
using Names = std::vector<std::string>;

// Where the error bound does not hold, of stuck masses and at the resonance of an undamped one: both
// responses are solved to a residual of 1e-13, and the multipliers there are within 1e-2 of 1.
constexpr double relative_without_bound = 1e-10;

// Two studies in a folder: the first run into old.h5, the second from it into new.h5.
struct Growth {
  Folder folder;
  runs::Outcome outcome;
  Growth(const std::string& earlier, const std::string& later, int earlier_code = 0) {
    REQUIRE(run(folder.write("old.toml", earlier), folder / "old.h5").code == earlier_code);
    outcome = run(folder.write("new.toml", later), folder / "new.h5", {"--from", folder / "old.h5"});
    INFO(outcome.err);
    CHECK_FALSE(outcome.out.empty());
  }
  Points points() const { return points_of(outcome.out); }
  Map earlier() const { return read_map(folder / "old.h5"); }
  Map map() const { return read_map(folder / "new.h5"); }
};

// Held against the same map computed from nothing: whatever is counted or named is the same, and the
// displacements are within the error bounds that the two files state.
void check_agreement(const Map& grown, const Map& fresh) {
  REQUIRE(grown.layout.variables.size() == fresh.layout.variables.size());
  double worst = 0.0, worst_without = 0.0;
  for (const auto& variable : fresh.layout.variables) {
    INFO(variable.name);
    if (variable.type == ::frahm::results::Type::flag || variable.type == ::frahm::results::Type::int32)
      CHECK(grown[variable.name] == fresh[variable.name]);
  }
  const auto &peak = fresh["main_peak"], &other = grown["main_peak"];
  const auto &bound = fresh["error_bound"], &other_bound = grown["error_bound"];
  for (std::size_t i = 0; i < peak.size(); ++i) {
    REQUIRE(std::isnan(peak[i]) == std::isnan(other[i]));
    const double difference = std::abs(peak[i] - other[i]);
    if (std::isnan(difference) || difference == 0.0) continue;
    if (std::isnan(bound[i]) || std::isnan(other_bound[i])) {
      worst_without = std::max(worst_without, difference / peak[i]);
    } else {
      worst = std::max(worst, difference / (bound[i] + other_bound[i]));
    }
  }
  CHECK(worst <= 1.0);
  CHECK(worst_without <= relative_without_bound);
  CHECK(std::ranges::none_of(grown["residual"], [](double residual) { return residual > 1e-12; }));
}

TEST_CASE("an axis with more values takes the known points over to the last bit and computes the others") {
  const Growth growth(oscillator() + axis_of("f", "[0, 0.4]") + axis("r", 0.2, 2, 31),
                      oscillator() + axis_of("f", "[0.2, 0.4, 0.6, 0]") + axis("r", 0.2, 2, 31));
  CHECK(growth.points() == Points{62, 62});
  const Map earlier = growth.earlier(), map = growth.map();
  for (std::size_t r = 0; r < 31; ++r) {
    CHECK(same_point(map, 31 + r, earlier, 31 + r));
    CHECK(same_point(map, 93 + r, earlier, r));
  }
  CHECK(provenance(growth.folder / "new.h5", "grown_from") == growth.folder / "old.h5");
  CHECK(provenance(growth.folder / "new.h5", "grown_from_identity").size() == 32);
}

TEST_CASE("axes of finer steps reuse every point of the coarser ones") {
  const std::string coarse = oscillator() + axis("f", 0, 1.2, 9) + axis("r", 0.1, 2.5, 401);
  const std::string fine = oscillator() + axis("f", 0, 1.2, 17) + axis("r", 0.1, 2.5, 801);
  const Growth growth(coarse, fine);
  CHECK(growth.points() == Points{9 * 401, 17 * 801 - 9 * 401});
  check_agreement(growth.map(), runs::run_study(fine));
  const Growth part(fine, coarse);
  CHECK(part.points() == Points{9 * 401, 0});
}

TEST_CASE("a map that grows agrees with one from nothing: Den Hartog") {
  const std::string coarse = reduced("den_hartog", {{"f", 13}, {"r", 121}});
  const std::string fine = reduced("den_hartog", {{"f", 25}, {"r", 241}});
  const Growth growth(coarse, fine);
  CHECK(growth.points() == Points{6 * 13 * 121, 6 * 25 * 241 - 6 * 13 * 121});
  check_agreement(growth.map(), runs::run_study(fine));
}

TEST_CASE("a map that grows agrees with one from nothing: the rig") {
  const std::string coarse = reduced("rig_atlas", {{"I", 4}, {"FP", 5}, {"omega", 101}});
  const std::string fine = reduced("rig_atlas", {{"I", 7}, {"FP", 9}, {"omega", 201}});
  const Growth growth(coarse, fine);
  CHECK(growth.points() == Points{4 * 5 * 101, 7 * 9 * 201 - 4 * 5 * 101});
  check_agreement(growth.map(), runs::run_study(fine));
}

TEST_CASE("a grown map is grown again") {
  const auto text = [](int f, int r) { return oscillator() + axis("f", 0, 1.2, f) + axis("r", 0.1, 2.5, r); };
  const Growth growth(text(3, 41), text(5, 81));
  const auto outcome = run(growth.folder.write("last.toml", text(9, 161)), growth.folder / "last.h5",
                           {"--from", growth.folder / "new.h5"});
  CHECK(outcome.code == 0);
  CHECK(points_of(outcome.out) == Points{5 * 81, 9 * 161 - 5 * 81});
  check_agreement(read_map(growth.folder / "last.h5"), runs::run_study(text(9, 161)));
}

TEST_CASE("axes in another order, range and unit hold the same points") {
  const std::string text = reduced("rig_atlas", {{"I", 3}, {"FP", 4}, {"omega", 41}});
  const std::size_t begin = text.find("[[axis]]"), end = text.find("[[coordinate]]");
  const std::string axes =
      "[[axis]]\nparameter = \"omega\"\nunit = \"Hz\"\nfrom = 2.5\nto = 5\npoints = 31\n" +
      axis("FP", 0.3, 0.1, 3) + "[[axis]]\nparameter = \"I\"\nunit = \"g\"\nvalues = [12900, 6000, 4720]\n";
  const Growth growth(text, text.substr(0, begin) + axes + text.substr(end));
  CHECK(growth.points() == Points{31 * 3 * 2, 31 * 3});  // an inertance of 6 kg is new
  const Map earlier = growth.earlier(), map = growth.map();
  for (const std::size_t omega : {0U, 13U, 30U}) {
    // 0.2 and 4.72 kg: the second of FP, the last of I; earlier the third and the first.
    CHECK(same_point(map, omega * 9 + 3 + 2, earlier, 2 * 41 + omega));
  }
}

TEST_CASE("points of axes that advance together are found by all their parameters") {
  const std::string r = axis("r", 0.2, 2, 11), zip = "zip = \"design\"\n";
  const auto zipped = [&](const std::string& f, const std::string& zeta) {
    return oscillator() + axis_of("f", f, zip) + r + axis_of("zeta", zeta, zip);
  };
  const std::string line = zipped("[0.1, 0.2, 0.2]", "[0.05, 0.05, 0.1]");
  CHECK(Growth(line, zipped("[0.2, 0.1, 0.2, 0.1]", "[0.1, 0.1, 0.05, 0.05]")).points() == Points{33, 11});
  const std::string product = oscillator() + axis_of("f", "[0.1, 0.2]") + axis_of("zeta", "[0.05, 0.1]") + r;
  CHECK(Growth(product, zipped("[0.2, 0.2, 0.3]", "[0.1, 0.05, 0.1]")).points() == Points{22, 11});

  const Folder folder;
  REQUIRE(run(folder.write("line.toml", line), folder / "line.h5").code == 0);
  const auto outcome =
      run(folder.write("product.toml", product), folder / "product.h5", {"--from", folder / "line.h5"});
  CHECK(outcome.code == 2);
  CHECK_THAT(outcome.err, Catch::Contains("\"design\"") && Catch::Contains("advance together"));
  CHECK(folder.names() == Names{"line.h5", "line.toml", "product.toml"});
}

TEST_CASE("a map of single precision is taken over to the last bit") {
  const std::string single = "[output]\nprecision = \"single\"\n";
  const Growth growth(oscillator() + axis("f", 0, 1, 3) + axis("r", 0.2, 2, 31) + single,
                      oscillator() + axis("f", 0, 1, 5) + axis("r", 0.2, 2, 31) + single);
  CHECK(growth.points() == Points{93, 62});
  const Map earlier = growth.earlier(), map = growth.map();
  for (std::size_t r = 0; r < 31; ++r) CHECK(same_point(map, 62 + r, earlier, 31 + r));
}

TEST_CASE("points that failed are computed again, whether a status is recorded or not") {
  const std::string r = axis_of("r", "[0.5, 0.6, 0.7]");
  for (const std::string output : {"", "[output]\nquantities = [\"main_peak\", \"friction_stops\"]\n"}) {
    const Growth growth(oscillator("\"k\"") + axis_of("k", "[1, -1]") + r + output,
                        oscillator("\"k\"") + axis_of("k", "[2, -1, 1]") + r + output, 3);
    CHECK(growth.outcome.code == 3);
    CHECK(growth.points() == Points{3, 6});
    CHECK_THAT(provenance(growth.folder / "new.h5", "failed_points"), Catch::Contains("k=-1"));
  }
}

TEST_CASE("compared responses are taken over with their own") {
  const std::string compare = "[compare]\nlaw = \"arctan\"\nslope = 1000\nquantities = [\"main_peak\"]\n";
  const Growth growth(oscillator() + axis_of("f", "[0.2]") + axis("r", 0.5, 1.5, 5) + compare,
                      oscillator() + axis_of("f", "[0.2]") + axis("r", 0.5, 1.5, 9) + compare);
  CHECK(growth.points() == Points{5, 4});
  const Map earlier = growth.earlier(), map = growth.map();
  for (std::size_t r = 0; r < 5; ++r) CHECK(same_point(map, 2 * r, earlier, r));
}

TEST_CASE("of a part of a map the points it has are taken over") {
  const Folder folder;
  const std::string study = folder.write("old.toml", reduced("den_hartog", {{"f", 7}, {"r", 101}}));
  REQUIRE(run(study, folder / "old.h5", {"--shard", "1/3"}).code == 0);
  REQUIRE(frahm({"merge", folder / "old.h5", "--partial"}).code == 0);
  const Map part = read_map(folder / "old.h5");
  const auto there = std::ranges::count_if(part["status"], [](double status) { return status != 0.0; });
  REQUIRE((there > 300 && there < 3000));
  const auto outcome = run(study, folder / "new.h5", {"--from", folder / "old.h5"});
  CHECK(outcome.code == 0);
  CHECK(points_of(outcome.out) == Points{there, 6 * 7 * 101 - there});
  const Map map = read_map(folder / "new.h5");
  for (std::size_t i = 0; i < variable_size(map); ++i) {
    if (part["status"][i] != 0.0) REQUIRE(same_point(map, i, part, i));
  }
}

}  // namespace
}  // namespace growing_test
