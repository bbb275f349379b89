#include "studies/provenance/study_changes.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "studies/provenance/document_changes.hpp"
#include "studies/reading/keys/repetition.hpp"
#include "studies/reading/parse_study.hpp"
#include "studies/reading/settings.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/text/toml_reading.hpp"
#include "tests/studies/small_studies.hpp"
#include "tests/studies/small_tunings.hpp"

namespace study_changes_test {
namespace {

using namespace frahm::studies;
using small_studies::axis, small_studies::oscillator;
using Lines = std::vector<std::string>;

const std::string map = oscillator() + axis("f", 0, 1, 5) + axis("r", 0.1, 2, 11);

std::string with(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

Lines changes(const std::string& kept, const std::string& now) {
  return study_changes(parse_study(kept, "small.toml"), parse_study(now, "small.toml"));
}

TEST_CASE("what has changed of a map is named: what it records, its axes, how it is computed") {
  const std::string output = map + "[output]\nquantities = [\"main_peak\"]\nborders = true\n";
  CHECK(changes(map, output) == Lines{"[output]: new"});
  CHECK(changes(output, with(output, "main_peak", "main_rms")) ==
        Lines{"[output]: quantities: [\"main_peak\"], now [\"main_rms\"]"});
  CHECK(changes(output, with(output, "borders = true", "borders = false")) ==
        Lines{"[output]: borders: true, now false"});
  CHECK(changes(output, output + "precision = \"full\"\n") == Lines{"[output]: precision: new, \"full\""});
  CHECK(changes(output, output + "resonances = [\"main\"]\n") ==
        Lines{"[output]: resonances: new, [\"main\"]"});
  CHECK(changes(map, with(map, "points = 11", "points = 12")) == Lines{"axis \"r\": points: 11, now 12"});
  CHECK(changes(map, map + "spacing = \"log\"\n") == Lines{"axis \"r\": spacing: new, \"log\""});
  CHECK(changes(map, with(map, "f = 0.2", "f = 0.3")).front().starts_with("no key by itself"));
}

TEST_CASE("a coordinate that is new or has another value is named, with its words where words count") {
  const std::string coordinate = "[[coordinate]]\nname = \"twice\"\nvalue = \"2*f\"\nunit = \"N\"\n";
  const std::string plain = with(map, "dimensionless", "SI"), kept = plain + coordinate;
  CHECK(changes(plain, kept) == Lines{"coordinate \"twice\": new"});
  CHECK(changes(kept, plain) == Lines{"coordinate \"twice\": gone"});
  CHECK(changes(kept, with(kept, "2*f", "3*f")) ==
        Lines{"coordinate \"twice\": value: \"2*f\", now \"3*f\""});
  const std::string in_kilonewton = with(kept, "\"N\"", "\"kN\"");
  const TomlValue before = read_toml({"small.toml", kept}), now = read_toml({"small.toml", in_kilonewton});
  CHECK(document_changes(before, now).empty());
  CHECK(word_changes(before, now) == Lines{"coordinate \"twice\": unit: \"N\", now \"kN\""});
}

TEST_CASE("lists that have the same tables in another order are named") {
  const std::string swapped = oscillator() + axis("r", 0.1, 2, 11) + axis("f", 0, 1, 5);
  CHECK(changes(map, swapped) == Lines{"the order of [[axis]]: axis \"r\" is now before axis \"f\""});
  const std::string spring =
      "[[element]]\nname = \"%\"\ntype = \"spring\"\nbetween = [\"ground\", \"main\"]\nstiffness = 1\n";
  const std::string one = with(spring, "%", "one"), two = with(spring, "%", "two");
  CHECK(changes(map + one + two, map + two + one) ==
        Lines{"the order of [[element]]: element \"two\" is now before element \"one\""});
  CHECK(changes(map + one, map + two + one) == Lines{"element \"two\": new"});
  const std::string orbits = map + "[output]\norbits = [{ f = 0, r = 0.1 }]\n";
  CHECK(changes(orbits, with(orbits, "f = 0, r = 0.1", "r = 0.1, f = 0")).size() == 1);
}

TEST_CASE("of a long list the first value that differs is told") {
  const auto listed = [](const std::string& third) {
    std::string text = oscillator() + "[[axis]]\nparameter = \"r\"\nvalues = [0.1, 0.2, " + third;
    for (int i = 4; i <= 30; ++i) text += ", " + std::to_string(i);
    return text + "]\n";
  };
  CHECK(changes(listed("0.3"), listed("0.4")) == Lines{"axis \"r\": values: value 3 of 30: 0.3, now 0.4"});
}

TEST_CASE("what has changed of a tuning is named: its band, its bounds, its objective") {
  const std::string tuning = small_tunings::classical;
  const auto one = [&](const std::string& from, const std::string& to) {
    return changes(tuning, with(tuning, from, to));
  };
  CHECK(one("to = 1.3", "to = 1.4") == Lines{"[tune]: band: to: 1.3, now 1.4"});
  CHECK(one("upper = 0.5", "upper = 0.6") == Lines{"design \"zeta\": upper: 0.5, now 0.6"});
}

TEST_CASE("a value in another unit is the same value; a changed one is told as the study writes it") {
  const auto in = [](const std::string& mass, const std::string& range) {
    return "[study]\nschema = 1\nkind = \"sweep\"\n[parameters]\nw = 1\n[[mass]]\nname = \"m\"\nmass = " +
           mass +
           "\n[[element]]\nname = \"s\"\ntype = \"spring\"\nbetween = [\"ground\", \"m\"]\nstiffness = "
           "4e4\n" +
           "[excitation]\nfrequency = \"w\"\n[[excitation.force]]\non = \"m\"\namplitude = 1\n" +
           "[[axis]]\nparameter = \"w\"\n" + range;
  };
  const std::string hertz = "unit = \"Hz\"\nfrom = 1\nto = 2\npoints = 3\n",
                    rpm = "unit = \"rpm\"\nfrom = 60\nto = 120\npoints = 3\n";
  CHECK(changes(in("80", hertz), in("{ value = 80000, unit = \"g\" }", rpm))
            .front()
            .starts_with("no key by itself"));
  // 181 values of which the last bits differ.
  CHECK(changes(in("80", "unit = \"rpm\"\nfrom = 300\nto = 1200\npoints = 181\n"),
                in("80", "unit = \"Hz\"\nfrom = 5\nto = 20\npoints = 181\n")) ==
        Lines{"axis \"w\": its unit: rpm, now Hz: the same apart from rounding"});
  CHECK(changes(in("{ value = 0.3, unit = \"kg\" }", hertz),
                in("{ value = 300.00000000000006, unit = \"g\" }", hertz)) ==
        Lines{"mass \"m\": mass: 0.3 kg, now 300.00000000000006 g: the same apart from rounding"});
  CHECK(changes(in("80", hertz), in("{ value = 90, unit = \"kg\" }", with(rpm, "120", "180"))) ==
        Lines{"mass \"m\": mass: 80, now 90 kg", "axis \"w\": to: 2 Hz, now 180 rpm"});
}

TEST_CASE("a parameter that a run has set otherwise has changed, in its unit") {
  const Study study = parse_study(map, "small.toml");
  CHECK(study_changes(study, with_settings(study, {"zeta=0.1"})) == Lines{"parameter zeta: 0.05, now 0.1"});
}

// The places of a document's single values, a list's first alone: "element.stiffness" to one of them.
using Places = std::map<std::string, TomlValue*>;
void add_places(TomlValue& value, const std::string& path, Places& places) {
  if (auto* table = std::get_if<TomlTable>(&value.content)) {
    for (TomlEntry& entry : *table) add_places(entry.value, path + "." + entry.key, places);
  } else if (auto* list = std::get_if<TomlArray>(&value.content)) {
    for (TomlValue& each : *list) add_places(each, path, places);
  } else {
    places.try_emplace(path, &value);
  }
}

void change(TomlValue& value) {
  if (auto* flag = std::get_if<bool>(&value.content)) *flag = !*flag;
  if (auto* whole = std::get_if<std::int64_t>(&value.content)) *whole += 1;
  if (auto* number = std::get_if<double>(&value.content)) *number = *number * 1.5 + 1.0;
  if (auto* text = std::get_if<std::string>(&value.content)) *text += "_";
}

TEST_CASE("whatever key of the project's studies is changed, the change is told") {
  std::set<std::string> tried;
  for (const auto& file : std::filesystem::recursive_directory_iterator(FRAHM_SOURCE_DIR "/studies")) {
    if (file.path().extension() != ".toml") continue;
    std::ifstream stream(file.path());
    const StudySource source{file.path().string(), {std::istreambuf_iterator<char>(stream), {}}};
    TomlValue document = with_repetitions(source, read_toml(source));
    std::erase_if(std::get<TomlTable>(document.content), [](const TomlEntry& entry) {  // no result needs them
      return entry.key == "report" || entry.key == "study";
    });
    CHECK(document_changes(document, document).empty());
    Places all;
    add_places(document, "", all);
    for (const auto& [path, value] : all) {
      if (!tried.insert(path).second) continue;
      const TomlValue before = *value;
      const TomlValue kept = document;
      change(*value);
      INFO(file.path() << ": " << path);
      CHECK_FALSE(word_changes(kept, document).empty());
      static const std::set<std::string> labels{".coordinate.unit", ".coordinate.long_name", ".column.unit"};
      CHECK((labels.contains(path) || !document_changes(kept, document).empty()));
      *value = before;
    }
  }
  CHECK(tried.size() > 150);
}

}  // namespace
}  // namespace study_changes_test
