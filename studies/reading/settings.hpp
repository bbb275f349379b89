#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "studies/reading/study.hpp"

// Parameter values from the command line, and back into its form.
namespace frahm::studies {

// The study with the values of --set (name=value each; none: unchanged). Throws StudyError.
Study read_study_with(const std::filesystem::path& path, const std::vector<std::string>& set);
// The same for a study that was read. told_as: what messages call the place of the values.
Study with_settings(Study study, const std::vector<std::string>& set, std::string_view told_as = "--set");

// SI values of all parameters at one point: those of --at (name=value each), the rest as the study states
// them. told_as: what messages call their place. Throws StudyError for a wrong name or value, or if a network
// value is out of range there.
std::vector<double> parameters_at(const Study& study, const std::vector<std::string>& at,
                                  std::string_view told_as = "--at");

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
// which is one, otherwise that in which the study writes it; text "" for SI.
UsualUnit frequency_unit(const Study& study);
// The same for the record: "rpm", "rad s-1", "1" of a dimensionless study.
UsualUnit recorded_frequency_unit(const Study& study);
// An angular frequency [rad/s] in that unit: {250, "rpm"}.
SpokenValue spoken_frequency(const Study& study, double omega);

// The SI unit of a number parameter in CF form: that of its quantity, otherwise that of its given unit; "1"
// if neither is known.
std::string recorded_unit(const Study& study, std::size_t parameter);

}  // namespace frahm::studies
