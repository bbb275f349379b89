#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "studies/map/map_plan.hpp"
#include "studies/motion/one_motion.hpp"
#include "studies/provenance/study_plan.hpp"
#include "studies/reading/parse_study.hpp"
#include "studies/reading/study/study.hpp"

namespace motion_study_test {
namespace {

using namespace frahm::studies;
constexpr double rounding = 1e-14;  // a few roundings of double arithmetic

const std::string network =
    "[parameters]\nx_0 = { value = 30, unit = \"mm\" }\nomega = { value = 120, unit = \"rpm\" }\n"
    "[[mass]]\nname = \"a\"\nmass = 2\n[[mass]]\nname = \"b\"\nmass = 1\n"
    "[[element]]\nname = \"spring\"\ntype = \"spring\"\nbetween = [\"ground\", \"a\"]\nstiffness = 800\n"
    "[[element]]\nname = \"link\"\ntype = \"hysteretic\"\nbetween = [\"a\", \"b\"]\nstiffness = 100\n"
    "loss_factor = 0.1\n";
const std::string decay_heading = "[study]\nschema = 1\nkind = \"decay\"\n";
const std::string transient_heading = "[study]\nschema = 1\nkind = \"transient\"\n";
const std::string excitation =
    "[excitation]\nfrequency = \"omega\"\n[[excitation.force]]\non = \"b\"\namplitude = \"omega^2\"\n";
const std::string initial =
    "[[initial]]\nnode = \"b\"\ndisplacement = \"x_0\"\nvelocity = { value = -5, unit = \"cm/s\" }\n";

Study parse(const std::string& text) {
  return parse_study(text, "motion.toml");
}

TEST_CASE("a decay has its initial values in SI, masses that are not named at rest") {
  const Study study = parse(decay_heading + network + initial);
  CHECK(study.kind() == StudyKind::decay);
  CHECK(study.decay()->samples == 0);
  CHECK_FALSE(study.decay()->duration);
  const auto state = initial_state(study);
  CHECK(state.displacement[0] == 0.0);
  CHECK_THAT(state.displacement[1], Catch::WithinRel(0.03, rounding));
  CHECK_THAT(state.velocity[1], Catch::WithinRel(-0.05, rounding));
}

TEST_CASE("the loss factors of a decay are taken at the lowest natural frequency, or where the study says") {
  const double lowest = motion_values(parse(decay_heading + network + initial)).hysteretic_omega;
  // The lower root of det(K - omega^2 M) = 0: 2 w^2 - 1100 w + 80000 = 0, w = omega^2.
  CHECK_THAT(lowest * lowest,
             Catch::WithinRel((1100.0 - std::sqrt(1100.0 * 1100.0 - 8.0 * 80000.0)) / 4.0, 1e-12));
  const Study given = parse(decay_heading + network + initial +
                            "[decay]\nreference_frequency = { value = 3, unit = \"Hz\" }\n");
  CHECK_THAT(motion_values(given).hysteretic_omega, Catch::WithinRel(6.0 * std::numbers::pi, rounding));
}

TEST_CASE("a transient has 1001 samples unless told otherwise, and a run-up lasts until it arrives") {
  const Study steady = parse(transient_heading + network + excitation +
                             "[transient]\nduration = { value = 2, unit = \"min\" }\n");
  CHECK(forced_options(steady).duration == 120.0);
  CHECK(forced_options(steady).samples == 1001);
  CHECK(forced_options(steady).run_up.rate == 0.0);
  CHECK_THAT(forced_options(steady).from, Catch::WithinRel(4.0 * std::numbers::pi, rounding));
  const Study run_down = parse(transient_heading + network + excitation +
                               "[transient]\nsweep_to = { value = 0.5, unit = \"Hz\" }\nsweep_rate = { "
                               "value = 30, unit = \"rpm/s\" }\n");
  CHECK_THAT(forced_options(run_down).duration, Catch::WithinRel(3.0, rounding));
  CHECK_THAT(forced_options(run_down).run_up.to, Catch::WithinRel(std::numbers::pi, rounding));
}

frahm::engine::Fingerprint fingerprint_of(const std::string& text) {
  return plan_without_map(parse(text), {}).fingerprint;
}

TEST_CASE("initial values and sweeps are physics, duration and samples are not") {
  const std::string base = decay_heading + network + initial;
  const auto with = [&](const std::string& more) { return fingerprint_of(base + "[decay]\n" + more); };
  CHECK(with("") == fingerprint_of(base));
  CHECK(with("samples = 11\n").physics == fingerprint_of(base).physics);
  CHECK(with("samples = 11\n").grid != fingerprint_of(base).grid);
  CHECK(with("duration = 3\n").grid != fingerprint_of(base).grid);
  CHECK(with("reference_frequency = 3\n").physics != fingerprint_of(base).physics);
  std::string other = base;
  other.replace(other.find("value = -5"), 10, "value = -6");
  CHECK(fingerprint_of(other).physics != fingerprint_of(base).physics);
  CHECK(fingerprint_of(transient_heading + network + excitation + initial + "[transient]\nduration = 3\n")
            .physics != fingerprint_of(transient_heading + network + excitation + initial +
                                       "[transient]\nduration = 3\nsweep_to = 3\nsweep_rate = 1\n")
                            .physics);
}

TEST_CASE("a constant force alone is an excitation of a transient") {
  const std::string constant =
      "[excitation]\nfrequency = \"omega\"\n[[excitation.force]]\non = \"b\"\namplitude = 3\norder = 0\n";
  const Study study = parse(transient_heading + network + constant + "[transient]\nduration = 3\n");
  REQUIRE(study.network.excitations.size() == 1);
  CHECK(study.network.reference_order == 1);
  CHECK(solve_transient(study).peaks[1].displacement > 0.0);
}

TEST_CASE("a decay and a transient are no maps") {
  CHECK_THROWS_WITH(plan_map(parse(decay_heading + network + initial), {}), Catch::Contains("one motion"));
}

}  // namespace
}  // namespace motion_study_test
