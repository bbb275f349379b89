#pragma once

#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_context.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {

// [decay], [transient] and [[initial]] into the study's choice, after the network, in the same way.
void read_motion(const StudyContext& context, const TomlValue& root, Study& study);

// [output] of a transient with axes.
void read_motion_output(const StudyContext& context, const TomlValue& root, Study& study);

}  // namespace frahm::studies
