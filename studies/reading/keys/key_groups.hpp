#pragma once

#include <optional>
#include <span>

#include "studies/reading/keys/study_keys.hpp"
#include "studies/reading/text/rules.hpp"

namespace frahm::studies {

// Keys of a section that go together, in some form of it or in all.
enum class Together {
  one,
  at_most_one,
  at_least_one,
  all_or_none,
  not_without,  // the first needs the second
};

// What a message says where a group is broken, in place of the general sentence and its rule.
struct Sentence {
  const char* text = "";  // {}: the key that is already given, or the one that is missing
  std::optional<Rule> rule = std::nullopt;
};
struct TooMany : Sentence {};
struct Missing : Sentence {};

// TomlSection checks every group; `frahm schema` states them.
struct KeyGroup {
  // more: the forms of the section in which it holds, its own sentences, in any order.
  template <class... More>
  constexpr KeyGroup(const char* in, const char* which, Together how, const More&... more)
      : section(in), keys(which), rule(how) {
    (take(more), ...);
  }

  const char* section;
  const char* keys;  // "a|b"
  Together rule;
  KeyOwners of = {};
  TooMany too_many = {};
  Missing missing = {};

 private:
  constexpr void take(const KeyOwners& forms) { of = forms; }
  constexpr void take(const TooMany& sentence) { too_many = sentence; }
  constexpr void take(const Missing& sentence) { missing = sentence; }
};
std::span<const KeyGroup> key_groups();

// A form of a section that keys tell: the first in the table whose mark is there.
struct SectionForm {
  const char* section = "";
  const char* form = "";
  const char* marks =
      "";  // "a|b": any of these keys; "excitation.record" of another section; "": no other form
  bool is_text = false;  // a mark that is a text
};
std::span<const SectionForm> section_forms();

}  // namespace frahm::studies
