#include "studies/motion/measurements.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "studies/motion/one_motion.hpp"
#include "studies/program/data_export.hpp"
#include "studies/reading/parse_study.hpp"

namespace measurements_test {
namespace {

using namespace frahm::studies;

constexpr double kRounding = 1e-11;  // of the largest value of a column
constexpr double kMass = 2.0, kDamping = 3.0, kStiffness = 800.0, kFriction = 1.5;

const std::string system_text = R"(
[[mass]]
name = "cart"
mass = 2.0
[[element]]
name = "spring"
type = "spring"
between = ["ground", "cart"]
stiffness = 800.0
[[element]]
name = "damper"
type = "damper"
between = ["ground", "cart"]
damping = 3.0
[[element]]
name = "guide"
type = "coulomb"
between = ["ground", "cart"]
force = 1.5
)";

Study decay() {
  return parse_study("[study]\nschema = 1\nkind = \"decay\"\n" + system_text +
                         "[decay]\nduration = 1.5\n[[initial]]\nnode = \"cart\"\ndisplacement = 0.05\n",
                     "cart.toml");
}

Study sweep() {
  return parse_study("[study]\nschema = 1\nkind = \"sweep\"\n[parameters]\nomega = 18\n" + system_text +
                         "[excitation]\nfrequency = \"omega\"\n[[excitation.force]]\non = \"cart\"\n"
                         "amplitude = 8\n[[axis]]\nparameter = \"omega\"\nvalues = [18, 20]\n",
                     "cart.toml");
}

// By the equation of motion, sliding: m a = P - c v - k x - F sgn v. Where it sticks a = 0.
double acceleration_by_forces(double force, double x, double v) {
  const double rest = force - kStiffness * x;
  if (v == 0.0 && std::abs(rest) <= kFriction) return 0.0;
  const double friction = v != 0.0 ? std::copysign(kFriction, v) : std::copysign(kFriction, rest);
  return (rest - kDamping * v - friction) / kMass;
}

TEST_CASE("measured accelerations obey the equation of motion, in a decay up to rest") {
  const Measurements data = measure(
      decay(), {}, {.rate = 1000.0, .columns = {"cart_displacement", "cart_velocity", "cart_acceleration"}});
  REQUIRE(data.time.size() == 1501);
  CHECK(data.time.back() == 1.5);
  const auto &x = data.columns[0].values, &v = data.columns[1].values, &a = data.columns[2].values;
  CHECK(x.front() == 0.05);
  const double scale = kStiffness * 0.05 / kMass;
  std::size_t at_rest = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    INFO("t = " << data.time[i]);
    CHECK_THAT(a[i], Catch::WithinAbs(acceleration_by_forces(0.0, x[i], v[i]), kRounding * scale));
    at_rest += v[i] == 0.0 ? 1 : 0;
  }
  CHECK(at_rest > 100);  // so that rest is among what was looked at
}

TEST_CASE("a periodic response is measured at any rate, with its forces") {
  const Study study = sweep();
  const std::vector<double> at = study.parameters.nominal();
  const Measurements data = measure(study, at,
                                    {.rate = 317.0,
                                     .duration = 3.0,
                                     .columns = {"cart_displacement", "cart_velocity", "cart_acceleration",
                                                 "spring_force", "guide_force"}});
  REQUIRE(data.time.size() == 952);
  const auto &x = data.columns[0].values, &v = data.columns[1].values, &a = data.columns[2].values;
  for (std::size_t i = 0; i < x.size(); ++i) {
    INFO("t = " << data.time[i]);
    const double force = 8.0 * std::cos(18.0 * data.time[i]);
    CHECK_THAT(a[i], Catch::WithinAbs(acceleration_by_forces(force, x[i], v[i]), 1e-9 * kStiffness));
    CHECK_THAT(data.columns[3].values[i], Catch::WithinAbs(kStiffness * x[i], kRounding));
    CHECK_THAT(data.columns[4].values[i], Catch::WithinAbs(std::copysign(kFriction, v[i]), kRounding));
  }
}

TEST_CASE("noise has the size that was asked for, is the same for a seed and another for another") {
  const auto with = [](SensorNoise noise) {
    return measure(decay(), {}, {.rate = 2000.0, .noise = noise, .columns = {}}).columns[0].values;
  };
  const std::vector<double> clean = with({}), noisy = with({.absolute = 1e-3, .seed = 5});
  CHECK(noisy == with({.absolute = 1e-3, .seed = 5}));
  CHECK(noisy != with({.absolute = 1e-3, .seed = 6}));
  double mean = 0.0, square = 0.0;
  const auto n = static_cast<double>(clean.size());
  for (std::size_t i = 0; i < clean.size(); ++i) {
    mean += (noisy[i] - clean[i]) / n;
    square += (noisy[i] - clean[i]) * (noisy[i] - clean[i]) / n;
  }
  // Four standard errors of the mean and of the standard deviation of so many samples.
  CHECK(std::abs(mean) < 4.0 * 1e-3 / std::sqrt(n));
  CHECK_THAT(std::sqrt(square), Catch::WithinRel(1e-3, 4.0 / std::sqrt(2.0 * n)));

  double spread = 0.0, average = 0.0;
  for (const double value : clean) average += value / n;
  for (const double value : clean) spread += (value - average) * (value - average) / n;
  const std::vector<double> shared = with({.share = 0.01, .seed = 5});
  for (std::size_t i = 0; i < clean.size(); i += 100) {
    CHECK_THAT((shared[i] - clean[i]) * 1e-3,
               Catch::WithinAbs((noisy[i] - clean[i]) * 0.01 * std::sqrt(spread), 1e-12 * 0.05));
  }
}

TEST_CASE("what cannot be measured is refused with what can") {
  const MeasurementOptions of_nothing{.rate = 100.0, .columns = {"cart_acceleratio"}};
  CHECK_THROWS_WITH(
      measure(decay(), {}, of_nothing),
      Catch::Contains("nothing is called \"cart_acceleratio\"; did you mean \"cart_acceleration\"?"));
  CHECK_THROWS_WITH(measure(decay(), {}, {.rate = 1e9, .columns = {}}),
                    Catch::Contains("must be from 2 to ten million"));
}

}  // namespace
}  // namespace measurements_test
