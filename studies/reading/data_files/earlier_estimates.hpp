#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studies/reading/quantities/parameters.hpp"
#include "studies/reading/study/study_context.hpp"

// What an identification found, as later studies use it: fits that fix it, samples that scatter with it.
namespace frahm::studies {

// The estimates of a result file that have a covariance, and that covariance in the same order.
struct EarlierEstimates {
  std::string file;  // as the study names it
  std::vector<std::string> names, units;
  std::vector<double> values, degrees_of_freedom;
  std::vector<std::vector<double>> covariance;
};

// Throws StudyError, without a place in the study, for a file that is not the result of an identification
// that converged.
EarlierEstimates read_earlier(const std::filesystem::path& path, const std::string& file);

// The unit of estimate i is the SI one of its parameter, where that is known. Throws StudyError in the same
// way.
void check_unit(const StudyContext& context, const EarlierEstimates& earlier, std::size_t i,
                const Parameter& parameter);

}  // namespace frahm::studies
