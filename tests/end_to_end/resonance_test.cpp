// Resonance and half-power frequencies along the frequency axis: [output] resonances.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "tests/end_to_end/runs.hpp"

namespace resonance_test {
namespace {

using Columns = std::map<std::string, std::vector<double>>;
constexpr double solved = 1e-10;

// The columns of /resonance after a run of this study.
Columns resonances_of(const std::string& text) {
  const runs::Folder folder;
  const runs::Outcome run =
      runs::frahm({"run", folder.write("study.toml", text), "-o", folder / "study.h5", "--threads", "1"});
  INFO(run.err);
  REQUIRE(run.code == 0);
  Columns columns;
  for (const auto& column : frahm::results::MapReader(folder / "study.h5").columns("resonance")) {
    columns[column.variable.name] = column.values;
  }
  return columns;
}

TEST_CASE("lecture_hysteretic.toml: the resonance is at omega_n exactly whatever eta, and 1/eta high") {
  const Columns columns = resonances_of(runs::reduced("lecture_hysteretic", {{"r", 60}}));
  const auto& eta = columns.at("eta");
  REQUIRE(eta.size() == 6);
  for (std::size_t i = 0; i < eta.size(); ++i) {
    INFO("eta " << eta[i]);
    CHECK_THAT(columns.at("main_resonance_frequency")[i], Catch::WithinAbs(1.0, solved));
    CHECK_THAT(columns.at("main_resonance_amplitude")[i] * eta[i], Catch::WithinAbs(1.0, solved));
    CHECK_THAT(columns.at("main_half_power_high")[i], Catch::WithinAbs(std::sqrt(1.0 + eta[i]), solved));
    if (eta[i] < 0.9) {
      CHECK_THAT(columns.at("main_half_power_low")[i], Catch::WithinAbs(std::sqrt(1.0 - eta[i]), solved));
    }
  }
}

TEST_CASE("The resonances are exported as a table of their own") {
  const runs::Folder folder;
  const std::string study = folder.write("study.toml", runs::reduced("lecture_hysteretic", {{"r", 20}}));
  REQUIRE(runs::frahm({"run", study, "-o", folder / "study.h5"}).code == 0);
  const runs::Outcome table = runs::frahm({"export", folder / "study.h5", "--group", "resonance", "-o", "-"});
  CHECK(table.code == 0);
  CHECK(table.out.starts_with("eta,main_resonance_frequency,main_resonance_amplitude,"));
  CHECK(std::count(table.out.begin(), table.out.end(), '\n') == 7);
  CHECK(runs::frahm({"export", folder / "study.h5", "--group", "orbits", "-o", "-"}).code == 2);
}

TEST_CASE("Resonances and modes are recorded in the unit of the frequency's axis") {
  const runs::Folder folder;
  const std::string study = folder.write(
      "study.toml",
      "[study]\nschema = 1\nkind = \"sweep\"\n[parameters]\nw = 1\n[[mass]]\nname = \"m\"\nmass = 1\n"
      "[[element]]\nname = \"s\"\ntype = \"spring\"\nbetween = [\"ground\", \"m\"]\nstiffness = 1e4\n"
      "[[element]]\nname = \"d\"\ntype = \"damper\"\nbetween = [\"ground\", \"m\"]\ndamping = 10\n"
      "[excitation]\nfrequency = \"w\"\n[[excitation.force]]\non = \"m\"\namplitude = 1\n"
      "[[axis]]\nparameter = \"w\"\nunit = \"Hz\"\nfrom = 10\nto = 20\npoints = 21\n"
      "[output]\nresonances = [\"m\"]\n");
  REQUIRE(runs::frahm({"run", study, "-o", folder / "study.h5"}).code == 0);
  const auto exported = [&](const char* group) {
    return runs::frahm({"export", folder / "study.h5", "--group", group, "-o", "-"}).out;
  };
  const double hertz = 100.0 / (2.0 * std::acos(-1.0)), zeta = 0.05;
  const std::string resonance = exported("resonance"), modes = exported("modes");
  CHECK(resonance.starts_with(
      "m_resonance_frequency [Hz],m_resonance_amplitude [m],m_half_power_low [Hz],m_half_power_high [Hz],"));
  CHECK_THAT(std::stod(resonance.substr(resonance.find('\n') + 1)),
             Catch::WithinAbs(hertz * std::sqrt(1.0 - 2.0 * zeta * zeta), 1e-6));
  CHECK(modes.starts_with("mode,mode_frequency [Hz],"));
  CHECK_THAT(std::stod(modes.substr(modes.find("\n1,") + 3)), Catch::WithinAbs(hertz, 1e-9));
}

TEST_CASE("A viscous resonance is at sqrt(1 - 2 zeta^2), and there is none above zeta = 0.707") {
  std::string text = runs::reduced("lecture_isolation", {});
  text = runs::replaced(text, "[output]\n", "[output]\nresonances = [\"machine\"]\n");
  const Columns columns = resonances_of(text);
  const auto& zeta = columns.at("zeta");
  REQUIRE(zeta.size() >= 4);
  int with_peak = 0;
  for (std::size_t i = 0; i < zeta.size(); ++i) {
    INFO("zeta " << zeta[i]);
    const double square = 1.0 - 2.0 * zeta[i] * zeta[i];
    if (square < 0.0) {
      CHECK(std::isnan(columns.at("machine_resonance_frequency")[i]));
      continue;
    }
    ++with_peak;
    const double spread = 2.0 * zeta[i] * std::sqrt(1.0 - zeta[i] * zeta[i]);
    CHECK_THAT(columns.at("machine_resonance_frequency")[i], Catch::WithinAbs(std::sqrt(square), solved));
    CHECK_THAT(columns.at("machine_half_power_high")[i],
               Catch::WithinAbs(std::sqrt(square + spread), solved));
  }
  CHECK(with_peak >= 2);
}

TEST_CASE("identification_response.toml: the solved half-power points are those of the closed form") {
  const std::string text = runs::reduced("identification_response", {});
  const Columns columns = resonances_of(text);
  const auto& f_n = columns.at("f_n");
  REQUIRE(f_n.size() == 11);
  for (std::size_t i = 0; i < f_n.size(); ++i) {
    INFO("row " << i);
    const double resonance = columns.at("main_resonance_frequency")[i] / f_n[i];  // both in Hz
    const double zeta = std::sqrt(0.5 * (1.0 - resonance * resonance));
    const double spread = 2.0 * zeta * std::sqrt(1.0 - zeta * zeta);
    CHECK_THAT(columns.at("main_half_power_low")[i] / f_n[i],
               Catch::WithinAbs(std::sqrt(resonance * resonance - spread), 1e-8));
    CHECK_THAT(columns.at("main_half_power_high")[i] / f_n[i],
               Catch::WithinAbs(std::sqrt(resonance * resonance + spread), 1e-8));
    CHECK_THAT(columns.at("main_resonance_amplitude")[i], Catch::WithinRel(1e-3 / spread, 1e-8));
  }
}

TEST_CASE("With friction the resonance is that of the harmonic component, below the linear one") {
  const Columns columns =
      resonances_of(runs::reduced("rig_without_absorber", {}) + "\n[output]\nresonances = [\"main\"]\n");
  const auto& share = columns.at("FP");
  const auto& amplitude = columns.at("main_resonance_amplitude");
  REQUIRE(share.size() > 2);
  for (std::size_t i = 1; i < share.size(); ++i) {
    INFO("F/P " << share[i]);
    CHECK(amplitude[i] < amplitude[i - 1]);
    CHECK(columns.at("main_half_power_low")[i] < columns.at("main_resonance_frequency")[i]);
    CHECK(columns.at("main_resonance_frequency")[i] < columns.at("main_half_power_high")[i]);
  }
}

TEST_CASE("An unbounded resonance is infinite, has no half-power points, and friction above pi/4 bounds it") {
  std::string text = runs::reduced("den_hartog", {});
  text = text.substr(0, text.find("[[axis]]")) +
         "[[axis]]\nparameter = \"zeta\"\nvalues = [0]\n"
         "[[axis]]\nparameter = \"f\"\nvalues = [0, 0.5, 0.78, 0.79, 0.9]\n"
         "[[axis]]\nparameter = \"r\"\nfrom = 0.3\nto = 3\npoints = 80\n"
         "[output]\nresonances = [\"main\"]\n";
  const Columns columns = resonances_of(text);
  const auto& f = columns.at("f");
  REQUIRE(f.size() == 5);
  for (std::size_t i = 0; i < f.size(); ++i) {
    INFO("f " << f[i] << ": " << columns.at("main_resonance_amplitude")[i]);
    const bool unbounded = f[i] < 0.25 * 3.14159265358979;
    // With friction nothing contracts so close to the resonance: no orbit is found there, and no height.
    CHECK(std::isfinite(columns.at("main_resonance_amplitude")[i]) != unbounded);
    if (f[i] == 0.0) CHECK(std::isinf(columns.at("main_resonance_amplitude")[i]));
    CHECK(std::isnan(columns.at("main_half_power_damping")[i]) == unbounded);
    if (unbounded) CHECK_THAT(columns.at("main_resonance_frequency")[i], Catch::WithinAbs(1.0, 1e-6));
  }
}

}  // namespace
}  // namespace resonance_test
