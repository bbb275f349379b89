// The table of keys by itself, and beside the table of elements.
#include "studies/reading/keys/study_keys.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "studies/reading/keys/element_keys.hpp"
#include "studies/reading/keys/key_groups.hpp"

namespace study_keys_test {
namespace {

using namespace frahm::studies;

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::ranges::find(words, word) != words.end();
}

// The key that decides the form of a section: its own, or one of a section above.
const StudyKey* decider_called(const std::string& section, const std::string& name) {
  const std::string above = section.substr(0, section.find('.'));
  for (const StudyKey& each : study_keys()) {
    const std::string in = each.section;
    if (each.key == name && (in == section || in == above || in == "study")) return &each;
  }
  return nullptr;
}

const StudyKey* decider_of(const StudyKey& key) {
  return decider_called(key.section, key.owners.decider);
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

TEST_CASE(
    "what decides over a needed key or a group is a word of its decider, and the keys of a group exist") {
  const auto check = [](const std::string& section, const KeyOwners& of) {
    if (*of.decider == '\0') return;
    const StudyKey* decider = decider_called(section, of.decider);
    REQUIRE(decider != nullptr);
    for (const std::string& word : separated(of.of)) CHECK(contains(words_of(*decider), word));
  };
  for (const StudyKey& key : study_keys()) {
    INFO(path_of(key));
    check(key.section, key.need.of);
  }
  for (const KeyGroup& group : key_groups()) {
    INFO(group.section << ": " << group.keys);
    CHECK(separated(group.keys).size() >= 2);
    for (const std::string& key : separated(group.keys)) CHECK(contains(keys_of(group.section), key));
    check(group.section, group.of);
  }
}

TEST_CASE("limits hold the numbers that they tell") {
  const Limits& samples = study_key("decay", "samples").limits;
  CHECK(samples.text("a whole number ") == "a whole number from 2 to 10000000, or 0");
  for (const double in : {0.0, 2.0, 1e7}) CHECK(samples.hold(in));
  for (const double out : {-1.0, 1.0, 1e7 + 1.0}) CHECK(!samples.hold(out));
  CHECK(study_key("tune", "quantile").limits.text() == "above 0 and below 1");
  CHECK(!study_key("tune", "quantile").limits.hold(1.0));
  CHECK(study_key("element", "chi").limits.text() == "above -1 and at most 100");
  CHECK(positive.text() == "> 0");
  CHECK(!positive.hold(0.0));
  CHECK(not_negative.hold(0.0));
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
}  // namespace study_keys_test
