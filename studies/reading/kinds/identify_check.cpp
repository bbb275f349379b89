#include "studies/reading/kinds/identify_check.hpp"

#include <fmt/format.h>

#include <cmath>

#include "studies/reading/map/corners.hpp"
#include "studies/reading/map/grid_check.hpp"

namespace frahm::studies {
namespace {

// Adds the crank orders needed anywhere within the bounds of the fit.
void add_crank_orders_within(Study& study, const std::vector<double>& start) {
  const auto& fitted = study.identify()->parameters;
  for (const std::vector<bool>& corner : corners(fitted.size())) {
    std::vector<double> parameters = start;
    for (std::size_t i = 0; i < corner.size(); ++i) {
      const double bound = corner[i] ? fitted[i].upper : fitted[i].lower;
      if (std::isfinite(bound)) parameters[fitted[i].parameter] = bound;
    }
    study.parameters.complete(std::span<double>(parameters));
    add_crank_orders_at(study, parameters);
  }
}

}  // namespace

void check_identification(Study& study) {
  if (study.network.masses.empty()) return;
  for (const RecordChoice& record : study.identify()->records) {
    std::vector<double> parameters = study.parameters.nominal();
    for (const Assignment& assignment : record.set) parameters[assignment.parameter] = assignment.value;
    check_point(study, parameters, fmt::format("[[identify.record]] \"{}\"", record.name));
    add_crank_orders_within(study, parameters);
  }
}

}  // namespace frahm::studies
