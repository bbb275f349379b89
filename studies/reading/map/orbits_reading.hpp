#pragma once

#include "solvers/orbits/orbits_wanted.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_context.hpp"
#include "studies/reading/text/toml_reading.hpp"

// Which of several responses are searched and shown.
namespace frahm::studies {

// [orbits] of a sweep or a tuning.
periodic::OrbitsWanted read_orbits_wanted(const StudyContext& context, const TomlValue& root,
                                          const Study& study);

// The key `show`: which of several responses, by default the largest; a sweep needs exact laws and an axis of
// the frequency.
periodic::OrbitsWanted::Show read_show(const TomlSection& section);
void check_slow_sweep(const TomlSection& section, const Study& study);

}  // namespace frahm::studies
