#include "studies/reading/map/orbits_reading.hpp"

#include "solvers/mechanics/bends.hpp"
#include "studies/reading/system/unfit_elements.hpp"

namespace frahm::studies {
void check_slow_sweep(const TomlSection& section, const Study& study) {
  refuse_smooth_laws(study, "a sweep up or down");
  if (!study.sweep()->frequency_dimension)
    section.fail(rules::unfit_axis, "show", "sweeps the excitation frequency, but no [[axis]] changes it");
  const auto& samples = study.map()->samples;
  if (samples && study.sweep()->frequency_dimension == samples->dimension)
    section.fail(rules::unfit_axis, "show",
                 "sweeps the excitation frequency, but here it belongs to samples in no order");
}

periodic::OrbitsWanted::Show read_show(const TomlSection& section) {
  return section.choice_as<periodic::OrbitsWanted::Show>("show");
}

periodic::OrbitsWanted read_orbits_wanted(const StudyContext& context, const TomlValue& root,
                                          const Study& study) {
  periodic::OrbitsWanted wanted;
  const TomlEntry* entry = find_entry(root, "orbits");
  if (!entry) return wanted;
  const TomlSection section(context.source, entry->value, "[orbits]", "orbits");
  const bool has_one = study.tune() ? !tuning::may_take_several_orbits(study.network)
                                    : !mechanics::may_have_several_responses(study.network);
  if (has_one) section.fail_here(rules::beyond_schema(rules::key_without_use), "{}", only_one_response());
  wanted.starts = static_cast<int>(section.integer("starts"));
  wanted.most_multiple = static_cast<int>(section.integer("most_multiple"));
  if (study.tune()) {
    if (section.find("show"))
      section.fail(rules::beyond_schema(rules::key_without_use), "show",
                   "has no effect: in a tuning the worst response counts");
    return wanted;
  }
  wanted.show = read_show(section);
  if (!wanted.is_slow_sweep()) return wanted;
  check_slow_sweep(section, study);
  const auto& comparison = study.sweep()->comparison;
  const bool searches =
      comparison && comparison->show && !periodic::OrbitsWanted::is_slow_sweep(*comparison->show);
  if (section.find("starts") && !searches)
    section.fail(rules::beyond_schema(rules::key_without_use), "starts",
                 "has no effect: a sweep begins at rest and continues from point to point");
  return wanted;
}

}  // namespace frahm::studies
