#include "studies/reading/system/friction_law_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "solvers/mechanics/element_table.hpp"
#include "studies/reading/keys/study_keys.hpp"
#include "studies/reading/keys/study_words.hpp"
#include "studies/reading/system/network_reading.hpp"

// The law of a coulomb element, and laws that do not go together.
namespace frahm::studies {
namespace {

using mechanics::ElementKind;
using mechanics::ForceLaw;

static_assert(std::size(words::friction_laws) == static_cast<std::size_t>(ForceLaw::cubic),
              "a word for each law");

const char* name_of(ForceLaw law) {
  return study_key("element", "law").words[static_cast<std::size_t>(law)].word;
}

// A key that one law alone has.
void keep_key_to(const TomlSection& section, const char* key, ForceLaw owner, ForceLaw law) {
  if (law != owner && section.find(key))
    section.fail(rules::key_without_use, key, "only the law \"{}\" has a {}", name_of(owner), key);
}

// That of a number which one law alone has.
ForceLaw law_of_numbers(const TomlSection& section, const ElementKind& kind) {
  for (const mechanics::ValueKey* value : kind.values())
    if (value->law && section.find(value->key)) return *value->law;
  return ForceLaw::exact;
}

}  // namespace

ForceLaw read_law(const TomlSection& section, const ElementKind& kind) {
  if (!kind.can_be_smoothed()) return law_of_numbers(section, kind);
  const auto law = section.choice_as<ForceLaw>("law");
  for (const mechanics::ValueKey* value : kind.values()) {
    if (value->law) keep_key_to(section, value->key, *value->law, law);
  }
  keep_key_to(section, "table", ForceLaw::stribeck, law);
  if (law == ForceLaw::stribeck && section.find(kind.value.key))
    section.fail(rules::one_of_two_keys, kind.value.key,
                 "its table already gives the friction; give only one of the two");
  return law;
}

void check_one_law(const NetworkReading& reading, const TomlSection& section, const ElementKind& kind,
                   ForceLaw law) {
  const auto& elements = reading.result.network.elements;
  const bool is_exact = law == ForceLaw::exact;
  const auto other = std::find_if(elements.begin(), elements.end(), [&](const auto& element) {
    return mechanics::has_contact(element) && (element.law == ForceLaw::exact) != is_exact;
  });
  if (other == elements.end()) return;
  const ElementKind& other_kind = mechanics::kind_of(*other);
  const ForceLaw smooth = is_exact ? other->law : law;
  if (!kind.can_be_smoothed() || !other_kind.can_be_smoothed()) {
    const bool own = !kind.can_be_smoothed();
    section.fail_here(rules::wrong_law, "a {} has no {} law, which {} follows",
                      own ? kind.name : other_kind.name, name_of(smooth),
                      own ? fmt::format("element \"{}\"", other->name) : "this element");
  }
  const std::string message = fmt::format(
      "\"{}\"{}, but element \"{}\" follows \"{}\"; all coulomb elements of a study must follow the exact "
      "law, or all a smooth one",
      name_of(law), section.find("law") ? "" : " by default", other->name, name_of(other->law));
  section.find("law") ? section.fail(rules::wrong_law, "law", "{}", message)
                      : section.fail_here(rules::wrong_law, "{}", message);
}

}  // namespace frahm::studies
