#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "studies/map/map_plan.hpp"
#include "studies/motion/one_motion.hpp"
#include "studies/program/modes_table.hpp"
#include "studies/provenance/files_read.hpp"
#include "studies/provenance/fingerprint.hpp"
#include "studies/reading/parse_study.hpp"
#include "studies/reading/study/series_text.hpp"
#include "studies/reading/study/study.hpp"
#include "tests/studies/temporary_folder.hpp"

// Forces and motions of supports by corners, in transients and as a period.
namespace corner_test {
namespace {

using namespace frahm::studies;
using frahm::mechanics::ExcitationKind;
using frahm::transient::Record, frahm::transient::RecordOf;

constexpr double rounding = 1e-14;
constexpr double pi = std::numbers::pi;

const std::string floor_on_base =
    "[parameters]\ns = 2\nomega = { value = 4, unit = \"rad/s\" }\n[[mass]]\nname = \"floor\"\nmass = 2\n"
    "[[element]]\nname = \"columns\"\ntype = \"spring\"\nbetween = [\"base\", \"floor\"]\nstiffness = 800\n";

Study transient(const std::string& excitation) {
  return parse_study("[study]\nschema = 1\nkind = \"transient\"\n" + floor_on_base + "[excitation]\n" +
                         excitation + "[transient]\n",
                     "study.toml");
}

std::string text_of_sweep(const std::string& excitation) {
  return "[study]\nschema = 1\nkind = \"sweep\"\n" + floor_on_base + "[excitation]\nfrequency = \"omega\"\n" +
         excitation + "[[axis]]\nparameter = \"omega\"\nvalues = [4, 5]\n";
}

std::string motion(const std::string& keys) {
  return "[[excitation.motion]]\nnode = \"base\"\n" + keys + "\n";
}

TEST_CASE("Corners of a transient are a record in SI, which a scale multiplies, and the motion's duration") {
  const Study study = transient(motion(
      "velocity = [[0, 0], [{ value = 500, unit = \"ms\" }, { value = 100, unit = \"mm/s\" }], [0.5, 3]]"
      "\nscale = \"2*s\""));
  REQUIRE(study.transient()->records.size() == 1);
  const DrivingRecord& driving = study.transient()->records[0];
  CHECK(study.network.excitations[driving.excitation].kind == ExcitationKind::recorded_motion);
  CHECK(stated(study, study.values.amplitude[driving.excitation]) == 4.0);
  const Record& record = driving.records.at(0);
  CHECK(record.of == RecordOf::velocity);
  CHECK(record.time == std::vector<double>{0.0, 0.5, 0.5});
  CHECK(record.values == std::vector<double>{0.0, 0.1, 3.0});
  CHECK(forced_options(study).duration == 0.5);
  CHECK(study.values.series.empty());
}

TEST_CASE("Several lists of corners and a constant move one support together") {
  const Study study =
      transient(motion("displacement = [[0, 0], [1, 2]]") + motion("acceleration = [[0, 3], [2, 3]]") +
                motion("amplitude = 0.5\norder = 0"));
  REQUIRE(study.transient()->records.size() == 2);
  const auto motion = solve_transient(study);
  // x'' = 400 (y - x), y = 1/2 + 2 t + 3 t^2/2 until 1:  x = y - 3/400 + A cos 20 t + B sin 20 t.
  REQUIRE(motion.history.time.at(500) == 1.0);
  const double expected = 4.0 - 0.0075 - 0.4925 * std::cos(20.0) - 0.1 * std::sin(20.0);
  CHECK(std::abs(motion.history.displacement[0][500] - expected) < 1e-12);
  CHECK(motion.failure.empty());
  CHECK(motion.energy.balance < 1e-12);
}

TEST_CASE("A period of corners is its Fourier series, with the orders that it has") {
  // A triangle of 3 mm: 8/(pi n)^2 of odd orders n.
  const Study study =
      parse_study(text_of_sweep(motion(
                      "displacement = [[0, 0], [1, { value = 3, unit = \"mm\" }], [3, { value = -3, unit = "
                      "\"mm\" }], [4, 0]]\norders = 7\nscale = \"s\"\nphase = 0.3")),
                  "study.toml");
  const auto values = stated_values(study);
  REQUIRE(study.network.excitations.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    const int n = 2 * static_cast<int>(i) + 1;
    CHECK(study.network.excitations[i].kind == ExcitationKind::motion);
    CHECK(study.network.excitations[i].order == n);
    CHECK(std::abs(values.excitation[i].amplitude - 2.0 * 3e-3 * 8.0 / (pi * pi * n * n)) < 6e-3 * rounding);
    // sin(n theta) = cos(n theta - pi/2), with alternating signs.
    const double phase = (i % 2 == 0 ? -0.5 : 0.5) * pi + 0.3 * n;
    CHECK(std::abs(std::remainder(values.excitation[i].phase - phase, 2.0 * pi)) < 100.0 * rounding);
  }
  REQUIRE(study.values.series.size() == 1);
  const PeriodSeries& series = study.values.series[0];
  CHECK(series.harmonics == 4);
  CHECK(series_texts(study.values)[0] ==
        "motion of \"base\": Fourier series to order 7, 4 of them not zero; 1.8 % of its root mean square is "
        "left out");
}

TEST_CASE("A period of a velocity is that of the displacement that it integrates to, at every frequency") {
  // v = 1 over the first half of the period T = 2 pi/omega, then -1: a triangle from -T/4 to T/4.
  for (const double omega : {4.0, 7.0}) {
    const double height = 2.0 * pi / omega / 4.0;
    const auto of = [&](const std::string& keys) {
      std::string text = text_of_sweep(motion(keys + "\norders = 9"));
      text.replace(text.find("value = 4"), 9, "value = " + std::to_string(omega));
      return parse_study(text, "study.toml");
    };
    const Study velocity = of("velocity = [[0, 1], [1, 1], [1, -1], [2, -1]]");
    const Study displacement = of("displacement = [[0, -1], [1, 1], [2, -1]]");
    const Study acceleration = of("acceleration = [[0, 1], [1, -1], [2, 1]]");
    const auto v = stated_values(velocity), y = stated_values(displacement), a = stated_values(acceleration);
    REQUIRE(v.excitation.size() == 5);
    REQUIRE(y.excitation.size() == 5);
    REQUIRE(a.excitation.size() == 5);
    for (std::size_t i = 0; i < 5; ++i) {
      const double rate = omega * (2.0 * static_cast<double>(i) + 1.0);
      INFO("omega " << omega << ", order " << rate / omega);
      CHECK(std::abs(v.excitation[i].amplitude - height * y.excitation[i].amplitude) < rounding);
      CHECK(std::abs(std::remainder(v.excitation[i].phase - y.excitation[i].phase, 2.0 * pi)) < rounding);
      // The triangle upside down as an acceleration: y'' = a.
      CHECK(std::abs(a.excitation[i].amplitude - y.excitation[i].amplitude / (rate * rate)) < rounding);
      CHECK(std::abs(std::remainder(a.excitation[i].phase - y.excitation[i].phase, 2.0 * pi)) < rounding);
    }
  }
}

TEST_CASE("The mean of a force is a constant load, that of a displacement a place") {
  const std::string excitation =
      motion("displacement = [[0, 1], [1, 3], [2, 1]]\norders = 3") +
      "[[excitation.force]]\non = \"floor\"\nforce = [[0, 0], [1, 6], [1, 0], [2, 0]]\norders = 2\n";
  const Study study = parse_study(text_of_sweep(excitation), "study.toml");
  const auto values = stated_values(study);
  const auto constant_of = [&](ExcitationKind kind) {
    for (std::size_t i = 0; i < values.excitation.size(); ++i) {
      const auto& component = study.network.excitations[i];
      if (component.kind == kind && component.order == 0)
        return values.excitation[i].amplitude * std::cos(values.excitation[i].phase);
    }
    return std::nan("");
  };
  CHECK(std::abs(constant_of(ExcitationKind::motion) - 2.0) < rounding);
  CHECK(std::abs(constant_of(ExcitationKind::force) - 1.5) < rounding);
}

TEST_CASE("Other corners are another study, the same in other units are not") {
  const auto of = [](const std::string& corners) {
    return plan_map(parse_study(text_of_sweep(motion("displacement = " + corners)), "study.toml"), {})
        .fingerprint;
  };
  const auto first = of("[[0, 0], [1, 0.003], [2, 0]]");
  CHECK(first == of("[[0, 0], [1, { value = 3, unit = \"mm\" }], [2, 0]]"));
  CHECK(first.physics != of("[[0, 0], [1, 0.004], [2, 0]]").physics);
  CHECK(first.physics != of("[[0, 0], [0.5, 0.003], [2, 0]]").physics);
}

// profile = "file".
struct OfFile {
  TemporaryFolder folder;
  Study sweep(const std::string& csv, const std::string& keys) const {
    folder.write("drive.csv", csv);
    return parse_study(text_of_sweep(motion("profile = \"file\"\nfile = \"drive.csv\"\n" + keys)),
                       folder / "study.toml");
  }
};

TEST_CASE("A period from a file is that of the corners at its rows, wherever its time begins") {
  const OfFile of;
  const Study study =
      of.sweep("t [ms],y [mm]\n5,0\n6,3\n8,-3\n9,0\n", "orders = 7\nphase = 0.3\nscale = \"s\"\n");
  const Study same =
      parse_study(text_of_sweep(motion("displacement = [[0, 0], [1, 3e-3], [3, -3e-3], [4, 0]]\norders = 7\n"
                                       "phase = 0.3\nscale = \"s\"")),
                  "study.toml");
  const auto a = stated_values(study), b = stated_values(same);
  REQUIRE(a.excitation.size() == 4);
  REQUIRE(b.excitation.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(study.network.excitations[i].order == same.network.excitations[i].order);
    CHECK(std::abs(a.excitation[i].amplitude - b.excitation[i].amplitude) < 6e-3 * rounding);
    CHECK(std::abs(std::remainder(a.excitation[i].phase - b.excitation[i].phase, 2.0 * pi)) <
          100.0 * rounding);
  }
  CHECK(series_texts(study.values) == series_texts(same.values));
}

TEST_CASE("The mean of a measured acceleration is left out, and said so") {
  // In g: a triangle from 0 to 0.2 g about its mean 0.1 g, 4/(pi n)^2 of odd orders n.
  const OfFile of;
  const Study study =
      of.sweep("t,a\n0,0\n1,0.2\n2,0\n", "quantity = \"acceleration\"\nunit = \"g\"\norders = 3\n");
  const auto values = stated_values(study);
  REQUIRE(values.excitation.size() == 2);
  const double g = 9.80665, rate = 4.0;
  CHECK(std::abs(values.excitation[0].amplitude - 0.1 * g * 8.0 / (pi * pi) / (rate * rate)) < rounding);
  CHECK(std::abs(values.excitation[1].amplitude - 0.1 * g * 8.0 / (9.0 * pi * pi) / (9.0 * rate * rate)) <
        rounding);
  CHECK(series_texts(study.values)[0] ==
        "motion of \"base\": Fourier series to order 3, 2 of them not zero; 4.8 % of its root mean square is "
        "left out, and its mean, 0.981 m/s2");
}

TEST_CASE("A changed file of a period is another study, and no result of it is read with another file") {
  const OfFile of;
  const std::string before = "t,y\n0,0\n1,2\n2,0\n", after = "t,y\n0,0\n1,3\n2,0\n";
  const Study study = of.sweep(before, "");
  const std::string files = files_read(study);
  const auto first = plan_map(study, {}).fingerprint;
  CHECK(first == plan_map(of.sweep(before, ""), {}).fingerprint);
  refuse_changed_files(of.sweep(before, ""), files, "result.h5");
  const Study changed = of.sweep(after, "");
  CHECK(first.physics != plan_map(changed, {}).fingerprint.physics);
  CHECK_THROWS_WITH(refuse_changed_files(changed, files, "result.h5"),
                    Catch::Contains("motion of \"base\"") && Catch::Contains("drive.csv"));
}

}  // namespace
}  // namespace corner_test
