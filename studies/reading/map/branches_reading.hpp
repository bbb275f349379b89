#pragma once

#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_context.hpp"

namespace frahm::studies {

// `branches` of [output] into the choice of a sweep.
void read_branches(const StudyContext& context, const TomlSection& output, Study& study);

}  // namespace frahm::studies
