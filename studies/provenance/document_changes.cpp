#include "studies/provenance/document_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "studies/provenance/document_facts.hpp"

namespace frahm::studies {
namespace {

constexpr double rounding_of_units = 1e-14;  // relative: of a value times the factor of its unit
constexpr std::size_t longest_list = 60;     // bytes of a list that is reported whole

bool is_same(const Item& a, const Item& b) {
  if (a.text == b.text) return true;
  if (!a.si || !b.si) return false;
  const double rounding = a.has_unit || b.has_unit ? rounding_of_units * std::abs(*a.si) : 0.0;
  return std::abs(*a.si - *b.si) <= rounding;
}

bool is_same(const Fact& a, const Fact& b) {
  return a.is_list == b.is_list &&
         std::ranges::equal(a.items, b.items,
                            [](const Item& one, const Item& other) { return is_same(one, other); });
}

std::string text_of(const Fact& fact) {
  if (!fact.is_list) return fact.items.front().text;
  std::string text;
  for (const Item& item : fact.items) text += (text.empty() ? "" : ", ") + item.text;
  return text.size() <= longest_list ? "[" + text + "]" : fmt::format("{} values", fact.items.size());
}

std::string change_of(const Fact& before, const Fact& after) {
  const std::string first = text_of(before), second = text_of(after);
  if (first != second) return fmt::format("{}: {}, now {}", before.name, first, second);
  // Two long lists of as many values: the first that differs.
  std::size_t at = 0, different = 0;
  for (std::size_t i = before.items.size(); i-- > 0;) {
    if (is_same(before.items[i], after.items[i])) continue;
    at = i;
    ++different;
  }
  return fmt::format("{}: value {} of {}: {}, now {}{}", before.name, at + 1, before.items.size(),
                     before.items[at].text, after.items[at].text,
                     different > 1 ? fmt::format(", and {} more", different - 1) : "");
}

// The outermost table of a fact that another study has not; "" where it has them all.
std::string missing_table(const Fact& fact, const Facts& other) {
  const auto table = std::ranges::find_if(
      fact.tables, [&](const std::string& each) { return !other.tables.contains(each); });
  return table == fact.tables.end() ? "" : *table;
}

// What both have, in the order of the first.
std::vector<std::string> common_members(const Sequence& of, const Sequence& with) {
  std::vector<std::string> common;
  std::ranges::copy_if(of.members, std::back_inserter(common), [&](const std::string& each) {
    return std::ranges::find(with.members, each) != with.members.end();
  });
  return common;
}

// "" where what both have is in the same order.
std::string change_of_order(const Sequence& before, const Sequence& after) {
  const auto was = common_members(before, after), is = common_members(after, before);
  const auto [first, now] = std::ranges::mismatch(was, is);
  return first == was.end() ? ""
                            : fmt::format("the order of {}: {} is now before {}", before.name, *now, *first);
}

// is_same: of two facts of one name.
template <class IsSame>
std::vector<std::string> changes_of_facts(const Facts& before, const Facts& after, const IsSame& same) {
  std::vector<std::string> changes;
  const auto tell = [&](const std::string& line) {  // a table that is new or gone is reported once
    if (std::ranges::find(changes, line) == changes.end()) changes.push_back(line);
  };
  for (const Fact& fact : before.list) {
    const Fact* found = after.find(fact.name);
    if (found && same(fact, *found)) continue;
    const std::string table = found ? "" : missing_table(fact, after);
    if (found)
      tell(change_of(fact, *found));
    else
      tell(table.empty() ? fmt::format("{}: {}, now gone", fact.name, text_of(fact)) : table + ": gone");
  }
  for (const Fact& fact : after.list) {
    if (before.find(fact.name)) continue;
    const std::string table = missing_table(fact, before);
    tell(table.empty() ? fmt::format("{}: new, {}", fact.name, text_of(fact)) : table + ": new");
  }
  for (const Sequence& sequence : before.sequences) {
    const auto found = std::ranges::find(after.sequences, sequence.name, &Sequence::name);
    const std::string change = found == after.sequences.end() ? "" : change_of_order(sequence, *found);
    if (!change.empty()) tell(change);
  }
  return changes;
}

}  // namespace

std::vector<std::string> document_changes(const TomlValue& kept, const TomlValue& now) {
  return changes_of_facts(facts_of(kept), facts_of(now),
                          [](const Fact& a, const Fact& b) { return is_same(a, b); });
}

std::vector<std::string> word_changes(const TomlValue& kept, const TomlValue& now) {
  const auto is_written_the_same = [](const Fact& a, const Fact& b) {
    return a.is_list == b.is_list && std::ranges::equal(a.items, b.items, {}, &Item::text, &Item::text);
  };
  return changes_of_facts(facts_of(kept, Labels::read), facts_of(now, Labels::read), is_written_the_same);
}

std::vector<std::string> rounding_changes(const TomlValue& kept, const TomlValue& now) {
  const Facts before = facts_of(kept), after = facts_of(now);
  std::vector<std::string> changes;
  for (const Fact& fact : before.list) {
    const Fact* found = after.find(fact.name);
    if (!found || !is_same(fact, *found)) continue;
    const auto is_exact = [](const Item& one, const Item& other) { return one.si == other.si; };
    if (!std::ranges::equal(fact.items, found->items, is_exact))
      changes.push_back(change_of_unit(fact.name, text_of(fact), text_of(*found)));
  }
  return changes;
}

std::string change_of_unit(const std::string& name, const std::string& before, const std::string& after) {
  return fmt::format("{}: {}, now {}: the same apart from rounding", name, before, after);
}

}  // namespace frahm::studies
