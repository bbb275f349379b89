#include "studies/reading/study/study_reading.hpp"

namespace frahm::studies {

void read_motion_output(const StudyContext& context, const TomlValue& root, Study& study) {
  const TomlEntry* entry = find_entry(root, "output");
  if (!entry) return;
  const TomlSection section(context.source, entry->value, "[output]", "output", kind_name(study.kind()));
  read_recorded(section, *study.map());
  read_histories(context, section, "histories", study);
}

}  // namespace frahm::studies
