#pragma once

#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_context.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {

// [compare] into the choice of a sweep, once the network is there. Sets the quantity of a slope parameter.
void read_comparison(const StudyContext& context, const TomlValue& root, Study& study);
// Refuses a `show` of [compare] that does not fit what the study shows itself, once that is read.
void check_compared_show(const StudyContext& context, const TomlValue& root, const Study& study);

}  // namespace frahm::studies
