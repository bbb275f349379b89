#include <cmath>

#include "studies/reading/study_reading.hpp"

namespace frahm::studies {

void check_identification(StudyFile& study) {
  if (study.network.masses.empty()) return;
  const IdentifyChoice& choice = *study.identify;
  const std::vector<std::vector<bool>> all_corners = corners(choice.parameters.size());
  for (const RecordChoice& record : choice.records) {
    std::vector<double> stated = study.parameters.nominal();
    for (const Assignment& assignment : record.set) stated[assignment.parameter] = assignment.value;
    for (const std::vector<bool>& corner : all_corners) {
      std::vector<double> parameters = stated;
      for (std::size_t i = 0; i < corner.size(); ++i) {
        const IdentifiedParameter& fitted = choice.parameters[i];
        const double bound = corner[i] ? fitted.upper : fitted.lower;
        if (std::isfinite(bound)) parameters[fitted.parameter] = bound;
      }
      check_point(study, parameters);
      add_crank_orders_at(study, parameters);
    }
  }
}

}  // namespace frahm::studies
