// run --from: files that cannot be grown from, results that grow in their own place, and their logs.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <tuple>

#include "results/report/page_data.hpp"
#include "tests/end_to_end/grown_maps.hpp"
#include "tests/end_to_end/runs.hpp"
#include "tests/results/whole_map.hpp"
#include "tests/studies/small_studies.hpp"

namespace growing_files_test {
namespace {

using grown_maps::Points, grown_maps::points_of, grown_maps::provenance, grown_maps::run,
    grown_maps::same_point, grown_maps::variable_size;
using runs::Folder, runs::frahm, runs::Map, runs::read_map, runs::reduced;
using small_studies::axis, small_studies::axis_of, small_studies::oscillator;
using Names = std::vector<std::string>;

const std::string small = oscillator() + axis("f", 0, 1, 5) + axis("r", 0.2, 2, 31);
const std::string larger = oscillator() + axis("f", 0, 1, 9) + axis("r", 0.2, 2, 61);

TEST_CASE("a file of another grid at the output is refused with the words that make it grow, and they do") {
  const Folder folder;
  const std::string study = folder.write("small.toml", small), output = folder / "small.h5";
  REQUIRE(run(study, output).code == 0);
  folder.write("small.toml", larger);
  const auto refused = run(study, output);
  CHECK(refused.code == 5);
  CHECK_THAT(refused.err, Catch::Contains("add --from " + output + " to reuse its points"));
  const auto grown = run(study, output, {"--from", output});
  CHECK(grown.code == 0);
  CHECK(points_of(grown.out) == Points{5 * 31, 9 * 61 - 5 * 31});
  CHECK(folder.names() == Names{"small.h5", "small.toml"});
  for (const Names& again : {Names{}, Names{"--from", output}}) {
    const auto outcome = run(study, output, again);
    CHECK(outcome.code == 0);
    CHECK_THAT(outcome.out, Catch::Contains("computed already"));
  }
}

TEST_CASE("a coordinate that is changed or new is written by --from, which computes no point") {
  const Folder folder;
  const auto beside = [](const std::string& value) {
    return small + "[[coordinate]]\nname = \"twice\"\nvalue = \"" + value + "\"\n";
  };
  const std::string study = folder.write("small.toml", small), output = folder / "small.h5";
  REQUIRE(run(study, output).code == 0);
  for (const auto& [text, told, last] :
       {std::tuple{beside("2*f"), "coordinate \"twice\": new", 2.0},
        std::tuple{beside("3*f"), "coordinate \"twice\": value: \"2*f\", now \"3*f\"", 3.0}}) {
    folder.write("small.toml", text);
    const auto refused = run(study, output);
    CHECK(refused.code == 5);
    CHECK_THAT(refused.err, Catch::Contains(told) && Catch::Contains("add --from " + output));
    const auto grown = run(study, output, {"--from", output});
    CHECK(grown.code == 0);
    CHECK(points_of(grown.out) == Points{5 * 31, 0});
    CHECK(read_map(output).coordinate("twice").back() == last);
  }
}

TEST_CASE("a title or [report] that is changed is written by a rerun, without a point computed") {
  const Folder folder;
  const std::string study = folder.write("small.toml", small), output = folder / "small.h5";
  REQUIRE(run(study, output).code == 0);
  CHECK_THAT(run(study, output).out, !Catch::Contains("written"));
  std::string text = small + "[report]\nheadline = \"main\"\n";
  const std::string title = "title = \"small\"";
  REQUIRE(text.find(title) != std::string::npos);
  text.replace(text.find(title), title.size(), "title = \"other\"");
  folder.write("small.toml", text);
  const auto told = run(study, output);
  CHECK(told.code == 0);
  CHECK_THAT(told.out,
             Catch::Contains("computed already") &&
                 Catch::Contains("nothing is computed; these changes are written into " + output + ":") &&
                 Catch::Contains("title: \"small\", now \"other\"") && Catch::Contains("[report]: new"));
  CHECK(read_map(output).layout.title == "other");
  CHECK_THAT(run(study, output).out, Catch::Contains("computed already") && !Catch::Contains("written"));
  CHECK_THAT(run(study, output, {"--from", output}).out,
             Catch::Contains("computed already") && !Catch::Contains("written"));
}

TEST_CASE("what the page shows follows a headline that is changed, without a point computed") {
  const Folder folder;
  const std::string study = folder.write("small.toml", small), output = folder / "small.h5";
  const auto first_shown = [&] {
    return ::frahm::results::page_list(::frahm::results::MapReader(output), "shown").value().front();
  };
  REQUIRE(run(study, output).code == 0);
  CHECK(first_shown() == "main_peak");
  folder.write("small.toml", small + "[report]\nheadline = \"spring\"\n");
  const auto told = run(study, output);
  CHECK_THAT(told.out, Catch::Contains("nothing is computed") && Catch::Contains("[report]: new"));
  CHECK(first_shown() == "spring_stroke");
}

TEST_CASE("a map never takes the place of one it grows from that has points it has not") {
  const Folder folder;
  const std::string study = folder.write("map.toml", larger), output = folder / "map.h5";
  REQUIRE(run(study, output).code == 0);
  const std::string r = axis("r", 0.2, 2, 31);
  const auto refused = [&](const std::string& text, const std::string& lost, const Names& more) {
    Names arguments{"--from", output};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto outcome = run(folder.write("map.toml", text), output, arguments);
    CHECK(outcome.code == 5);
    CHECK_THAT(outcome.err, Catch::Contains(output + " is the result of the same physics for other points") &&
                                Catch::Contains("holds " + lost + " points that this grid does not have"));
    CHECK(variable_size(read_map(output)) == 9 * 61);
    CHECK(folder.names() == Names{"map.h5", "map.toml"});
  };
  for (const Names& more : {Names{}, Names{"--fresh"}, Names{"--shard", "0/2"}}) {
    refused(small, std::to_string(9 * 61 - 5 * 31), more);
    refused(oscillator() + axis_of("f", "[0, 0.5, 3]") + r, std::to_string(9 * 61 - 2 * 31), more);
    const std::string zip = "zip = \"line\"\n";  // of points (0, 0.2), (0.5, 0.5), (0.5, 0.2) and none
    refused(oscillator() + axis_of("f", "[0, 0.5, 0.5, 0.5, 3]", zip) +
                axis_of("r", "[0.2, 0.5, 0.2, 0.2, 1]", zip),
            std::to_string(9 * 61 - 3), more);
  }
  folder.write("map.toml", small);
  CHECK(points_of(run(study, folder / "other.h5", {"--from", output}).out) == Points{5 * 31, 0});
}

TEST_CASE("what cannot be grown from is refused: another system, no map, no common value, no such file") {
  const Folder folder;
  const std::string study = folder.write("small.toml", small), output = folder / "new.h5";
  REQUIRE(run(study, folder / "old.h5", {"--set", "zeta=0.1"}).code == 0);
  const auto refused = [&](const std::string& text, const std::string& from, int code) {
    const auto outcome = run(folder.write("new.toml", text), output, {"--from", from});
    CHECK(outcome.code == code);
    return outcome.err;
  };
  const std::string kept = provenance(folder / "old.h5", "fingerprint_physics");
  CHECK_THAT(refused(small, folder / "old.h5", 5), Catch::Contains("another system (" + kept) &&
                                                       Catch::Contains("this study has") &&
                                                       Catch::Contains("leave out --from"));
  REQUIRE(run(study, folder / "old.h5", {"--fresh"}).code == 0);
  CHECK_THAT(refused(oscillator() + axis("f", 2, 3, 5) + axis("r", 0.2, 2, 31), folder / "old.h5", 2),
             Catch::Contains("\"f\" has no value in common"));
  CHECK_THAT(refused(small, folder / "none.h5", 6), Catch::Contains("none.h5"));
  CHECK_THAT(refused(small, study, 6), Catch::Contains("small.toml: is not an HDF5 file"));
  const std::string empty = folder.write("empty.h5", "");
  CHECK_THAT(refused(small, empty, 6), Catch::Contains("empty.h5: is not an HDF5 file"));
  std::filesystem::remove(empty);
  const Folder another;
  CHECK_THAT(refused(small, another / "", 6), Catch::Contains("is a folder"));
  for (const auto& [name, kind] : {std::pair{"tune_classical", "is a tuning, not a map"},
                                   std::pair{"lecture_free_vibration", "is one motion, not a map"}}) {
    const std::string result = another / "other.h5";
    REQUIRE(run(another.write("other.toml", reduced(name, {})), result, {"--fresh"}).code == 0);
    CHECK_THAT(refused(small, result, 2), Catch::Contains("--from " + result + ": " + kind));
  }
  for (const std::string name : {"tune_classical", "lecture_free_vibration"}) {
    CHECK_THAT(refused(reduced(name, {}), folder / "old.h5", 2), Catch::Contains("--from is for maps"));
  }
  CHECK(folder.names() == Names{"new.toml", "old.h5", "small.toml"});
}

TEST_CASE("logs of a map that grows are never mixed with others, and the message says how to resume") {
  const Folder folder;
  const std::string study = folder.write("new.toml", larger), output = folder / "new.h5";
  REQUIRE(run(folder.write("old.toml", small), folder / "old.h5").code == 0);
  REQUIRE(run(folder / "old.toml", folder / "other.h5", {"--from", folder / "old.h5"}).code == 0);
  const Names from{"--from", folder / "old.h5"}, other{"--from", folder / "other.h5"};
  const auto begun = [&](Names more) {
    more.insert(more.end(), {"--shard", "1/2", "--fresh"});
    REQUIRE(run(study, output, more).code == 0);
  };
  const auto refused = [&](const Names& more) {
    const auto outcome = run(study, output, more);
    CHECK(outcome.code == 5);
    return outcome.err;
  };
  begun({});
  CHECK_THAT(refused(from), Catch::Contains("begun without --from"));
  CHECK(run(study, output).code == 0);
  std::filesystem::remove(output);
  begun(from);
  CHECK_THAT(refused({}), Catch::Contains("add --from " + folder / "old.h5" + " to resume"));
  CHECK_THAT(refused(other), Catch::Contains("begun with --from " + folder / "old.h5"));
  CHECK(run(study, output, from).code == 0);
  // Another grid has logs there:
  REQUIRE(run(folder / "old.toml", folder / "half.h5", {"--shard", "0/2"}).code == 0);
  const auto outcome = run(study, folder / "half.h5", from);
  CHECK(outcome.code == 5);
  CHECK_THAT(outcome.err,
             Catch::Contains("another grid") && Catch::Contains("merge") && Catch::Contains("--partial"));
}

TEST_CASE("shards that grow a map in its place are merged into it, and a part never replaces it") {
  const Folder folder;
  const std::string study = folder.write("map.toml", small), output = folder / "map.h5";
  REQUIRE(run(study, output).code == 0);
  folder.write("map.toml", reduced("den_hartog", {}));  // of another system: it does not touch the file
  CHECK(run(study, output, {"--from", output, "--shard", "0/2"}).code == 5);
  folder.write("map.toml", larger);
  const auto whole = run(study, folder / "whole.h5", {"--from", output});
  REQUIRE(whole.code == 0);
  const std::string before = provenance(output, "finished");
  REQUIRE(run(study, output, {"--from", output, "--shard", "0/2"}).code == 0);
  const auto part = frahm({"merge", output, "--partial"});
  CHECK(part.code == 6);
  CHECK_THAT(part.err, Catch::Contains("would replace it"));
  CHECK(variable_size(read_map(output)) == 5 * 31);
  REQUIRE(run(study, output, {"--from", output, "--shard", "1/2"}).code == 0);
  REQUIRE(frahm({"merge", output}).code == 0);
  const Map merged = read_map(output), at_once = read_map(folder / "whole.h5");
  for (std::size_t i = 0; i < variable_size(merged); ++i) REQUIRE(same_point(merged, i, at_once, i));
  CHECK(folder.names() == Names{"map.h5", "map.toml", "whole.h5"});
}

TEST_CASE("logs left behind by a kill after the map has grown in its place are cleared away") {
  const Folder folder, aside;
  const std::string study = folder.write("map.toml", small), output = folder / "map.h5";
  REQUIRE(run(study, output).code == 0);
  folder.write("map.toml", larger);
  REQUIRE(run(study, output, {"--from", output, "--shard", "0/2"}).code == 0);
  for (const std::string& name : folder.names()) std::filesystem::copy(folder / name, aside / name);
  REQUIRE(run(study, output, {"--from", output}).code == 0);
  for (const std::string& name : aside.names()) {
    if (name != "map.h5" && name != "map.toml") std::filesystem::copy(aside / name, folder / name);
  }
  REQUIRE(folder.names().size() > 2);
  CHECK_THAT(run(study, output).out, Catch::Contains("computed already"));
  CHECK(folder.names() == Names{"map.h5", "map.toml"});
}

TEST_CASE(
    "the state of a map that grows is told of its points, before that of the file whose place it takes") {
  const Folder folder;
  const std::string study = folder.write("map.toml", small), output = folder / "map.h5";
  REQUIRE(run(study, output).code == 0);
  folder.write("map.toml", larger);
  REQUIRE(run(study, output, {"--from", output, "--shard", "0/2"}).code == 0);
  const auto grows = frahm({"status", output});
  CHECK(grows.code == 0);
  CHECK_THAT(grows.out, Catch::StartsWith(output + ": a newer run is in progress or was stopped\npoints ") &&
                            Catch::Contains(" of 549 done") &&
                            Catch::Contains("\n" + output + ": finished\n"));
  CHECK_THAT(grows.out, !Catch::Contains("unknown"));

  const std::string apart = folder / "apart.h5";
  REQUIRE(run(study, apart, {"--from", output, "--shard", "0/2"}).code == 0);
  CHECK_THAT(frahm({"status", apart}).out,
             Catch::StartsWith(apart + ": unfinished\npoints ") && Catch::Contains(" of 549 done"));
  REQUIRE(frahm({"merge", apart, "--partial"}).code == 0);
  CHECK_THAT(
      frahm({"status", apart}).out,
      Catch::StartsWith(apart + ": a part, made from the logs next to it; its run continues\npoints "));
  REQUIRE(run(study, apart, {"--from", output, "--shard", "1/2"}).code == 0);
  CHECK(frahm({"merge", apart}).code == 0);
  CHECK_THAT(frahm({"status", apart}).out, Catch::StartsWith(apart + ": finished\n"));
}

// Writes over some bytes of a file.
void damage(const std::string& path, std::initializer_list<double> places) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  const auto size = static_cast<double>(std::filesystem::file_size(path));
  for (const double place : places) {
    file.seekp(static_cast<std::streamoff>(place * size));
    file.write("damaged", 7);
  }
}

TEST_CASE("a damaged earlier file is told by its name, and ends the run without a result") {
  const Folder folder;
  const std::string earlier = folder / "old.h5";
  folder.write("new.toml", reduced("den_hartog", {{"r", 241}}));
  const auto grown_from_damaged = [&](std::initializer_list<double> places) {
    REQUIRE(run(folder.write("old.toml", reduced("den_hartog", {{"r", 121}})), earlier, {"--fresh"}).code ==
            0);
    damage(earlier, places);
    const auto outcome = run(folder / "new.toml", folder / "new.h5", {"--from", earlier});
    CHECK(outcome.code == 6);
    CHECK(folder.names() == Names{"new.toml", "old.h5", "old.toml"});
    std::filesystem::remove(earlier);
    return outcome.err;
  };
  // The middle of the file is data, its lists of what there is lie scattered among them.
  CHECK_THAT(grown_from_damaged({0.5}), Catch::Contains(earlier + ":/") && Catch::Contains("cannot read") &&
                                            Catch::Contains("without --from"));
  CHECK_THAT(grown_from_damaged({0.0}), Catch::Contains(earlier));
  CHECK_THAT(grown_from_damaged({0.25, 0.3, 0.4, 0.5, 0.55, 0.6, 0.7, 0.75, 0.8, 0.9, 0.95, 0.99}),
             Catch::Contains(earlier));
}

// A result with other values of some variables.
void edit(const std::string& path, const std::function<void(Map&)>& change) {
  Map map = read_map(path);
  const auto texts = ::frahm::results::MapReader(path).texts("provenance");
  change(map);
  for (std::size_t d = 0; d < map.layout.axes.size(); ++d) map.layout.chunk[d] = map.layout.axes[d].size;
  std::vector<std::vector<double>> values;
  for (auto& variable : map.layout.variables) {
    if (!variable.flags.empty()) variable.flags.push_back({"by_hand", 77});
    values.push_back(map[variable.name]);
  }
  ::frahm::results::MapWriter writer(path, map.layout);
  write_whole_map(writer, map.layout, values);
  writer.write_texts("provenance", texts);
  writer.finish();
}

TEST_CASE("a value that no run records is told by its place and never taken over") {
  const Folder folder;
  const std::string earlier = folder / "old.h5", output = folder / "new.h5";
  const std::string study = folder.write("old.toml", small);
  folder.write("new.toml", larger);
  for (const auto& [variable, value] :
       {std::pair{"status", 77.0}, std::pair{"friction_regime", 77.0}, std::pair{"friction_stops", -7.0}}) {
    REQUIRE(run(study, earlier, {"--fresh"}).code == 0);
    edit(earlier, [name = variable, wrong = value](Map& map) { map.values.at(name)[2 * 31 + 7] = wrong; });
    const auto outcome = run(folder / "new.toml", output, {"--from", earlier});
    CHECK(outcome.code == 6);
    CHECK_THAT(outcome.err,
               Catch::Contains(earlier + ":/" + variable + "[2,7]: ") &&
                   Catch::Contains(value == 77.0 ? "77 is not one of its flags" : "-7 is no count"));
    CHECK_FALSE(std::filesystem::exists(output));
    REQUIRE(run(study, earlier, {"--fresh"}).code == 0);
    CHECK(run(folder / "new.toml", output, {"--from", earlier, "--fresh"}).code == 0);
    std::filesystem::remove(output);
  }
}

TEST_CASE("a point whose status is ok and that has no value is computed") {
  const Folder folder;
  const std::string earlier = folder / "old.h5", study = folder.write("old.toml", small);
  REQUIRE(run(study, earlier).code == 0);
  edit(earlier, [](Map& map) {
    for (const auto& variable : map.layout.variables) {
      const bool is_count = variable.type == ::frahm::results::Type::int32;
      if (variable.name != "status")
        map.values.at(variable.name)[5] = !variable.flags.empty() ? 0.0 : is_count ? -1.0 : std::nan("");
    }
  });
  const auto outcome = run(folder.write("new.toml", larger), folder / "new.h5", {"--from", earlier});
  CHECK(points_of(outcome.out) == Points{5 * 31 - 1, 9 * 61 - 5 * 31 + 1});
  CHECK(read_map(folder / "new.h5")["main_peak"][10] > 0.0);
}

}  // namespace
}  // namespace growing_files_test
