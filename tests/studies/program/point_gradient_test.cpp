#include "studies/program/point_gradient.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "solvers/orbits/closed_forms.hpp"
#include "studies/program/point_command.hpp"
#include "studies/reading/parse_study.hpp"
#include "studies/reading/settings.hpp"
#include "studies/reading/study/study.hpp"
#include "tests/study_path.hpp"

namespace point_gradient_test {
namespace {

using frahm::periodic::DerivativeCheck;
using frahm::studies::gradient_at;
using frahm::studies::point_command;
using frahm::studies::PointGradient;
using frahm::studies::PointOptions;
using frahm::studies::Study;

constexpr double kDifference = 1e-6;  // of exact derivatives and differences, relative
constexpr double kClosedForm = 1e-9;

PointGradient gradient_of(const Study& study, const std::vector<std::string>& at) {
  return gradient_at(study, frahm::studies::parameters_at(study, at));
}

const DerivativeCheck& derivative(const PointGradient& gradient, const std::string& quantity,
                                  const std::string& parameter) {
  for (const PointGradient::By& by : gradient.by) {
    if (by.parameter != parameter) continue;
    for (std::size_t i = 0; i < by.derivatives.size(); ++i) {
      if (gradient.quantities[i].name == quantity) return by.derivatives[i];
    }
  }
  throw std::runtime_error("no derivative of " + quantity + " by " + parameter);
}

std::string tell(const PointOptions& options) {
  std::ostringstream out;
  CHECK(point_command(options, out) == 0);
  return out.str();
}

TEST_CASE(
    "A study's derivatives by its parameters go through its expressions and have the parameter's unit") {
  const Study study = frahm::studies::read_study(study_path("rig_atlas"));
  const PointGradient gradient = gradient_of(study, {"omega=250 rpm", "I=6.36", "FP=0.05"});
  CHECK(gradient.reason.empty());
  std::vector<std::string> names;
  for (const PointGradient::By& by : gradient.by) names.push_back(by.parameter + " " + by.unit);
  CHECK(names == std::vector<std::string>{"omega rad s-1", "I kg", "FP 1", "K N m-1", "A m"});
  for (const char* parameter : {"omega", "I", "FP", "K", "A"}) {
    for (const char* quantity : {"main_peak", "tmd_rms", "tmd_spring_stroke", "guide_energy"}) {
      INFO(quantity << " by " << parameter);
      CHECK(derivative(gradient, quantity, parameter).relative_difference() < kDifference);
    }
  }
}

TEST_CASE("The one mass's derivative by its friction is that of Den Hartog's formula") {
  const Study study = frahm::studies::read_study(study_path("den_hartog"));
  const PointGradient gradient = gradient_of(study, {"r=0.9", "f=0.1"});
  const auto [V, G, H] = frahm::periodic::den_hartog_functions(0.9, 0.05);
  const double exact = -H * H * 0.1 / std::sqrt(V * V - H * H * 0.01) - G;
  CHECK(derivative(gradient, "main_amplitude", "f").exact == Approx(exact).epsilon(kClosedForm));
}

TEST_CASE("A frequency that no parameter sets has derivatives of its own") {
  const Study study = frahm::studies::parse_study(R"([study]
schema = 1
kind = "sweep"
units = "dimensionless"
[parameters]
c = 0.1
[[mass]]
name = "m"
mass = 1
[[element]]
name = "k"
type = "spring"
between = ["ground", "m"]
stiffness = 1
[[element]]
name = "d"
type = "damper"
between = ["ground", "m"]
damping = "c"
[excitation]
frequency = 0.8
[[excitation.force]]
on = "m"
amplitude = 1
[[axis]]
parameter = "c"
values = [0.1, 0.2]
)",
                                                  "fixed.toml");
  const PointGradient gradient = gradient_of(study, {});
  // V^-2 = (1 - r^2)^2 + (c r)^2
  const double r = 0.8, c = 0.1, V = 1.0 / std::hypot(1.0 - r * r, c * r);
  const double by_r = -0.5 * V * V * V * (-4.0 * r * (1.0 - r * r) + 2.0 * c * c * r);
  CHECK(derivative(gradient, "m_peak", "excitation.frequency").exact == Approx(by_r).epsilon(kClosedForm));
  CHECK(derivative(gradient, "m_peak", "c").exact == Approx(-V * V * V * c * r * r).epsilon(kClosedForm));
}

TEST_CASE("A point tells its derivatives, exact, by differences and how far they are apart") {
  PointOptions options{.study = study_path("den_hartog"), .at = {"r=0.9", "f=0.1"}, .gradient = true};
  const std::string text = tell(options);
  CHECK(text.find("Derivatives with respect to parameters in SI units") != std::string::npos);
  CHECK(text.find("\nby f ") != std::string::npos);
  CHECK(text.find("by differences") != std::string::npos);
  options.json = true;
  const std::string json = tell(options);
  CHECK(json.find("\"gradient\": {") != std::string::npos);
  CHECK(json.find("\"relative_difference\": ") != std::string::npos);
  options.gradient = false;
  CHECK(tell(options).find("\"gradient\"") == std::string::npos);
}

TEST_CASE("At grazing a point says why it has no derivatives") {
  const double f = (1.0 - 1e-11) * frahm::periodic::critical_friction(0.22, 0.05);
  std::ostringstream friction;
  friction.precision(17);
  friction << "f=" << f;
  const std::string text =
      tell({.study = study_path("den_hartog"), .at = {"r=0.22", friction.str()}, .gradient = true});
  CHECK(text.find("status grazing") != std::string::npos);
  CHECK(text.find("  none: grazing") != std::string::npos);
  CHECK(text.find("by differences") == std::string::npos);
}

}  // namespace
}  // namespace point_gradient_test
