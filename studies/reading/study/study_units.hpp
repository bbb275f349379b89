#pragma once

#include <cstddef>
#include <string>

#include "studies/reading/quantities/units.hpp"
#include "studies/reading/study/study.hpp"

// Numbers in the study's own units.
namespace frahm::studies {

// A number in the study's unit: {250, "rpm"}; unit "" if it has none or none is known.
struct SpokenValue {
  double value = 0.0;
  std::string unit;
};
// parameter: index in Parameters::list, of a number.  si: its value in SI.
SpokenValue spoken_value(const Study& study, std::size_t parameter, double si);
// "400 rpm", in messages.
std::string spoken_text(const Study& study, std::size_t parameter, double si);

// The study's unit of the excitation frequency, or of what else is a frequency in it: that of the parameter
// which is one, else that in which the study writes it; text "" for SI.
UsualUnit frequency_unit(const Study& study);
// The same for the record: "rpm", "rad s-1", "1" of a dimensionless study.
UsualUnit frequency_unit_in_file(const Study& study);
// An angular frequency [rad/s] in that unit: {250, "rpm"}.
SpokenValue spoken_frequency(const Study& study, double omega);

// The SI unit of a number parameter in CF form: that of its quantity, else that of its given unit; "1" if
// neither is known.
std::string unit_in_file(const Study& study, std::size_t parameter);

}  // namespace frahm::studies
