#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "studies/reading/parse_study.hpp"
#include "studies/reading/study/study.hpp"
#include "tests/studies/small_studies.hpp"

namespace wrong_studies_test {
namespace {

using frahm::studies::parse_study;
using frahm::studies::StudyError;

const std::filesystem::path folder = FRAHM_SOURCE_DIR "/tests/studies/reading/wrong";

using Lines = std::vector<std::string>;

struct Case {
  std::string head, base;
  Lines changes;
};

struct WrongStudies {
  std::map<std::string, Lines> bases;
  std::vector<Case> cases;
};

Lines parts_of(std::string text, const std::string& between) {
  Lines parts;
  for (std::size_t end; (end = text.find(between)) != std::string::npos; text.erase(0, end + between.size()))
    parts.push_back(text.substr(0, end));
  parts.push_back(text);
  return parts;
}

std::string joined(const Lines& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

// What the folder's files say; bases.txt describes how they are written. wrong_studies.py reads them too.
WrongStudies wrong_studies() {
  WrongStudies all;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".txt") continue;
    Lines before_the_first, *body = &before_the_first;
    std::string base;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      if (line.empty() || std::string(" @-+*").find(line[0]) != std::string::npos) {
        body->push_back(line);
      } else if (line.starts_with("base ")) {
        base = line.substr(5);
        body = &all.bases[base];
      } else if (line.starts_with("of ")) {
        base = line.substr(3);
      } else if (line[0] != '#') {
        body = &all.cases.emplace_back(Case{line, base, {}}).changes;
      }
    }
  }
  for (auto& [name, lines] : all.bases) {
    while (!lines.empty() && lines.back().empty()) lines.pop_back();
    for (std::string& line : lines) line.erase(0, 2);
  }
  return all;
}

// The lines of a base with one change at the place of the line before, or after its last line.
struct Changed {
  Lines lines;
  Lines::iterator at = lines.end();
  bool anchored = false;

  void add(const Lines& added) {
    at = lines.insert(at, added.begin(), added.end()) + static_cast<std::ptrdiff_t>(added.size());
  }

  void find(const std::string& line, bool remove) {
    const auto start = anchored ? at : lines.begin();
    at = std::find(start, lines.end(), line);
    INFO("not in the base, or not once: " << line);
    REQUIRE((at != lines.end() && (anchored || std::count(start, lines.end(), line) == 1)));
    at = remove ? lines.erase(at) : at + 1;
    anchored = true;
  }
};

std::string text_of(const Case& wrong, const Lines& base) {
  Changed study{base};
  for (const std::string& change : wrong.changes) {
    if (change.empty()) continue;
    const std::string mark = change.substr(0, change.find(' '));
    Lines parts = parts_of(change.substr(mark.size()), " / ");
    parts[0].erase(0, 1);
    if (mark[0] == '*') {
      for (int i = 1; i <= std::stoi(mark.substr(1)); ++i) {
        for (std::string line : parts) {
          for (std::size_t at; (at = line.find("{i}")) != std::string::npos;)
            line.replace(at, 3, std::to_string(i));
          study.add({line});
        }
      }
    } else if (mark == "+") {
      study.add(parts);
    } else {
      for (const std::string& line : parts) study.find(line, mark == "-");
    }
  }
  return "# expect: " + wrong.head.substr(wrong.head.find(" | ") + 3) + "\n" + joined(study.lines);
}

struct Refusal {
  std::string rule;     // its key
  std::string message;  // without the study's path
};

Refusal refusal_of(const std::string& text, const std::filesystem::path& path) {
  try {
    parse_study(text, path);
  } catch (const StudyError& error) {
    const std::string message = error.what(), before = path.string() + ":";
    CHECK_THAT(message, Catch::StartsWith(before));
    return {std::string(error.rule().key), message.substr(std::min(before.size(), message.size()))};
  }
  return {"none", "the study was read"};
}

TEST_CASE("a base of the wrong studies has no mistake") {
  for (const auto& [name, lines] : wrong_studies().bases) {
    INFO(name);
    CHECK(refusal_of(joined(lines), folder / (name + ".toml")).rule == "none");
  }
}

// A case's head names it, the place and the rule of its refusal, and what the message names, in this order.
TEST_CASE("every wrong study is refused at its place, by the rule it breaks, with the name that breaks it") {
  const WrongStudies all = wrong_studies();
  CHECK(all.cases.size() > 700);  // so that a folder that is not read does not pass
  for (const Case& wrong : all.cases) {
    const Lines head = parts_of(wrong.head, " | ");
    INFO(head[0]);
    REQUIRE(head.size() >= 2);
    const Refusal refusal =
        refusal_of(text_of(wrong, all.bases.at(wrong.base)), folder / (head[0] + ".toml"));
    INFO(refusal.rule << ": " << refusal.message);
    const std::size_t space = head[1].find(' ');
    CHECK(refusal.rule == head[1].substr(space + 1));
    CHECK_THAT(refusal.message, Catch::StartsWith(head[1].substr(0, space) + ": "));
    CHECK_THAT(refusal.message, !Catch::EndsWith(" mistakes"));  // nothing that only follows is told
    std::size_t at = 0;
    for (std::size_t i = 2; i < head.size(); ++i) {
      INFO("named: " << head[i]);
      at = refusal.message.find(head[i], at);
      REQUIRE(at != std::string::npos);
      at += head[i].size();
    }
  }
}

TEST_CASE("more parameters than a study may have are refused at their section") {
  const auto refusal_with = [](int parameters) {
    std::string text =
        "[study]\nschema = 1\nkind = \"sweep\"\nunits = \"dimensionless\"\n[parameters]\nr = 0.9\n";
    for (int i = 1; i < parameters; ++i) text += "p" + std::to_string(i) + " = 1\n";
    text +=
        "[[mass]]\nname = \"main\"\nmass = 1\n[[element]]\nname = \"spring\"\ntype = \"spring\"\n"
        "between = [\"ground\", \"main\"]\nstiffness = 1\n[excitation]\nfrequency = \"r\"\n"
        "[[excitation.force]]\non = \"main\"\namplitude = 1\n";
    return refusal_of(text + small_studies::axis("r", 0.2, 0.4, 3), "many.toml");
  };
  const Refusal refusal = refusal_with(2001);
  CHECK(refusal.rule == "too_large");
  CHECK_THAT(refusal.message,
             Catch::Contains("[parameters]") && Catch::Contains("2001") && Catch::Contains("at most 2000"));
  CHECK(refusal_with(2000).rule == "none");
}

// A few whole sentences, so that what users read is seen by somebody when it changes.
TEST_CASE("a refusal says what was found, the rule and the nearest name") {
  const std::map<std::string, std::string> sentences{
      {"axis_parameter_unknown",
       "34:13: axis \"omgea\": parameter: no parameter is called \"omgea\"; did you mean \"omega\"?"},
      {"axis_points_missing", "33:1: axis \"omega\": the key \"points\" is missing"},
      {"axis_unit_of_another_dimension",
       "35:8: axis \"omega\": unit: the unit \"kg\" is that of a mass, but an angular frequency is expected "
       "(such as rad/s, rpm or Hz); the parameter is used as [excitation]: frequency"},
      {"element_without_moving_node",
       "23:11: element \"damper\": between: neither \"ground\" nor \"base\" is a mass; at least one end must "
       "be a mass"},
      {"mass_negative", "12:8: mass \"main\": mass: is -102.66 kg; must be >= 0"},
      {"compare_law_and_profile",
       "43:16: [compare]: taylor_order: \"law\" is already compared; compare one thing at a time"},
      {"data_comma_mixed",
       "11:8: [[identify.record]] \"low\": data/decay_comma_mixed.csv:3: separated by commas, but line 1 by "
       "semicolons; all rows must have the same separator, and decimals are written with a point"},
      {"mass_floating_two",
       "14:1: the masses \"tmd\" and \"tip\" float free: no chain of springs leads to ground or to a node of "
       "prescribed motion, so the stiffness matrix is not positive definite; add a weak spring to ground, "
       "with a frequency far below those of interest, to hold them (a decay, a transient and a sweep or "
       "tuning of "
       "exact laws may have free masses)"},
      {"output_orbit_out_of_range",
       "24:11: element \"damper\": damping: is -1 N s/m at c = -1 N s/m ([output]: orbits); must be >= 0"},
      {"transient_coordinate_without_axis",
       "36:3: the section \"coordinate\" is not part of a transient: without an [[axis]] it computes one "
       "motion, "
       "not a map"},
      {"expression_function_unknown",
       "24:12: element \"damper\": damping: no function is called \"squrt\"; did you mean \"sqrt\"?"},
      {"units_unknown",
       "5:9: [study]: units: \"imperial\" is not possible here; write \"SI\" or \"dimensionless\""},
  };
  const WrongStudies all = wrong_studies();
  std::size_t found = 0;
  for (const Case& wrong : all.cases) {
    const std::string name = parts_of(wrong.head, " | ")[0];
    const auto sentence = sentences.find(name);
    if (sentence == sentences.end()) continue;
    INFO(name);
    ++found;
    const Refusal refusal = refusal_of(text_of(wrong, all.bases.at(wrong.base)), folder / (name + ".toml"));
    CHECK_THAT(refusal.message, Catch::StartsWith(sentence->second + "\n"));
  }
  CHECK(found == sentences.size());
}

}  // namespace
}  // namespace wrong_studies_test
