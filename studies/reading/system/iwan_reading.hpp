#pragma once

#include <vector>

#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/study/study_values.hpp"
#include "studies/reading/system/network_reading.hpp"

namespace frahm::studies {

// A spring in series with a slider, as one of those of an iwan element.
struct StudySlider {
  StudyValue stiffness, force;
};
// Those of an iwan element: listed, or of a distribution.
std::vector<StudySlider> read_sliders(NetworkReading& reading, const TomlSection& section, bool rotational);

}  // namespace frahm::studies
