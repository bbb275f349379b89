#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "solvers/identification/grey_box.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "studies/identification/closed_form_methods.hpp"
#include "studies/identification/free_decay_start.hpp"
#include "studies/identification/grey_box_task.hpp"
#include "studies/identification/identification_result.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_units.hpp"

namespace frahm::studies {
namespace {

using identification::Identification;

IdentificationResult fit_grey_box(const Study& study, const transient::Watch& watch) {
  IdentificationResult result;
  identification::GreyBoxTask task = grey_box_task(study);
  task.watch = watch;
  if (study.identify()->start == IdentifyStart::free_decay) {
    result.first = first_estimates(study);
    if (result.first->failure.empty()) set_start(study, *result.first, task);
  }
  result.fit = identification::grey_box(task);
  return result;
}

// Adds each parameter that takes an estimate to the estimates under its own name too, so that a later study
// of the chain finds it. The reading of the study ensures that the method has the estimate.
void name_parameters(const Study& study, Identification& fit) {
  std::vector<std::string> names;
  for (const identification::Estimate& estimate : fit.estimates) names.push_back(estimate.name);
  for (const IdentifiedParameter& parameter : study.identify()->parameters) {
    const std::string& own = study.parameters.list[parameter.parameter].name;
    if (parameter.estimate.empty() || parameter.estimate == own) continue;
    const auto place = std::find(names.begin(), names.end(), parameter.estimate);
    const auto fail = [&](Rule rule, const std::string& what) {
      throw study.source.error_at(rule, parameter.position, "[[identify.parameter]] \"{}\": {}", own, what);
    };
    if (place == names.end()) throw std::logic_error("no estimate " + parameter.estimate);
    if (std::find(names.begin(), names.end(), own) != names.end())
      fail(rules::name_taken, fmt::format("an estimate of the method {} has this name; rename the parameter",
                                          method_name(study.identify()->method)));
    const auto taken = static_cast<std::size_t>(place - names.begin());
    identification::Estimate alias = fit.estimates[taken];
    const std::string unit = unit_in_file(study, parameter.parameter);
    if (unit != "1" && unit != alias.unit)
      fail(rules::two_units,
           fmt::format("is in {}, and the estimate \"{}\" in {}", unit, parameter.estimate, alias.unit));
    alias.name = own;
    add_derived(fit, std::move(alias), Eigen::VectorXd::Unit(fit.covariance.rows(), place - names.begin()));
  }
}

}  // namespace

IdentificationResult identify(const Study& study, const transient::Watch& watch) {
  try {
    IdentificationResult result;
    if (study.identify()->method == IdentifyMethod::grey_box) {
      result = fit_grey_box(study, watch);
    } else {
      result.fit = identify_in_closed_form(study);
    }
    if (!result.fit.failure.empty())
      throw StudyError(rules::not_computed, "{}: nothing is identified: {}", study.source.name,
                       result.fit.failure);
    name_parameters(study, result.fit);
    for (const RecordChoice& record : study.identify()->records) {
      if (record.doubtful > 0)
        result.fit.notes.push_back(fmt::format("{} doubtful row{} of {} {} left out", record.doubtful,
                                               record.doubtful == 1 ? "" : "s", record.name,
                                               record.doubtful == 1 ? "is" : "are"));
    }
    return result;
  } catch (const mechanics::MechanicsError& error) {
    throw StudyError(rules::not_computed, "{}", study.source.name + ": " + error.what());
  }
}

}  // namespace frahm::studies
