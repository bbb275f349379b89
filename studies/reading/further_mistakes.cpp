#include "studies/reading/further_mistakes.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace frahm::studies {
namespace {

// What was left out of a document, and where.
struct LeftOut {
  std::vector<Position> from;      // where the tables begin that had it
  std::vector<std::string> words;  // its keys and texts, which others may refer to
  bool has_names = false;          // of masses, elements, supports: what refers to them may be right

  void add(const TomlValue& value) {
    if (const auto* text = value.as<std::string>()) words.push_back(*text);
    if (const auto* list = value.as<TomlArray>())
      for (const TomlValue& each : *list) add(each);
    if (const auto* table = value.as<TomlTable>())
      for (const TomlEntry& each : *table) add(each);
  }
  void add(const TomlEntry& entry) {
    words.push_back(entry.key);
    has_names = has_names || entry.key == "name" || entry.key == "names" || entry.key == "node";
    add(entry.value);
  }
};

// { value = 3, unit = "m" }
bool is_one_number(const TomlValue& value) {
  const auto* table = value.as<TomlTable>();
  return table && std::ranges::all_of(*table, [](const TomlEntry& each) {
           return each.key == "value" || each.key == "unit";
         });
}

// The header of a table stands before its key: [damping].
Position start_of(const TomlEntry& entry) {
  return std::min(entry.position, entry.value.position);
}

// What can be left out by itself: an entry of a table, or a table of a list.
struct Part {
  Position start;
  Position table;         // the one that has it
  bool is_table = false;  // itself
};

template <class Visit>
void visit_parts(const TomlValue& value, Position table, const Visit& visit) {
  if (is_one_number(value)) return;
  if (const auto* entries = value.as<TomlTable>())
    for (const TomlEntry& each : *entries)
      visit(Part{start_of(each), value.position, each.value.as<TomlTable>() != nullptr}),
          visit_parts(each.value, value.position, visit);
  if (const auto* list = value.as<TomlArray>())
    for (const TomlValue& each : *list)
      if (each.as<TomlTable>() && !is_one_number(each))
        visit(Part{each.position, table, true}), visit_parts(each, table, visit);
}

// The part in which a place of the text lies.
Part part_at(const TomlValue& root, Position place) {
  Part last;
  visit_parts(root, root.position, [&](const Part& each) {
    if (each.start <= place && each.start > last.start) last = each;
  });
  return last;
}

bool is_empty_list(const TomlValue& value) {
  const auto* list = value.as<TomlArray>();
  return list && list->empty();
}

// Takes a part out, the innermost that begins there, with its copies of a `repeat`; a list that it empties
// goes with it. False: it is not below.
bool leave_out(TomlValue& value, const Part& part, LeftOut& left_out) {
  if (is_one_number(value)) return false;
  bool found = false;
  const auto take_out = [&](auto& parts, const auto& is_it) {
    for (const auto& each : parts)
      if (is_it(each)) left_out.add(each);
    found = std::erase_if(parts, is_it) > 0;
  };
  if (auto* table = std::get_if<TomlTable>(&value.content)) {
    for (TomlEntry& each : *table) found = leave_out(each.value, part, left_out) || found;
    if (found)
      std::erase_if(*table, [](const TomlEntry& each) { return is_empty_list(each.value); });
    else
      take_out(*table, [&](const TomlEntry& each) { return start_of(each) == part.start; });
  } else if (auto* list = std::get_if<TomlArray>(&value.content)) {
    for (TomlValue& each : *list) found = leave_out(each, part, left_out) || found;
    if (!found)
      take_out(*list,
               [&](const TomlValue& each) { return each.as<TomlTable>() && each.position == part.start; });
  }
  return found;
}

// Whether a mistake may only follow from what was left out before the study was read again.
bool follows(const StudyError& error, const TomlValue& root, const LeftOut& left_out) {
  const auto has_lost = [&](Position table) {
    return std::ranges::find(left_out.from, table) != left_out.from.end();
  };
  if (error.rule().by == Rule::By::study || has_lost(error.position())) return true;
  if (error.rule().by == Rule::By::itself) return false;
  if (error.rule() == rules::unknown_name && left_out.has_names) return true;
  // A mistake at the start of a table is one of that table.
  const Part part = part_at(root, error.position());
  const bool is_of_part = part.is_table && part.start == error.position();
  if (!is_of_part && has_lost(part.table)) return true;
  if (error.rule() == rules::missing_key) return false;  // whose name is the program's, not the study's
  std::string_view message = error.what();
  message = message.substr(0, message.find('\n'));  // without the excerpt
  return std::ranges::any_of(left_out.words, [&](const std::string& word) {
    return message.find("\"" + word + "\"") != std::string_view::npos;
  });
}

// Where they stand in their lists, whatever is left out before them.
void number_tables(TomlValue& value) {
  if (auto* table = std::get_if<TomlTable>(&value.content))
    for (TomlEntry& each : *table) number_tables(each.value);
  if (auto* list = std::get_if<TomlArray>(&value.content)) {
    for (std::size_t i = 0; i < list->size(); ++i) {
      (*list)[i].number = i + 1;
      number_tables((*list)[i]);
    }
  }
}

}  // namespace

StudyError with_further_mistakes(const StudyError& first, TomlValue root, const ReadDocument& read) {
  constexpr std::size_t most_mistakes = 20;
  constexpr int most_readings = 100;
  std::vector<StudyError> mistakes{first};
  number_tables(root);
  LeftOut left_out;
  StudyError last = first;
  for (int i = 0; i < most_readings && mistakes.size() < most_mistakes; ++i) {
    Part part = part_at(root, last.position());
    // Which of several keys is right is not known: the whole table goes.
    if (last.rule() == rules::one_of_two_keys && part.start < last.position())
      part = part_at(root, part.table);
    left_out.from.push_back(part.table);
    if (!leave_out(root, part, left_out)) break;
    try {
      read(root);
      break;
    } catch (const StudyError& next) {
      last = next;
    }
    // The same again, where what is left of a table is wrong for the same reason.
    const auto is_last = [&last](const StudyError& each) {
      return std::string_view(each.what()) == last.what();
    };
    if (!follows(last, root, left_out) && std::ranges::none_of(mistakes, is_last)) mistakes.push_back(last);
  }
  if (mistakes.size() == 1) return first;
  std::ranges::stable_sort(mistakes, {}, &StudyError::position);
  std::string text;
  for (const StudyError& each : mistakes) text += std::string(each.what()) + "\n";
  return {first.rule(), first.position(), "{}{} mistakes", text, mistakes.size()};
}

}  // namespace frahm::studies
