#pragma once

#include <span>

#include "studies/reading/keys/study_keys.hpp"

namespace frahm::studies {

// Keys of a section that go together, in some form of it or in all.
enum class Together {
  one,
  at_most_one,
  at_least_one,
  all_or_none,
  not_without,  // the first needs the second
};
struct KeyGroup {
  const char* section = "";
  const char* keys = "";  // "a|b"
  Together rule = Together::at_most_one;
  KeyOwners of = {};
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
