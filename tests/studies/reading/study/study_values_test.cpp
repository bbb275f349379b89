#include "studies/reading/study/study_values.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "studies/reading/parse_study.hpp"
#include "studies/reading/study/study.hpp"
#include "tests/study_path.hpp"

namespace study_values_test {
namespace {

using frahm::mechanics::NetworkValues;
using frahm::studies::differentiate;
using frahm::studies::evaluate;
using frahm::studies::read_study;
using frahm::studies::Study;

constexpr double step = 1e-6;  // relative, of the central differences
// Central differences: their truncation is of order step^2, their rounding of order 1e-16/step.
constexpr double difference_tolerance = 1e-8;

std::vector<double> flat(const NetworkValues& values) {
  std::vector<double> all{values.omega};
  all.insert(all.end(), values.mass.begin(), values.mass.end());
  all.insert(all.end(), values.element.begin(), values.element.end());
  for (const auto& harmonic : values.excitation) {
    all.push_back(harmonic.amplitude);
    all.push_back(harmonic.phase);
  }
  return all;
}

std::vector<double> values_at(const Study& study, std::vector<double> parameters) {
  NetworkValues values;
  evaluate(study.values, study.parameters, parameters, values);
  return flat(values);
}

TEST_CASE("the derivative of every value by every parameter agrees with differences") {
  for (const char* name : {"rig_atlas", "cheng_zu", "den_hartog"}) {
    const Study study = read_study(study_path(name));
    const auto nominal = study.parameters.nominal();
    for (std::size_t by = 0; by < nominal.size(); ++by) {
      INFO(name << ", by " << study.parameters.list[by].name);
      NetworkValues derivative;
      differentiate(study.values, study.parameters, nominal, by, derivative);
      const double h = step * std::max(1.0, std::abs(nominal[by]));
      auto above = nominal, below = nominal;
      above[by] += h;
      below[by] -= h;
      const auto exact = flat(derivative), up = values_at(study, above), down = values_at(study, below);
      for (std::size_t i = 0; i < exact.size(); ++i) {
        const double scale =
            1.0 + std::abs(exact[i]) + std::abs(up[i]) / std::max(1.0, std::abs(nominal[by]));
        CHECK_THAT(exact[i], Catch::WithinAbs((up[i] - down[i]) / (2.0 * h), difference_tolerance * scale));
      }
    }
  }
}

TEST_CASE("evaluation does not move the values it has once made room for") {
  const Study study = read_study(study_path("rig_atlas"));
  auto parameters = study.parameters.nominal();
  NetworkValues values;
  evaluate(study.values, study.parameters, parameters, values);
  const double* elements = values.element.data();
  parameters[1] = 12.9;
  evaluate(study.values, study.parameters, parameters, values);
  CHECK(values.element.data() == elements);
  CHECK(values.element[6] == 12.9);
}

}  // namespace
}  // namespace study_values_test
