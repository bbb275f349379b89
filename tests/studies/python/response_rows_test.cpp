#include "studies/python/response_rows.hpp"

#include <catch2/catch.hpp>

#include "studies/map/row_solver.hpp"
#include "studies/reading/parse_study.hpp"
#include "tests/studies/small_studies.hpp"

namespace response_rows_test {
namespace {

using namespace frahm;
using namespace frahm::studies;
using small_studies::axis, small_studies::oscillator;

Study swept() {
  return parse_study(oscillator() + axis("r", 0.5, 1.5, 11), "small.toml");
}

std::vector<double> steps(double from, double step, std::size_t count) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = from + step * static_cast<double>(i);
  return values;
}

// Rows of 600 points, longer than a piece, for two friction forces.
RowGrid two_rows(const Study& study) {
  return {
      study.parameters.nominal(),
      {{*study.parameters.find("f"), {0.0, 0.3}}, {*study.parameters.find("r"), steps(0.5, 0.0015, 600)}}};
}

TEST_CASE("rows in memory do not depend on the threads") {
  const Study study = swept();
  const auto quantities = quantities_called(study, {});
  const RowResponses one = solve_rows(study, quantities, two_rows(study), 1);
  const RowResponses three = solve_rows(study, quantities, two_rows(study), 3);
  REQUIRE(one.values.size() == quantities.size());
  for (std::size_t q = 0; q < quantities.size(); ++q) {
    INFO(one.variables[q].name);
    REQUIRE(one.values[q].size() == 1200);
    for (std::size_t i = 0; i < 1200; ++i) {
      if (one.values[q][i] == one.values[q][i] || three.values[q][i] == three.values[q][i])
        REQUIRE(one.values[q][i] == three.values[q][i]);
    }
  }
}

TEST_CASE("the last axis of rows in memory runs fastest and each point has its own values") {
  const Study study = swept();
  const std::vector<periodic::Quantity> peak = quantities_called(study, {"main_peak"});
  const RowResponses rows = solve_rows(study, peak, two_rows(study), 2);
  RowSolver alone(study, study.network, study.values, peak, study.orbits_wanted());
  for (const std::size_t point : {0, 400, 599, 600, 1199}) {
    std::vector<double> parameters = study.parameters.nominal();
    parameters[*study.parameters.find("f")] = point < 600 ? 0.0 : 0.3;
    parameters[*study.parameters.find("r")] = 0.5 + 0.0015 * static_cast<double>(point % 600);
    constexpr double two_ways = 1e-9;  // phases and shooting, which stops at 1e-12
    CHECK_THAT(rows.values[0][point], Catch::WithinRel(alone.solve_alone(parameters)[0], two_ways));
  }
}

TEST_CASE("rows that are asked to stop have no value where nothing was computed") {
  const Study study = swept();
  const RowResponses none = solve_rows(study, quantities_called(study, {"main_peak", "status"}),
                                       two_rows(study), 1, [] { return true; });
  for (const double value : none.values[0]) CHECK(value != value);
  for (const double value : none.values[1]) CHECK(value == 0.0);
}

TEST_CASE("quantities are called by names and patterns and unknown ones get the nearest name") {
  const Study study = swept();
  CHECK(quantities_called(study, {"main_*", "main_peak"}).size() > 2);
  CHECK(quantities_called(study, {"main_peak", "*_peak"}).size() == 2);  // and the status
  try {
    quantities_called(study, {"main_pek"});
    FAIL("not refused");
  } catch (const StudyError& error) {
    CHECK(error.rule() == rules::unknown_name);
    CHECK_THAT(error.what(), Catch::Contains("did you mean \"main_peak\""));
  }
}

}  // namespace
}  // namespace response_rows_test
