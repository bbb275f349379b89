#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "studies/reading/study.hpp"

// Parameters as the command line says them, and back.
namespace frahm::studies {

// The study with the values of --set (name=value each; none: as it stands). Throws StudyError.
Study read_study_with(const std::filesystem::path& path, const std::vector<std::string>& set);

// SI values of all parameters at one point: those of --at (name=value each), the rest as the study states
// them. Throws StudyError for a wrong name or value, or where some value of the network is out of its range
// there.
std::vector<double> parameters_at(const Study& study, const std::vector<std::string>& at);

// A number and its unit as a study speaks of it: {250, "rpm"}; unit "" if it has none or none is known.
struct SpokenValue {
  double value = 0.0;
  std::string unit;
};
// parameter: index in Parameters::list, of a number.  si: its value in SI.
SpokenValue spoken_value(const Study& study, std::size_t parameter, double si);

// The SI unit of a number parameter, in the form of CF: that of what it stands for, else that of the unit it
// is given in; "1" where neither is known.
std::string recorded_unit(const Study& study, std::size_t parameter);

}  // namespace frahm::studies
