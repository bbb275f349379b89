#include "studies/page/crank_motion.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "studies/reading/parse_study.hpp"
#include "tests/study_path.hpp"

namespace frahm::studies::crank_motion_test {
namespace {

const results::Column& column(const std::vector<results::Column>& columns, const std::string& name) {
  for (const auto& each : columns) {
    if (each.variable.name == name) return each;
  }
  throw std::invalid_argument("no column " + name);
}

TEST_CASE("The rig's crank over a turn, and its Taylor errors of 0.0323, 4.93e-4 and 1.50e-5 of l_AC") {
  const auto columns = crank_motions(read_study(study_path("rig_crank")));
  CHECK_NOTHROW(results::check(columns));
  CHECK(columns.size() == 8);
  for (const auto& each : columns) {
    INFO(each.variable.name);
    CHECK(each.dimension == "angle");
    CHECK(each.values.size() == kCrankAngles);
  }
  const auto& angle = column(columns, "angle");
  CHECK(angle.variable.unit == "rad");
  CHECK(angle.values.front() == 0.0);
  CHECK(angle.values.back() == 2.0 * std::numbers::pi);

  constexpr double radius = 0.02955, rod = 0.12;  // [m]
  constexpr double kRoundingOfRod = 1e-16;        // [m]
  const auto& motion = column(columns, "exciter_motion");
  CHECK(motion.variable.unit == "m");
  CHECK_THAT(motion.values[90], Catch::WithinAbs(radius, kRoundingOfRod));  // stretched
  CHECK_THAT(motion.values[0],
             Catch::WithinAbs(std::sqrt(rod * rod - radius * radius) - rod, kRoundingOfRod));

  const struct {
    std::string order;
    double error, last_digit;
  } printed[] = {{"1", 0.0323, 1e-4}, {"2", 4.93e-4, 1e-6}, {"4", 1.50e-5, 1e-7}};
  for (const auto& cut : printed) {
    const auto& error = column(columns, "exciter_taylor_" + cut.order + "_error");
    CHECK(error.variable.unit == "1");
    const auto worst = std::max_element(error.values.begin(), error.values.end());
    INFO("order " << cut.order << ": " << *worst);
    CHECK(std::abs(*worst - cut.error) < 0.5 * cut.last_digit);
    const auto i = static_cast<std::size_t>(worst - error.values.begin());
    const double missing = column(columns, "exciter_taylor_" + cut.order).values[i] - motion.values[i];
    CHECK_THAT(std::abs(missing) / (rod + motion.values[i]), Catch::WithinRel(*worst, 1e-14));
  }
}

TEST_CASE("A study without a crank has no crank motion") {
  CHECK(crank_motions(read_study(study_path("rig_atlas"))).empty());
  CHECK(crank_motions(read_study(study_path("rig_decay_main"))).empty());
}

TEST_CASE("Two cranks on one node, without units, have names of their own") {
  const std::string crank = "[[excitation.motion]]\nnode = \"slider\"\nprofile = \"crank\"\ncrank = ";
  const auto columns = crank_motions(parse_study(
      "[study]\nschema = 1\nkind = \"transient\"\nunits = \"dimensionless\"\n"
      "[[mass]]\nname = \"x\"\nmass = 1\n"
      "[[element]]\nname = \"spring\"\ntype = \"spring\"\nbetween = [\"slider\", \"x\"]\nstiffness = 1\n"
      "[excitation]\nfrequency = 1\n" +
          crank + "0.2\nrod = 1\n" + crank + "0.5\nrod = 1\n[transient]\nduration = 1\n",
      "two_cranks.toml"));
  CHECK_NOTHROW(results::check(columns));
  CHECK(column(columns, "slider_motion").values[90] == Approx(0.2).epsilon(1e-15));
  CHECK(column(columns, "slider_2_motion").values[90] == Approx(0.5).epsilon(1e-15));
  CHECK(column(columns, "slider_motion").variable.unit == "1");
  CHECK(column(columns, "angle").variable.unit == "rad");
}

}  // namespace
}  // namespace frahm::studies::crank_motion_test
