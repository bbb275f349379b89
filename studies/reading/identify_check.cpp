#include "studies/reading/study_reading.hpp"

namespace frahm::studies {

void check_identification(StudyFile& study) {
  if (study.network.masses.empty()) return;
  for (const RecordChoice& record : study.identify->records) {
    std::vector<double> parameters = study.parameters.nominal();
    for (const Assignment& assignment : record.set) parameters[assignment.parameter] = assignment.value;
    check_point(study, parameters);
    add_crank_orders_at(study, parameters);
  }
}

}  // namespace frahm::studies
