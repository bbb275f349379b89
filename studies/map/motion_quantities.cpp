#include "studies/map/motion_quantities.hpp"

#include <algorithm>

#include "studies/map/output_quantities.hpp"
#include "studies/reading/text/name_pattern.hpp"

namespace frahm::studies {
namespace {

using transient::MotionQuantity;

// Those of all that a name stands for, or a pattern of names.
std::vector<MotionQuantity> quantities_called(const Study& study, const OutputChoice::Name& name,
                                              const std::vector<MotionQuantity>& all) {
  std::vector<MotionQuantity> found;
  std::vector<std::string> known;
  for (const MotionQuantity& each : all) {
    known.push_back(transient::describe(each, study.network, study.dimensionless).name);
    if (matches(name.text, known.back())) found.push_back(each);
  }
  if (!found.empty()) return found;
  throw study.source.error_at(rules::unknown_name, name.position,
                              "[output]: quantities: a motion has no quantity \"{}\"{}", name.text,
                              hint_of_unmatched(name.text, known));
}

}  // namespace

std::vector<MotionQuantity> motion_quantities(const Study& study) {
  const OutputChoice& output = study.map()->output;
  const bool runs = study.transient()->sweep_to.has_value();
  if (output.quantities == OutputChoice::Quantities::standard)
    return transient::standard_motion_quantities(study.network, runs);
  const std::vector<MotionQuantity> all = transient::all_motion_quantities(study.network, runs);
  if (output.quantities == OutputChoice::Quantities::all) return all;
  std::vector<MotionQuantity> result;
  for (const OutputChoice::Name& name : output.names) {
    for (const MotionQuantity& each : quantities_called(study, name, all))
      if (std::ranges::find(result, each) == result.end()) result.push_back(each);
  }
  const MotionQuantity status{.measure = transient::MotionMeasure::status};
  if (std::ranges::find(result, status) == result.end()) result.push_back(status);
  return result;
}

std::vector<periodic::QuantityDescription> motion_variables(const Study& study,
                                                            const std::vector<MotionQuantity>& quantities) {
  std::vector<periodic::QuantityDescription> variables;
  for (const MotionQuantity& quantity : quantities)
    variables.push_back(transient::describe(quantity, study.network, study.dimensionless));
  check_names_in_file(study, variables);
  return variables;
}

}  // namespace frahm::studies
