#include <catch2/catch.hpp>
#include <numbers>
#include <string>

#include "studies/reading/parse_study.hpp"
#include "studies/reading/settings.hpp"
#include "studies/reading/study/study.hpp"
#include "tests/studies/small_studies.hpp"

// Angles of a dimensionless study, which has no units, may be given in degrees.
namespace dimensionless_angle_test {
namespace {

using namespace frahm::studies;

constexpr double rounding = 1e-15;

Study with_phase(const std::string& phase) {
  std::string text = small_studies::oscillator() + small_studies::axis("r", 0.5, 1.0, 3);
  const std::string amplitude = "on = \"main\"\namplitude = 1\n";
  return parse_study(text.insert(text.find(amplitude) + amplitude.size(), "phase = " + phase + "\n"),
                     "phase.toml");
}

double phase_of(const Study& study) {
  std::vector<double> parameters = study.parameters.nominal();
  frahm::mechanics::NetworkValues values;
  evaluate(study.values, study.parameters, parameters, values);
  return values.excitation[0].phase;
}

TEST_CASE("degrees are angles in a dimensionless study too, and other units are refused as before") {
  CHECK_THAT(phase_of(with_phase("{ value = 90, unit = \"degree\" }")),
             Catch::WithinRel(std::numbers::pi / 2.0, rounding));
  CHECK(phase_of(with_phase("{ value = 0.5, unit = \"rad\" }")) == 0.5);
  CHECK(phase_of(with_phase("{ value = 0.5, unit = \"1\" }")) == 0.5);
  CHECK_THAT(phase_of(with_settings(with_phase("\"f\""), {"f=30 degree"}, "--set")),
             Catch::WithinRel(std::numbers::pi / 6.0, rounding));
  CHECK_THROWS_WITH(with_phase("{ value = 1, unit = \"mm\" }"),
                    Catch::Contains("has no meaning in a dimensionless study") && Catch::Contains("degree"));
  CHECK_THROWS_WITH(with_settings(with_phase("\"f\""), {"f=1 mm"}, "--set"),
                    Catch::Contains("has no meaning in a dimensionless study"));
}

}  // namespace
}  // namespace dimensionless_angle_test
