#include "studies/program/explain_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ostream>
#include <vector>

#include "solvers/quantities/quantity_table.hpp"
#include "solvers/transient/motion_quantity.hpp"
#include "studies/program/exit_code.hpp"
#include "studies/provenance/result_variables.hpp"
#include "studies/reading/keys/element_keys.hpp"
#include "studies/reading/keys/study_keys.hpp"
#include "studies/reading/quantities/units.hpp"
#include "studies/reading/text/spelling.hpp"
#include "studies/reading/text/study_source.hpp"

namespace frahm::studies {
namespace {

// A word and what it means.
struct Meaning {
  std::string word;
  std::string text;
};

const Meaning exit_codes[] = {
    {"0", "exit code: done"},
    {"1", "exit code: an internal error of frahm, please report it"},
    {"2", "exit code: wrong usage, or something wrong in the study; the message says what and where"},
    {"3",
     "exit code: finished, but some points failed or have no periodic response; they are marked in the file. "
     "check: none of the points tried has a response"},
    {"4", "exit code: stopped, by a signal or the time budget; the same command resumes"},
    {"5",
     "exit code: refused to mix results of different studies; nothing was changed. Use another -o, or "
     "--fresh"},
    {"6",
     "exit code: a file or stream could not be read or written, a file is in the way of an output, or memory "
     "ran out"},
    {"7",
     "exit code: a tuning or fit did not converge; the best so far is in the file. check: the tuning would "
     "not"},
    {"8", "exit code: the self-check of frahm verify failed on this machine"},
    {"done", "outcome of a run in Python: exit code 0, done"},
    {"some_failed",
     "outcome of a run in Python: exit code 3, finished, but some points failed; they are marked in the "
     "file"},
    {"stopped", "outcome of a run in Python: exit code 4, stopped by a signal or the time budget"},
    {"not_converged", "outcome of a run in Python: exit code 7; the best so far is in the file"}};

// What is no key of the readers, and no unit of UDUNITS.
const Meaning further_meanings[] = {
    {"repeat",
     "repeat in any [[table]]: { i = [1, 60] } makes a table for each i, and in its texts {i}, {i-1} and "
     "{i+1} are numbers; [3, 60, 3] has a step of 3; two indices make a table for every pair"},
    {"deg", "deg: not a unit of a study; write degree"}};

const Meaning flag_words[] = {
    {"not_computed", "status or regime: no value here, because it was not asked for, or not reached"},
    {"ok",
     "status: a periodic response was found; residual and error_bound give its accuracy. Without an "
     "error_bound it is not known how many digits are right, and frahm point says why"},
    {"grazing",
     "status: a contact's velocity or force only touches its limit: the response is right, but its "
     "derivative does not exist there"},
    {"unbounded",
     "status: an undamped resonance that friction cannot hold: no periodic response exists (it grows for "
     "ever)"},
    {"failed", "status: no response was found; frahm point STUDY --at ... prints the reason"},
    {"several",
     "status: more than one stable response was found, and one of them is reported; [orbits] show chooses "
     "which"},
    {"not_periodic",
     "status: no stable response was found among the multiples of the period that were tried "
     "([orbits] most_multiple)"},
    {"converged",
     "outcome of a tuning or a fit: it meets its tolerances; for a tuning, those of the certificate gap and "
     "of the KKT residual"},
    {"not_converged",
     "outcome of a tuning or a fit: it does not meet its tolerances; the best found is reported"},
    {"infeasible",
     "outcome of a tuning: no design met the limits ([[constraint]]); the one reported breaks them least, "
     "and `violation` says by how much"},
    {"unbounded", "outcome of a tuning: the response has no bound at some frequency of the band"},
    {"failed", "outcome of a tuning: the response could not be computed; the reason is given with it"},
    {"stopped", "outcome of a tuning: stopped by a signal or the time budget; the same command resumes"},
    {"no_friction", "regime of a friction element: it has no friction force here, F = 0"},
    {"non_stop", "regime of a friction element: it slides all the time, turning at single instants"},
    {"one_stop", "regime of a friction element: it stops once or twice in a period of the excitation"},
    {"multi_stop",
     "regime of a friction element: it stops three times or more in a period of the excitation"},
    {"stuck", "regime of a friction element: it never slides"},
    {"fold", "special point of a branch: the parameter turns back there"},
    {"branching",
     "special point of a branch: a multiplier passes +1 and the parameter goes on, so another branch "
     "crosses"},
    {"period_doubling",
     "special point of a branch: a multiplier passes -1; a branch of twice the period begins there"},
    {"torus", "special point of a branch: a pair of complex multipliers passes the unit circle"},
    {"stability_jump",
     "special point of a branch: a multiplier jumps across the unit circle where an event begins"},
    {"grazing", "special point of a branch: an event of an element begins or ends there"},
    {"jump", "special point of a branch: it ends where an event begins that throws the motion elsewhere"},
    {"corner", "special point of a branch: the parameter turns back where an event begins or ends"}};

const char* name_of(periodic::Owner owner) {
  switch (owner) {
    case periodic::Owner::mass:
      return "MASS";
    case periodic::Owner::element:
    case periodic::Owner::contact:
    case periodic::Owner::sliders:
      return "ELEMENT";
    case periodic::Owner::support:
      return "SUPPORT";
    default:
      return "";
  }
}

// `natural_frequency_2` of `natural_frequency`.
bool is_numbered(const std::string& word, const std::string& suffix) {
  return word.starts_with(suffix + "_") && word.size() > suffix.size() + 1 &&
         word.find_first_not_of("0123456789", suffix.size() + 1) == std::string::npos;
}

// A quantity of responses or of motions, for words that name it by the end of a name.
struct KnownQuantity {
  std::string_view suffix;
  std::string owner;  // "MASS"; "" of none
  std::string text;

  // `machine_peak`, `peak` or `MASS_peak`; of a mode with its number.
  bool is_named(const std::string& word) const {
    return word == suffix || is_numbered(word, std::string(suffix)) ||
           (!owner.empty() && word.ends_with(fmt::format("_{}", suffix)));
  }
};

KnownQuantity known(std::string_view suffix, const std::string& owner, const char* of, std::string_view unit,
                    std::string meaning) {
  const std::string name = owner.empty() ? std::string(suffix) : fmt::format("{}_{}", owner, suffix);
  if (const auto place = meaning.find("{}"); place != std::string::npos) meaning.replace(place, 2, owner);
  if (const auto gap = meaning.find("  "); gap != std::string::npos) meaning.erase(gap, 1);  // of no owner
  return {suffix, owner, fmt::format("{}: {} [{}]: {}", name, of, unit, meaning)};
}

KnownQuantity known(const periodic::QuantityRow& row) {
  KnownQuantity quantity = known(row.suffix, name_of(row.owner), "quantity", row.unit, row.meaning);
  for (const periodic::FlagMeaning& flag : row.flags)
    quantity.text +=
        fmt::format("{}{} {}", &flag == row.flags.data() ? ". " : ", ", flag.value, flag.meaning);
  if (row.derivative == nullptr && *row.why_not_differentiated)
    quantity.text += fmt::format(". No derivative: {}", row.why_not_differentiated);
  return quantity;
}

// Those of motions that responses have too are left out.
std::vector<KnownQuantity> known_quantities() {
  std::vector<KnownQuantity> all;
  for (const periodic::QuantityRow& row : periodic::quantity_table()) all.push_back(known(row));
  const std::size_t of_responses = all.size();
  for (const transient::MotionQuantityWords& row : transient::motion_quantity_words()) {
    const auto is_the_same = [&](const KnownQuantity& each) {
      return each.suffix == row.suffix && each.owner.empty() == row.owner.empty();
    };
    if (std::none_of(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(of_responses), is_the_same))
      all.push_back(known(row.suffix, std::string(row.owner), "quantity of a motion", row.unit,
                          std::string(row.meaning)));
  }
  return all;
}

// Of the quantities whose names fit, those with the longest suffix: `energy_share` is no `share`.
std::vector<KnownQuantity> quantities_called(const std::string& word) {
  std::vector<KnownQuantity> found = known_quantities();
  std::erase_if(found, [&](const KnownQuantity& each) { return !each.is_named(word); });
  std::size_t longest = 0;
  for (const KnownQuantity& each : found) longest = std::max(longest, each.suffix.size());
  std::erase_if(found, [&](const KnownQuantity& each) { return each.suffix.size() < longest; });
  return found;
}

std::string written_range(mechanics::Range range) {
  switch (range) {
    case mechanics::Range::finite:
      return "any number";
    case mechanics::Range::not_negative:
      return ">= 0";
    case mechanics::Range::positive:
      return "> 0";
  }
  return "";
}

// "stiffness = k [N/m], for a rotation [N m/rad], >= 0".
std::string text_of(const mechanics::ValueKey& value, bool is_optional) {
  std::string text = value.key;
  if (*value.symbol) text += fmt::format(" = {}", value.symbol);
  const Quantity along = element_quantity(value.dimension, false),
                 turning = element_quantity(value.dimension, true);
  text += fmt::format(" [{}]", written_si_unit(along));
  if (turning != along) text += fmt::format(", for a rotation [{}]", written_si_unit(turning));
  return text + fmt::format(", {}{}", written_range(value.range), is_optional ? "; may be left out" : "");
}

// "; for kind = sweep or transient" where not all forms of the section have the key.
std::string owners_text(const KeyOwners& owners) {
  if (*owners.of == '\0') return "";
  const std::string decider = *owners.decider ? fmt::format("{} = ", owners.decider) : "";
  return fmt::format("; for {}{}", decider, listed(separated(owners.of), " or "));
}

// "; default 8".
std::string default_text(const StudyKey& key) {
  if (!key.by_default) return "";
  const double number = *key.by_default;
  if (key.form == KeyForm::boolean) return fmt::format("; default {}", number != 0.0);
  if (key.form == KeyForm::choice)
    return fmt::format("; default {}", key.words[static_cast<std::size_t>(number)].word);
  return fmt::format("; default {}", number);
}

// What stands in the table of keys.
std::string meaning_of(const StudyKey& key) {
  const std::vector<std::string> words = words_of(key);
  const std::string choices = words.empty() ? "" : fmt::format(" ({})", listed(words, " or "));
  return key.meaning + choices + default_text(key) + owners_text(key.owners);
}

// The values of a type of element, and what stands of its other keys in the table of keys.
std::string keys_text(const std::string& type) {
  const mechanics::ElementKind& kind = kind_called(type);
  std::string text;
  for (const std::string& key : keys_of_type(type)) {
    const bool is_iwan = type == iwan;
    const mechanics::ValueKey* found = nullptr;
    for (const mechanics::ValueKey* value : kind.values()) {
      if (!is_iwan && key == value->key) found = value;
    }
    const bool is_optional = found && (found->is_optional || found->law);
    text += "\n  " + (found ? text_of(*found, is_optional)
                            : fmt::format("{}: {}", key, meaning_of(study_key("element", key))));
  }
  return text;
}

std::vector<std::string> types_called(const std::string& word) {
  std::vector<std::string> found;
  for (const std::string& type : element_types()) {
    if (word != type) continue;
    const std::string force =
        type == iwan ? fmt::format("the sum of its sliders, each a jenkins: {}", kind_called(type).force)
                     : kind_called(type).force;
    found.push_back(fmt::format("{}: type of an [[element]], u across it, v = u': its force is {}{}", type,
                                force, keys_text(type)));
  }
  return found;
}

// The words of choices: `arctan`, `kanai_tajimi`.
std::vector<std::string> choices_called(const std::string& word) {
  std::vector<std::string> found;
  for (const StudyKey& key : study_keys()) {
    for (const StudyWord& each : key.words) {
      if (word == each.word)
        found.push_back(
            fmt::format("{}: a {} of {}: {}", word, key.key, written_section(key.section), each.meaning));
    }
  }
  return found;
}

std::string unit_behind(Quantity quantity) {
  return quantity == Quantity::number ? "" : fmt::format(" {}", written_si_unit(quantity));
}

// A unit, for each quantity that may have it: `Hz`, `kN/mm`, `gravity`.
std::vector<std::string> units_called(const std::string& word) {
  const UnitSystem units;
  std::vector<std::string> found;
  try {
    const Unit unit = units.parse(word);
    for (const Quantity quantity : quantities_in(unit)) {
      if (quantity == Quantity::angle && unit.radians == 0) continue;  // a share is no angle
      const double factor = si_factor(unit, quantity);
      found.push_back(fmt::format(
          "{0}: unit of {1}: 1 {0} = {2:.10g}{3}{4}; such as {5}", word, quantity_name(quantity), factor,
          unit_behind(quantity), factor == unit.scale ? "" : ", as it counts cycles", usual_units(quantity)));
    }
    if (found.empty())
      found.push_back(fmt::format("{}: unit of {}; no value of a study has this dimension by itself", word,
                                  dimension_name(unit)));
    if (word == "g")
      found.emplace_back("g: the same as gravity, in an [[excitation.record]] of accelerations");
  } catch (const UnitError&) {  // it is none
  }
  return found;
}

// A section or a key: `stiffness`, `element.stiffness`, `[[element]]`.
std::vector<std::string> keys_called(const std::string& word) {
  std::vector<std::string> found;
  for (const StudyKey& each : study_keys()) {
    const std::string section = each.section;
    const std::string path = section.empty() ? each.key : section + "." + each.key;
    if (word != each.key && word != path && word != written_section(path)) continue;
    const bool is_section = section.empty();
    found.push_back(is_section
                        ? fmt::format("{}: section of a study: {}", written_section(path), meaning_of(each))
                        : fmt::format("{} in {}: {}", each.key, written_section(section), meaning_of(each)));
  }
  return found;
}

std::vector<std::string> words_of_studies() {
  std::vector<std::string> words;
  for (const StudyKey& each : study_keys()) {
    words.emplace_back(each.key);
    for (std::string& word : words_of(each)) words.push_back(std::move(word));
  }
  for (const Meaning& each : flag_words) words.push_back(each.word);
  for (const KnownQuantity& each : known_quantities()) words.emplace_back(each.suffix);
  for (const ResultVariable& each : result_variables()) words.emplace_back(each.name);
  for (const Meaning& each : further_meanings) words.push_back(each.word);
  return words;
}

}  // namespace

int explain_command(const std::string& word, std::ostream& out) {
  std::vector<std::string> found;
  for (auto* called : {keys_called, types_called, choices_called}) {
    for (std::string& text : called(word)) found.push_back(std::move(text));
  }
  for (const Meaning& each : exit_codes) {
    if (word == each.word) found.push_back(fmt::format("{}: {}", each.word, each.text));
  }
  for (const Meaning& each : flag_words) {
    if (word == each.word) found.push_back(fmt::format("{}: {}", each.word, each.text));
  }
  for (const Meaning& each : further_meanings) {
    if (word == each.word) found.push_back(each.text);
  }
  const bool is_known = !found.empty();
  std::size_t shortest = 0;  // `main_peak_time` is a quantity, not a `*_time`
  for (const KnownQuantity& quantity : quantities_called(word)) {
    found.push_back(quantity.text);
    shortest = std::string_view("*_").size() + quantity.suffix.size();
  }
  for (std::string& text : is_known ? result_variables_named(word) : result_variables_called(word, shortest))
    found.push_back(std::move(text));
  // Words of our own come first: UDUNITS has a unit called `force`.
  if (found.empty()) found = units_called(word);
  if (found.empty())
    throw StudyError(rules::unknown_name,
                     "explain: \"{}\" is not a key, type, choice, quantity, variable of results, unit, "
                     "status, regime, outcome or exit code{}",
                     word, suggestion(word, words_of_studies()));
  for (const std::string& text : found) out << text << '\n';
  return exit_code::done;
}

}  // namespace frahm::studies
