#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_context.hpp"
#include "studies/reading/text/toml_reading.hpp"

namespace frahm::studies {

// A number parameter set to a value: an entry of a table such as { omega = 250, I = { value = 6, unit = "kg"
// } }, a bare number in its usual unit. why_not: the reason why a parameter cannot be set there, "" if it
// can; empty: all can.
using WhyNot = std::function<std::string(std::size_t parameter)>;
Assignment read_assignment(const StudyContext& context, const Study& study, const std::string& where,
                           const TomlEntry& entry, const WhyNot& why_not = {});

}  // namespace frahm::studies
