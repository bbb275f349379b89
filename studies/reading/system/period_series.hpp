#pragma once

#include <string>
#include <vector>

#include "solvers/mechanics/corner_series.hpp"
#include "solvers/transient/record.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/system/network_reading.hpp"

// One period of a force or of a support's motion, as harmonics of the frequency.
namespace frahm::studies {

struct Period {
  transient::RecordOf of = transient::RecordOf::force;
  mechanics::Node node;                    // index: as mechanics::Excitation::node counts them
  std::vector<mechanics::Corner> corners;  // straight lines between them; the last closes the period
  std::string key;                         // of the section, that gives them
  std::string file = "";  // that they are from; then a velocity or an acceleration may have a mean
};

// Adds a component for each order of the period's Fourier series that is not zero, up to the section's
// `orders`, and notes what is left out (StudyValues::series). A motion has the series of its displacement:
// that of a velocity or an acceleration integrated.
// Throws StudyError where a displacement does not close, or a velocity or an acceleration that is not from a
// file has a mean.
void add_period(NetworkReading& reading, const TomlSection& section, const Period& period);

}  // namespace frahm::studies
