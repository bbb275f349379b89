#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/quantities/parameters.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_context.hpp"
#include "studies/reading/text/rules.hpp"

// A parameter that somebody names elsewhere: on an axis, in a design, in a command.
namespace frahm::studies {

// Why what was written is refused.
struct Refusal {
  Rule rule;
  std::string text;
};

// Why a name is not that of a parameter that is a number; nothing if it is. need: what a computed one does
// not serve, such as "an axis needs one that is a number".
std::optional<Refusal> why_not_a_number(const Parameters& parameters, std::string_view name,
                                        std::string_view need);

// The parameter, a number, whose name a key holds.
std::size_t read_number_parameter(const TomlSection& section, const Parameters& parameters,
                                  const std::string& key, std::string_view need);

// Unit of a parameter's numbers: that of the key "unit", which is noted with the parameter, otherwise the
// usual one.
UsualUnit read_parameter_unit(const StudyContext& context, const TomlSection& section, Study& study,
                              std::size_t parameter);

}  // namespace frahm::studies
