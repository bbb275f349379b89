#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "studies/reading/keys/study_keys.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {

// A single value; `si` where it is a number, of a unit where it has one.
struct Item {
  std::string text;
  std::optional<double> si;
  bool has_unit = false;
};

// What a study says under one name.
struct Fact {
  std::string name;                 // `mass "main": mass`
  std::vector<std::string> tables;  // those it is in, the outermost first
  const StudyKey* key = nullptr;    // its row of the table of keys; none of a parameter
  TomlValue value{};
  std::string unit{};       // the unit that its table has for its numbers; "" for none
  std::string parameter{};  // the parameter that its table, one around it or itself is about; "" for none
  bool is_list = false;
  std::vector<Item> items{};  // one unless it is a list
};

// The names in a list of tables or of settings, in their order.
struct Sequence {
  std::string name;               // "[[element]]"
  const StudyKey* key = nullptr;  // that of the list
  std::vector<std::string> members{};
};

// All that a study says, in the order of its file.
struct Facts {
  std::vector<Fact> list;
  std::set<std::string> tables;
  std::vector<Sequence> sequences;

  const Fact* find(const std::string& name) const;
};

enum class Labels { left_out, read };  // what no number depends on (Use::label), such as titles

// document: a TomlTable, its repetitions written out.
Facts facts_of(const TomlValue& document, Labels labels = Labels::left_out);

// The study's text as a document, its repetitions written out, with the numbers that its parameters have in
// this run. Those on an axis are left out: their values are that of the axis.
TomlValue document_of(const Study& study);

}  // namespace frahm::studies
