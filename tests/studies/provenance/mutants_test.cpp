#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "results/map_writer.hpp"
#include "studies/map/map_plan.hpp"
#include "studies/provenance/study_plan.hpp"
#include "studies/reading/keys/study_keys.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/parse_study.hpp"
#include "studies/reading/study/toml_building.hpp"
#include "studies/reading/text/toml_reading.hpp"
#include "studies/reading/text/toml_writing.hpp"
#include "studies/tuning/tuning_plan.hpp"
#include "tests/studies/temporary_folder.hpp"

// What the fingerprint forgets, an old result is given for: so each key of a study, in a study that uses it,
// is given another value, and each file that a study reads another number.
namespace mutants_test {
namespace {

using namespace frahm::studies;
using frahm::engine::Fingerprint;

// Keys whose change leaves the fingerprint, and why.
const std::map<std::string, std::string> excused{
    {"study.schema", "there is one version, 1: another value is refused"},
    {"study.title", "a word of the file, written anew"},
    {"coordinate.unit", "of display: the coordinate's numbers are made from the axis and written anew"},
    {"coordinate.long_name", "a word of the file, written anew"},
    {"column.unit", "of display: the column's numbers are converted and written anew"},
    {"report.quantities", "chosen by the page, which reads them from the study in the file"},
    {"report.headline", "chosen by the page, which reads it from the study in the file"},
    {"report.profile", "chosen by the page, which reads it from the study in the file"},
    {"report.height", "chosen by the page, which reads it from the study in the file"},
};

// A mutant that no rule below makes: passages of one study in the other's place.
struct HandMade {
  std::string key, study;
  std::vector<std::pair<std::string, std::string>> passages;
};
const std::vector<HandMade> hand_made{
    {"study.kind",
     "decay.toml",
     {{"kind = \"decay\"", "kind = \"transient\""},
      {"decay = { duration = 10, samples = 11, reference_frequency = 1 }",
       "excitation = { frequency = 1, force = [{ on = \"m\", amplitude = 0 }] }\n"
       "transient = { duration = 10, samples = 11 }"}}},
    {"element.type",
     "tune_noise.toml",
     {{"type = \"damper\", between = [\"ground\", \"m\"], damping",
       "type = \"inerter\", between = [\"ground\", \"m\"], inertance"}}},
    {"element.law",
     "sweep_arctan.toml",
     {{"law = \"arctan\", force = 0.3, slope = 50", "force = 0.3"},
      {"law = \"exact\"", "law = \"arctan\", slope = 50"}}},
    {"element.distribution",
     "sweep_sliders.toml",
     {{"distribution = \"power\"", "distribution = \"uniform\""}, {", chi = -0.5", ""}}},
    {"excitation.force.profile",
     "sweep_smooth.toml",
     {{"force = [{ node = \"m\", profile", "motion = [{ node = \"base\", profile"},
      {"[\"ground\", \"m\"], stiffness", "[\"base\", \"m\"], stiffness"}}},
    {"excitation.motion.profile",
     "sweep_sliders.toml",
     {{"profile = \"crank\", crank = \"R\", rod = { value = 100, unit = \"mm\" }, taylor_order = 4",
       "profile = \"harmonic\", amplitude = \"R\""},
      {"compare = { taylor_order = 2, quantities = [\"m_peak\"] }", ""}}},
    {"excitation.motion.node",
     "sweep_zip.toml",
     {{"node = \"base\", velocity = 1 }, { node = \"side\"",
       "node = \"side\", velocity = 1 }, { node = \"base\""}}},
    {"excitation.record.acceleration_of",
     "motions_files.toml",
     {{"acceleration_of = \"base\", unit = \"m/s2\"", "velocity_of = \"base\", unit = \"m/s\""}}},
    {"excitation.record.displacement_of",
     "transient_records.toml",
     {{"displacement_of", "acceleration_of"},
      {"unit = \"mm\"", "unit = \"mm/s2\""},
      {"interpolation = \"spline\"", ""}}},
    {"excitation.record.velocity_of",
     "transient_records.toml",
     {{"velocity_of", "displacement_of"}, {"unit = \"mm/s\"", "unit = \"mm\""}}},
    {"axis.of.distribution",
     "sweep_samples.toml",
     {{"distribution = \"triangular\", lower = 0.5, mode = 1", "distribution = \"uniform\", lower = 0.5"}}},
    {"axis.records.generate",
     "motions_generated.toml",
     {{"\"kanai_tajimi\"", "\"white\""},
      {", ground_frequency = 15.6, ground_damping = 0.6, corner_frequency = 1.5, corner_damping = 0.6, "
       "envelope = { shape = \"jennings\", rise = 0.2, level_end = 0.5, decay = 2 }",
       ""}}},
    {"axis.records.envelope.shape",
     "motions_generated.toml",
     {{"\"jennings\"", "\"trapezoid\""}, {", decay = 2", ""}}},
    {"output.branches.along",
     "sweep_sliders.toml",
     {{"along = \"omega\", at = [{ R = { value = 5, unit = \"mm\" } }]",
       "along = \"R\", at = [{ omega = 1 }]"}}},
    {"compare.law", "sweep_arctan.toml", {{"law = \"exact\"", "law = \"arctan\", slope = 50"}}},
    {"tune.dominate", "tune_schedule.toml", {{"tune = {", "tune = { dominate = \"constant\","}}},
    {"identify.method", "identify_decrement.toml", {{"\"log_decrement\", cycles = 1", "\"free_decay\""}}},
};

// The studies: those of the schema's test, and those beside this one for what these leave out.
const std::filesystem::path sources = FRAHM_SOURCE_DIR;
const std::filesystem::path of_schema = sources / "tests/end_to_end/schema/studies";
const std::filesystem::path of_mutants = sources / "tests/studies/provenance/mutants";

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  REQUIRE(file);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

Fingerprint fingerprint_of(Study study) {
  if (study.map()) return plan_map(std::move(study), {}).fingerprint;
  if (study.tune()) return plan_tuning(std::move(study), {}).fingerprint;
  return plan_without_map(std::move(study), {}).fingerprint;
}

// Nothing for a text that is no study.
std::optional<Fingerprint> fingerprint_of(const std::string& text, const std::filesystem::path& file) {
  try {
    return fingerprint_of(parse_study(text, file));
  } catch (const StudyError&) {
    return std::nullopt;
  }
}

// What an identification leaves of k and c, with their covariance and degrees of freedom.
void write_estimates(const std::filesystem::path& path, double k, double degrees_of_freedom) {
  using frahm::results::Column;
  std::vector<Column> columns;
  const auto add = [&](const std::string& name, const char* unit, double value, std::vector<double> row) {
    columns.push_back({{.name = name, .unit = unit, .long_name = name}, "", {value}});
    columns.push_back({{.name = name + "_degrees_of_freedom", .unit = "1", .long_name = "of its interval"},
                       "",
                       {degrees_of_freedom}});
    columns.push_back({{.name = name + "_covariance", .unit = "1", .long_name = "row of the covariance"},
                       "estimate",
                       std::move(row)});
  };
  add("k", "N m-1", k, {1.0, 0.01});
  add("c", "N s m-1", 3.0, {0.01, 0.04});
  frahm::results::MapWriter writer(path, {.title = "t", .source = "s", .history = "h"});
  writer.write_columns("identification", columns);
  writer.finish();
}

struct Kept {
  std::filesystem::path file;
  TomlValue document;
  Fingerprint fingerprint;
  std::set<std::string> replaced = {};  // parameters whose values an axis, the band or an estimate replaces
};

std::set<std::string> replaced_parameters(TomlValue document);

std::vector<Kept> read_studies(const TemporaryFolder& folder) {
  std::filesystem::copy(of_mutants, folder / "mutants");
  write_estimates(folder / "mutants/estimates.h5", 40.0, 12.0);
  std::vector<std::filesystem::path> files;
  for (const auto& place : {of_schema, folder / "mutants"})
    for (const auto& entry : std::filesystem::directory_iterator(place))
      if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::ranges::sort(files);
  std::vector<Kept> studies;
  for (const auto& file : files) {
    INFO(file.string());
    const std::string text = text_of(file);
    TomlValue document = read_toml({file.string(), text});
    studies.push_back({.file = file,
                       .document = document,
                       .fingerprint = fingerprint_of(parse_study(text, file)),
                       .replaced = replaced_parameters(document)});
  }
  return studies;
}

// A key where it stands in a document.
using Visit = std::function<void(const StudyKey& key, TomlEntry& entry)>;

const StudyKey* row_of(const std::string& section, const std::string& key) {
  const auto all = study_keys();
  const auto row = std::ranges::find_if(
      all, [&](const StudyKey& each) { return each.section == section && each.key == key; });
  return row == all.end() ? nullptr : &*row;
}

void visit_table(TomlValue& table, const std::string& section, const Visit& visit,
                 const std::set<std::string>& replaced = {});

// { value, unit } and { table, of } wherever they stand.
void visit_inner(TomlValue& value, const Visit& visit) {
  if (auto* list = std::get_if<TomlArray>(&value.content)) {
    for (TomlValue& each : *list) visit_inner(each, visit);
    return;
  }
  if (!value.as<TomlTable>()) return;
  if (find_entry(value, "value")) {
    visit_table(value, "{ value, unit }", visit);
  } else if (find_entry(value, "table") && find_entry(value, "of")) {
    visit_table(value, "{ table, of }", visit);
  } else {
    for (TomlEntry& entry : std::get<TomlTable>(value.content)) visit_inner(entry.value, visit);
  }
}

void visit_table(TomlValue& table, const std::string& section, const Visit& visit,
                 const std::set<std::string>& replaced) {
  for (TomlEntry& entry : std::get<TomlTable>(table.content)) {
    const StudyKey* row = row_of(section, entry.key);
    if (!row) continue;  // repeat
    visit(*row, entry);
    if (section.empty() && entry.key == "parameters") {
      for (TomlEntry& each : std::get<TomlTable>(entry.value.content))
        if (!replaced.contains(each.key)) visit_inner(each.value, visit);
      continue;
    }
    std::string path = section.empty() ? entry.key : section + "." + entry.key;
    if (path == "tune.records") path = "axis.records";
    const bool is_section = !keys_of(path).empty();
    if (is_section && entry.value.as<TomlTable>()) {
      visit_table(entry.value, path, visit);
    } else if (is_section && entry.value.as<TomlArray>()) {
      for (TomlValue& each : std::get<TomlArray>(entry.value.content))
        if (each.as<TomlTable>()) visit_table(each, path, visit);
    } else {
      visit_inner(entry.value, visit);
    }
  }
}

std::set<std::string> replaced_parameters(TomlValue document) {
  std::set<std::string> names;
  visit_table(document, "", [&](const StudyKey& key, TomlEntry& entry) {
    const std::string path = path_of(key);
    const auto* name = entry.value.as<std::string>();
    if (name && (path == "axis.parameter" || path == "axis.of.parameter" || path == "tune.band.parameter"))
      names.insert(*name);
    if (path == "axis.fixed_from" || path == "identify.fixed_from") names.insert("k");  // write_estimates()
  });
  return names;
}

TomlValue as_value(std::string text) {
  return {.position = {}, .content = std::move(text)};
}
TomlValue as_value(std::int64_t number) {
  return {.position = {}, .content = number};
}

// All names in a document: of masses, elements, parameters, and all else that names something.
void add_names(const TomlValue& value, std::set<std::string>& names) {
  if (const auto* text = value.as<std::string>()) {
    if (!text->empty() &&
        std::ranges::all_of(*text, [](unsigned char c) { return std::isalnum(c) || c == '_'; }))
      names.insert(*text);
  } else if (const auto* list = value.as<TomlArray>()) {
    for (const TomlValue& each : *list) add_names(each, names);
  } else if (const auto* table = value.as<TomlTable>()) {
    for (const TomlEntry& each : *table) {
      names.insert(each.key);
      add_names(each.value, names);
    }
  }
}

using Values = std::vector<TomlValue>;

// Other numbers, near and far.
Values other_numbers(const TomlValue& value) {
  if (const auto* whole = value.as<std::int64_t>()) {
    Values values{as_value(*whole + 1), as_value(*whole - 1), as_value(2 * *whole), as_value(*whole / 2),
                  as_value(std::int64_t{1})};
    for (const double by : {1.0625, 0.9375}) values.push_back(toml_number(static_cast<double>(*whole) * by));
    if (*whole == 0) values.push_back(toml_number(0.01));
    return values;
  }
  const double number = *value.as<double>();
  return {toml_number(number * 1.0625), toml_number(number * 0.9375), toml_number(number * 2.0)};
}

bool is_name(KeyForm form) {
  return form == KeyForm::name || form == KeyForm::names || form == KeyForm::patterns;
}

Values other_texts(const StudyKey& key, const std::string& text, const std::set<std::string>& names) {
  const bool is_unit =
      std::string_view(key.key) == "unit" || (key.form == KeyForm::settings && key.inside == KeyForm::text);
  Values values{as_value("1.0625*(" + text + ")")};
  if (is_unit) return values;
  if (is_name(key.form) || (key.has_other && is_name(key.other)))
    for (const std::string& name : names)
      if (name != text) values.push_back(as_value(name));
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {"_peak", "_rms"}, {"_rms", "_peak"}, {"_peak", "_velocity_peak"}, {"_stroke", "_force_peak"}}) {
    const auto at = text.find(from);
    if (at != std::string::npos) values.push_back(as_value(std::string(text).replace(at, from.size(), to)));
  }
  values.push_back(as_value(text + "q"));
  return values;
}

// Other values of a key, of which some make a study.
Values others(const StudyKey& key, const TomlValue& value, const std::set<std::string>& names,
              const std::set<std::string>& replaced = {}) {
  if (const auto* flag = value.as<bool>()) return {{.position = {}, .content = !*flag}};
  if (is_number(value)) return other_numbers(value);
  if (const auto* text = value.as<std::string>()) {
    Values values;
    for (const std::string& word : words_of(key))
      if (word != *text) values.push_back(as_value(word));
    for (TomlValue& each : other_texts(key, *text, names)) values.push_back(std::move(each));
    return values;
  }
  Values values;
  if (const auto* list = value.as<TomlArray>()) {
    for (std::size_t i = 0; i < list->size(); ++i)
      for (TomlValue& each : others(key, (*list)[i], names)) {
        TomlArray changed = *list;
        changed[i] = std::move(each);
        values.push_back({.position = {}, .content = std::move(changed)});
      }
    if (list->size() > 1)
      values.push_back({.position = {}, .content = TomlArray(list->begin(), list->end() - 1)});
  } else if (const auto* table = value.as<TomlTable>()) {
    for (std::size_t i = 0; i < table->size(); ++i) {
      if (path_of(key) == "parameters" && replaced.contains((*table)[i].key)) continue;
      for (TomlValue& each : others(key, (*table)[i].value, names)) {
        TomlTable changed = *table;
        changed[i].value = std::move(each);
        values.push_back({.position = {}, .content = std::move(changed)});
      }
      if (path_of(key) == "parameters" || key.inside == KeyForm::text) continue;
      for (const std::string& name : names) {
        TomlTable changed = *table;
        changed[i].key = name;
        values.push_back({.position = {}, .content = std::move(changed)});
      }
    }
  }
  return values;
}

// A new name, in place of the old one wherever that stands, also in names of quantities.
void rename(TomlValue& value, const std::string& from, const std::string& to) {
  const auto renamed = [&](std::string& text) {
    if (text == from || text.starts_with(from + "_")) text.replace(0, from.size(), to);
  };
  if (auto* text = std::get_if<std::string>(&value.content)) renamed(*text);
  if (auto* list = std::get_if<TomlArray>(&value.content))
    for (TomlValue& each : *list) rename(each, from, to);
  if (auto* table = std::get_if<TomlTable>(&value.content))
    for (TomlEntry& each : *table) {
      if (row_of("", each.key) || each.key == from) renamed(each.key);
      rename(each.value, from, to);
    }
}

bool is_section(const StudyKey& key) {
  return key.form == KeyForm::table || key.form == KeyForm::tables;
}

// Keys that name files: the fingerprint is of what is in these.
bool is_file(KeyForm form) {
  return form == KeyForm::file || form == KeyForm::files;
}
bool names_file(const StudyKey& key, const TomlValue& value) {
  if (value.as<std::string>()) return is_file(key.form) || (key.has_other && is_file(key.other));
  return is_file(key.form) && value.as<TomlArray>();
}

std::optional<double> number_in(const TomlValue& value) {
  if (const auto* whole = value.as<std::int64_t>()) return static_cast<double>(*whole);
  const auto* number = value.as<double>();
  return number ? std::optional(*number) : std::nullopt;
}

// 0 and 0.0, inf and twice that, also in lists and tables.
bool is_same(const TomlValue& a, const TomlValue& b) {
  if (const auto number = number_in(a)) return number == number_in(b);
  if (a.content.index() != b.content.index()) return false;
  if (const auto* list = a.as<TomlArray>()) return std::ranges::equal(*list, *b.as<TomlArray>(), is_same);
  if (const auto* table = a.as<TomlTable>())
    return std::ranges::equal(*table, *b.as<TomlTable>(), [](const TomlEntry& one, const TomlEntry& other) {
      return one.key == other.key && is_same(one.value, other.value);
    });
  return toml_in_line(a) == toml_in_line(b);
}

// The lines of a text that another has not.
std::string lines_beside(const std::string& text, const std::string& other) {
  std::istringstream stream(text);
  std::string lines;
  for (std::string line; std::getline(stream, line);)
    if (("\n" + other).find("\n" + line + "\n") == std::string::npos) lines += "\n  " + line;
  return lines;
}

// How often a mutant was made of each key.
struct Tally {
  std::map<std::string, int> mutants;
  std::vector<std::string> wrong;
};

// The mutants of one place of a document: of the number-th key visited.
void mutate(const Kept& kept, std::size_t number, const std::set<std::string>& names, Tally& tally) {
  constexpr int enough = 3, most_tried = 80;  // of one place
  const auto with = [&](const std::function<void(TomlValue & document, TomlEntry & entry)>& change) {
    TomlValue document = kept.document;
    std::size_t at = 0;
    visit_table(
        document, "",
        [&](const StudyKey&, TomlEntry& entry) {
          if (at++ == number) change(document, entry);
        },
        kept.replaced);
    return document;
  };
  const StudyKey* key = nullptr;
  TomlValue value;
  with([&](TomlValue&, TomlEntry& entry) { value = entry.value; });
  std::size_t at = 0;
  TomlValue copy = kept.document;
  visit_table(
      copy, "",
      [&](const StudyKey& row, TomlEntry&) {
        if (at++ == number) key = &row;
      },
      kept.replaced);
  REQUIRE(key);
  if (is_section(*key)) return;
  std::vector<TomlValue> mutants;
  for (const TomlValue& other : others(*key, value, names, kept.replaced))
    if (!is_same(other, value))
      mutants.push_back(with([&](TomlValue&, TomlEntry& entry) { entry.value = other; }));
  if (std::string_view(key->key) == "name" && value.as<std::string>()) {
    TomlValue renamed = kept.document;
    rename(renamed, *value.as<std::string>(), "renamed");
    mutants.insert(mutants.begin(), std::move(renamed));
  }
  int made = 0, tried = 0;
  for (const TomlValue& mutant : mutants) {
    if (made == enough || tried++ == most_tried) return;
    const auto fingerprint = fingerprint_of(toml_text(mutant), kept.file);
    if (!fingerprint) continue;
    ++made;
    ++tally.mutants[path_of(*key)];
    const bool stays = excused.contains(path_of(*key));
    if ((*fingerprint == kept.fingerprint) != stays)
      tally.wrong.push_back(fmt::format("{}: {} {}{}", kept.file.filename().string(), path_of(*key),
                                        stays ? "changes the fingerprint" : "is forgotten",
                                        lines_beside(toml_text(mutant), toml_text(kept.document))));
  }
}

std::set<std::string> keys_that_count() {
  std::set<std::string> keys;
  for (const StudyKey& key : study_keys())
    if (!is_section(key) && !excused.contains(path_of(key)) && !is_file(key.form)) keys.insert(path_of(key));
  return keys;
}

std::string replaced(std::string text, const std::string& passage, const std::string& by) {
  const auto at = text.find(passage);
  INFO(passage);
  REQUIRE(at != std::string::npos);
  return text.replace(at, passage.size(), by);
}

const Kept& study_named(const std::vector<Kept>& studies, const std::string& name) {
  const auto found =
      std::ranges::find_if(studies, [&](const Kept& each) { return each.file.filename() == name; });
  REQUIRE(found != studies.end());
  return *found;
}

TEST_CASE("every key of a study changes its fingerprint, or is excused") {
  const TemporaryFolder folder;
  const std::vector<Kept> studies = read_studies(folder);
  Tally tally;
  for (const Kept& kept : studies) {
    std::set<std::string> names;
    add_names(kept.document, names);
    std::size_t places = 0;
    TomlValue document = kept.document;
    visit_table(
        document, "", [&](const StudyKey&, TomlEntry&) { ++places; }, kept.replaced);
    for (std::size_t number = 0; number < places; ++number) mutate(kept, number, names, tally);
  }
  for (const HandMade& mutant : hand_made) {
    const Kept& kept = study_named(studies, mutant.study);
    std::string text = text_of(kept.file);
    for (const auto& [passage, by] : mutant.passages) text = replaced(std::move(text), passage, by);
    INFO(mutant.key << " in " << mutant.study);
    CHECK(fingerprint_of(parse_study(text, kept.file)) != kept.fingerprint);
    ++tally.mutants[mutant.key];
  }
  for (const std::string& wrong : tally.wrong) FAIL_CHECK(wrong);
  int mutants = 0;
  for (const auto& [key, count] : tally.mutants) mutants += count;
  const std::set<std::string> keys = keys_that_count();
  for (const std::string& key : keys) {
    INFO(key << " has no mutant: a study that uses it, or a mutant made by hand, is missing");
    CHECK(tally.mutants.contains(key));
  }
  UNSCOPED_INFO(fmt::format("{} keys that count, {} mutants", keys.size(), mutants));
  CHECK(mutants > 500);
}

TEST_CASE("the keys that are excused are those of words alone, each with its reason") {
  std::set<std::string> words;
  for (const StudyKey& key : study_keys()) {
    const bool counts_nowhere = key.use == Use::nowhere && !is_section(key);
    if (key.use == Use::label || counts_nowhere) words.insert(path_of(key));
  }
  std::set<std::string> listed;
  for (const auto& [key, reason] : excused) {
    listed.insert(key);
    CHECK(reason.size() > 20);
  }
  CHECK(listed == words);
}

TEST_CASE("another form of an expression changes no fingerprint") {
  const TemporaryFolder folder;
  int forms = 0;
  for (const Kept& kept : read_studies(folder)) {
    TomlValue document = kept.document;
    visit_table(document, "", [&](const StudyKey& key, TomlEntry& entry) {
      const bool is_expression = key.form == KeyForm::value || path_of(key) == "column.value" ||
                                 path_of(key) == "coordinate.value" || path_of(key) == "design.rule";
      if (auto* text = std::get_if<std::string>(&entry.value.content); is_expression && text) {
        *text = " ( " + *text + " ) ";
        ++forms;
      }
    });
    INFO(kept.file.string());
    const auto fingerprint = fingerprint_of(toml_text(document), kept.file);
    REQUIRE(fingerprint);
    CHECK(*fingerprint == kept.fingerprint);
  }
  CHECK(forms > 20);
}

// A file with one of its numbers changed, its name and form kept.
void change_number(const std::filesystem::path& file) {
  if (file.extension() == ".h5") return write_estimates(file, 40.5, 12.0);
  std::string text = text_of(file);
  std::size_t line = 0;  // from the middle one, within every window of its record
  for (auto left = std::ranges::count(text, '\n') / 2; left > 0; --left) line = text.find('\n', line) + 1;
  const auto last = text.find_last_of("0123456789", text.find('\n', line));
  REQUIRE(last != std::string::npos);
  text[last] = text[last] == '9' ? '8' : static_cast<char>(text[last] + 1);
  std::ofstream(file, std::ios::binary) << text;
}

TEST_CASE("another number in any file that a study reads changes its fingerprint, another place does not") {
  const TemporaryFolder folder;
  std::map<std::string, int> files;
  for (const Kept& kept : read_studies(folder)) {
    std::vector<std::pair<std::string, std::filesystem::path>> read;
    TomlValue document = kept.document;
    const auto moved = [&](const StudyKey& key, TomlValue& value) {
      auto& name = std::get<std::string>(value.content);
      const auto copy = folder / fmt::format("{}", read.size());
      std::filesystem::create_directories(copy);
      const auto to = copy / std::filesystem::path(name).filename();
      std::filesystem::copy_file(kept.file.parent_path() / name, to,
                                 std::filesystem::copy_options::overwrite_existing);
      name = to.string();
      read.emplace_back(path_of(key), to);
    };
    visit_table(document, "", [&](const StudyKey& key, TomlEntry& entry) {
      if (!names_file(key, entry.value)) return;
      if (entry.value.as<std::string>()) return moved(key, entry.value);
      for (TomlValue& each : std::get<TomlArray>(entry.value.content)) moved(key, each);
    });
    for (const auto& [key, file] : read) {
      INFO(kept.file.string() << ": " << key << " = " << file.string());
      const auto before = fingerprint_of(toml_text(document), kept.file);
      REQUIRE(before);
      if (key != "axis.records") CHECK(*before == kept.fingerprint);  // its names are in the file of the map
      const std::string content = text_of(file);
      change_number(file);
      const auto after = fingerprint_of(toml_text(document), kept.file);
      REQUIRE(after);
      CHECK(*after != *before);
      std::ofstream(file, std::ios::binary) << content;
      ++files[key];
    }
  }
  for (const StudyKey& key : study_keys()) {
    if (!is_file(key.form) && !(key.has_other && is_file(key.other))) continue;
    INFO(path_of(key) << " has no study here");
    CHECK(files.contains(path_of(key)));
  }
}

TEST_CASE("the degrees of freedom behind an estimate that is taken over change the fingerprint") {
  const TemporaryFolder folder;
  const Kept kept = study_named(read_studies(folder), "identify_estimates.toml");
  write_estimates(folder / "mutants/estimates.h5", 40.0, 11.0);
  CHECK(*fingerprint_of(text_of(kept.file), kept.file) != kept.fingerprint);
}

}  // namespace
}  // namespace mutants_test
