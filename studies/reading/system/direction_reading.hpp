#pragma once

#include <span>
#include <string_view>

#include "solvers/mechanics/network.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/quantities/parameters.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_context.hpp"

namespace frahm::studies {

// `along = { roof = 1, wheel = "-r", ground = -1 }` of a section: a combination of the nodes of a network,
// each once, at least one of them a mass. A factor is a number, { value, unit } of a length per radian, or an
// expression of parameters; with the units of its factors it is a displacement [m], or an angle [rad] where
// only rotations take part and no factor is a length. Throws StudyError.
StudyDirection read_direction(const StudyContext& context, const Parameters& parameters,
                              const mechanics::Network& network, const TomlSection& section);

// The direction with the parameters as the study states them, once all of the study is read and its units are
// converted. Throws StudyError for a factor that is zero or not finite, or that reads a parameter which
// changes within the study: an axis, a band, a design, an identified parameter, the frequency of a run-up.
mechanics::Direction direction_of(const Study& study, const StudyDirection& along);

// Refuses a point (SI values of all parameters, completed) at which a factor differs from that of the
// direction. origin: who sets the parameters so, as in check_point().
void check_direction_at(const Study& study, const StudyDirection& along, std::span<const double> parameters,
                        std::string_view origin);

// Gives each element `along` a combination its factors, once units are converted and all that may change is
// read. Refuses factors that change within the study, and masses that no spring holds through levers.
void set_directions(Study& study);

}  // namespace frahm::studies
