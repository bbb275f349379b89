// The table of keys by itself, and beside the table of elements.
#include "studies/reading/study_keys.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "studies/reading/element_keys.hpp"

namespace {

using namespace frahm::studies;

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::ranges::find(words, word) != words.end();
}

std::string path_of(const StudyKey& key) {
  return *key.section ? std::string(key.section) + "." + key.key : key.key;
}

// The key that decides the form of a section: its own, or one of a section above.
const StudyKey* decider_of(const StudyKey& key) {
  const std::string section = key.section, above = section.substr(0, section.find('.'));
  for (const StudyKey& each : study_keys()) {
    const std::string in = each.section;
    if (each.key == std::string(key.owners.decider) && (in == section || in == above || in == "study"))
      return &each;
  }
  return nullptr;
}

}  // namespace

TEST_CASE("every section of the table of keys is a key of another and has each of its keys once") {
  std::vector<std::string> paths;
  for (const StudyKey& key : study_keys()) {
    INFO(path_of(key));
    CHECK(!contains(paths, path_of(key)));
    paths.push_back(path_of(key));
  }
  for (const StudyKey& key : study_keys()) {
    INFO(path_of(key));
    const std::string section = key.section;
    CHECK((section.empty() || section.starts_with('{') || contains(paths, section)));
  }
}

TEST_CASE("a choice has words and what decides over a key is a word of its decider") {
  for (const StudyKey& key : study_keys()) {
    INFO(path_of(key));
    const bool is_choice = key.form == KeyForm::choice || key.form == KeyForm::element_type;
    CHECK((!is_choice || !words_of(key).empty()));
    if (*key.owners.decider == '\0') continue;
    const StudyKey* decider = decider_of(key);
    REQUIRE(decider != nullptr);
    for (const std::string& form : separated(key.owners.of)) CHECK(contains(words_of(*decider), form));
  }
}

TEST_CASE("the keys of an element are those of its types") {
  std::vector<std::string> of_types;
  for (const std::string& type : element_types()) {
    for (const std::string& key : keys_of_type(type)) {
      INFO(type << ": " << key);
      CHECK(contains(keys_of("element"), key));
      of_types.push_back(key);
    }
  }
  for (const std::string& key : keys_of("element")) {
    INFO(key);
    CHECK((is_of_every_type(key) || contains(of_types, key)));
  }
}

TEST_CASE("a form of a section has its own keys and those of all forms") {
  const std::vector<std::string> white = keys_of("axis.records", "white");
  CHECK(contains(white, "intensity"));
  CHECK(!contains(white, "ground_damping"));
  CHECK(contains(keys_of("axis.records", "kanai_tajimi"), "ground_damping"));
  CHECK(words_of(study_key("tune", "objective"), "records") ==
        std::vector<std::string>{"worst_peak", "mean_peak"});
}
