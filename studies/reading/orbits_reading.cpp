#include "solvers/mechanics/bends.hpp"
#include "studies/reading/study_reading.hpp"

namespace frahm::studies {
namespace {

constexpr std::int64_t most_starts = 10'000;
constexpr std::int64_t longest_multiple = 64;  // the motions are followed for 324 periods at most

int read_count(const TomlSection& section, const char* key, int otherwise, std::int64_t most) {
  const std::int64_t count = section.integer_or(key, otherwise);
  if (count < 1 || count > most)
    section.fail(rules::out_of_range, key, "is {}; must be from 1 to {}", count, most);
  return static_cast<int>(count);
}

}  // namespace

void read_orbits_wanted(const StudyContext& context, const TomlValue& root, Study& study) {
  const TomlEntry* entry = find_entry(root, "orbits");
  if (!entry) return;
  const TomlSection section(context.source, entry->value, "[orbits]", {"starts", "most_multiple", "show"});
  if (!mechanics::may_have_several_responses(study.network))
    section.fail_here(rules::key_without_use,
                      "has no effect: several responses are searched where an element is a gap, has a table, "
                      "a cubic or a static_force; here there is one alone");
  periodic::OrbitsWanted& wanted = study.sweep()->orbits;
  wanted.starts = read_count(section, "starts", wanted.starts, most_starts);
  wanted.most_multiple = read_count(section, "most_multiple", wanted.most_multiple, longest_multiple);
  const bool smallest = section.choice_or("show", {"largest", "smallest"}) == "smallest";
  wanted.show = smallest ? periodic::OrbitsWanted::Show::smallest : periodic::OrbitsWanted::Show::largest;
}

}  // namespace frahm::studies
