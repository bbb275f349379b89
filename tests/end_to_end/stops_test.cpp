// The studies of stops, play, shock absorbers and static friction.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <map>
#include <string>
#include <vector>

#include "tests/end_to_end/runs.hpp"

namespace stops_test {
namespace {

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using runs::Map;
using Complex = std::complex<double>;

constexpr double kOk = 1.0, kSeveral = 5.0, kNotPeriodic = 6.0;
constexpr double kTold = 1e-7;     // of the figures of known orbits
constexpr double kClosed = 1e-10;  // of closed forms, relative
constexpr double kBalance = 1e-10;

std::size_t index_of(const std::vector<double>& values, double value) {
  const auto near = [&](double each) { return std::abs(each - value) < 1e-9; };
  const auto found = std::find_if(values.begin(), values.end(), near);
  REQUIRE(found != values.end());
  return static_cast<std::size_t>(found - values.begin());
}

double linear_peak(double r, double zeta = 0.05) {
  return 1.0 / std::hypot(1.0 - r * r, 2.0 * zeta * r);
}

// The study with other [orbits], and with nothing compared.
std::string machine_on_stops(const std::string& orbits, int points = 141) {
  const std::string text = runs::reduced("machine_on_stops", {{"r", points}});
  return text.substr(0, text.find("[orbits]")) + "[orbits]\n" + orbits;
}

TEST_CASE(
    "machine_on_stops.toml: a machine that runs up jumps at the upper fold, one that runs down at the "
    "lower") {
  constexpr double kUpper = 2.0018066685, kLower = 1.4086707284;
  const Map map = runs::run_study(runs::reduced("machine_on_stops", {}));
  const std::vector<double>&r = map.coordinate("r"), &up = map["machine_peak"],
        &down = map["machine_peak_compared"];
  for (std::size_t i = 0; i < r.size(); ++i) {
    INFO("r " << r[i] << " up " << up[i] << " down " << down[i]);
    CHECK(map["status"][i] == kOk);
    CHECK(map["status_compared"][i] == kOk);
    CHECK(map["coexisting"][i] == 1.0);
    CHECK(map["energy_balance"][i] < kBalance);
    CHECK((map["machine_peak_difference"][i] > 0.4) == (r[i] > kLower && r[i] < kUpper));
    if (r[i] > kUpper) CHECK_THAT(up[i], WithinRel(linear_peak(r[i]), kClosed));
    if (r[i] > 1.411) CHECK_THAT(down[i], WithinRel(linear_peak(r[i]), kClosed));
    if (i == 0 || r[i] > kUpper) continue;
    if (r[i] < 1.995) CHECK(up[i] > up[i - 1]);  // its maximum lies a little before the fold
    if (r[i] < kLower) CHECK_THAT(down[i], WithinRel(up[i], kClosed));
  }
  CHECK_THAT(up[index_of(r, 1.4)], WithinAbs(1.9642744, kTold));
  CHECK_THAT(up[index_of(r, 1.5)], WithinAbs(2.1765907, kTold));
  CHECK_THAT(down[index_of(r, 1.6)], WithinAbs(0.6376804, kTold));
}

TEST_CASE("a sweep has the same bytes on any number of threads, and a point alone is swept to") {
  const runs::Folder folder;
  const std::string text = runs::replaced(
      runs::reduced("machine_on_stops", {{"r", 71}}), "[output]",
      "[[axis]]\nparameter = \"zeta\"\nvalues = [0.04, 0.05, 0.06]\n[output]\norbits = [{ r = 1.8, zeta = "
      "0.05 }]");
  const std::string study = folder.write("study.toml", text);
  CHECK(runs::frahm({"run", study, "-o", folder / "one.h5", "--threads", "1"}).code == 0);
  CHECK(runs::frahm({"run", study, "-o", folder / "two.h5", "--threads", "2"}).code == 0);
  const Map one = runs::read_map(folder / "one.h5"), two = runs::read_map(folder / "two.h5");
  for (const auto& [name, values] : one.values) {
    INFO(name);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!std::isnan(values[i])) CHECK(values[i] == two[name][i]);
    }
  }
  const std::size_t at = index_of(one.coordinate("r"), 1.8) * 3 + 1;
  const auto point = runs::frahm({"point", study, "--at", "r=1.8,zeta=0.05"});
  CHECK(one["machine_peak"][at] > 2.5);
  CHECK_THAT(point.out, Catch::Contains(fmt::format("{:.10g}", one["machine_peak"][at])));
  CHECK_THAT(point.out, Catch::Contains(fmt::format("{:.10g}", one["machine_peak_compared"][at])));
  const frahm::results::MapReader reader(folder / "one.h5");
  CHECK(reader.layout().variables.size() == one.values.size());
}

TEST_CASE("a swept map grows by rows; with other frequencies it is another sweep") {
  const runs::Folder folder;
  const auto write = [&](const std::string& name, const std::string& values, const std::string& to) {
    std::string text = runs::reduced("machine_on_stops", {{"r", 15}});
    text = runs::replaced(text, "to     = 2.4", "to     = " + to);
    return folder.write(name,
                        runs::replaced(text, "[orbits]",
                                       "[[axis]]\nparameter = \"zeta\"\nvalues = " + values + "\n[orbits]"));
  };
  const std::string small = write("small.toml", "[0.05]", "2.4"),
                    large = write("large.toml", "[0.04, 0.05]", "2.4"),
                    other = write("other.toml", "[0.04, 0.05]", "2.3");
  CHECK(runs::frahm({"run", small, "-o", folder / "small.h5"}).code == 0);
  const auto grown = runs::frahm({"run", large, "-o", folder / "grown.h5", "--from", folder / "small.h5"});
  CHECK(grown.code == 0);
  CHECK_THAT(grown.out, Catch::Contains("15 points of"));
  CHECK(runs::frahm({"run", large, "-o", folder / "fresh.h5"}).code == 0);
  CHECK(runs::read_map(folder / "grown.h5")["machine_peak"] ==
        runs::read_map(folder / "fresh.h5")["machine_peak"]);
  CHECK(runs::frahm({"run", other, "-o", folder / "other.h5", "--from", folder / "small.h5"}).code == 5);
}

TEST_CASE("machine_on_stops.toml searched: two orbits between the folds") {
  const Map large = runs::run_study(machine_on_stops("starts = 16\nshow = \"largest\"\n"));
  const Map small = runs::run_study(machine_on_stops("starts = 16\nshow = \"smallest\"\n"));
  const std::vector<double>& r = large.coordinate("r");
  for (std::size_t i = 0; i < r.size(); ++i) {
    INFO("r " << r[i]);
    // The folds: 1.4086707284 and 2.0018066685. Up to the grazing at sqrt(1.99) the small orbit touches the
    // stops and attracts few starts.
    const bool is_between = r[i] > 1.415 && r[i] < 2.0018;
    if (r[i] > 1.405 && r[i] < 1.415) continue;
    CHECK(large["coexisting"][i] == (is_between ? 2.0 : 1.0));
    CHECK(large["status"][i] == (is_between ? kSeveral : kOk));
    CHECK(large["period_multiple"][i] == 1.0);
    CHECK(large["energy_balance"][i] < kBalance);
    CHECK((large["machine_peak"][i] > small["machine_peak"][i]) == is_between);
    if (r[i] > 1.415) CHECK_THAT(small["machine_peak"][i], WithinRel(linear_peak(r[i]), kClosed));
  }
  CHECK_THAT(large["machine_peak"][index_of(r, 1.4)], WithinAbs(1.9642744, kTold));
  CHECK_THAT(large["machine_peak"][index_of(r, 1.5)], WithinAbs(2.1765907, kTold));
  CHECK_THAT(small["machine_peak"][index_of(r, 1.5)], WithinAbs(0.7943015, kTold));
  CHECK_THAT(large["machine_peak"][index_of(r, 1.6)], WithinAbs(2.4531427, kTold));
  CHECK_THAT(small["machine_peak"][index_of(r, 1.6)], WithinAbs(0.6376804, kTold));
}

// The columns of a group by name.
std::map<std::string, std::vector<double>> group_of(const std::string& file, const std::string& group) {
  std::map<std::string, std::vector<double>> columns;
  for (const frahm::results::Column& column : frahm::results::MapReader(file).columns(group))
    columns[column.variable.name] = column.values;
  return columns;
}

constexpr double kFold = 2.0, kStable = 1.0, kUnstable = 2.0;  // flags of /branches

TEST_CASE("machine_on_stops.toml: one branch through both folds, unstable between them") {
  const runs::Folder folder;
  const std::string study = folder.write("study.toml", runs::reduced("machine_on_stops", {{"r", 29}}));
  REQUIRE(runs::frahm({"run", study, "-o", folder / "map.h5"}).code == 0);
  auto branch = group_of(folder / "map.h5", "branches");
  CHECK(branch["row_start"] == std::vector<double>{0.0});
  CHECK(branch["period_multiple"] == std::vector<double>{1.0});
  std::vector<std::size_t> folds;
  for (std::size_t i = 0; i < branch["special"].size(); ++i)
    if (branch["special"][i] == kFold) folds.push_back(i);
  REQUIRE(folds.size() == 2);
  CHECK_THAT(branch["r"][folds[0]], WithinAbs(2.00180666851, kTold));
  CHECK_THAT(branch["machine_peak"][folds[0]], WithinAbs(4.9326330, kTold));
  CHECK_THAT(branch["r"][folds[1]], WithinAbs(1.40867072840, kTold));
  for (std::size_t i = 0; i < branch["r"].size(); ++i) {
    if (i == folds[0] || i == folds[1]) continue;
    INFO("r " << branch["r"][i]);
    CHECK(branch["stability"][i] == (i > folds[0] && i < folds[1] ? kUnstable : kStable));
    CHECK(std::isnan(branch["special_residual"][i]) == (branch["special"][i] == 1.0));
    if (i > 0) CHECK(branch["arclength"][i] > branch["arclength"][i - 1]);
  }
  CHECK(runs::frahm({"check", study}).out.find("branches through 1 row") != std::string::npos);
}

TEST_CASE("Branches are the same whatever the threads, and CSV has each point of each row") {
  const runs::Folder folder;
  const std::string study = folder.write(
      "study.toml", runs::replaced(runs::reduced("machine_on_stops", {{"r", 15}}), "[orbits]",
                                   "[[axis]]\nparameter = \"zeta\"\nvalues = [0.05, 0.1, 0.2]\n\n[orbits]"));
  std::vector<std::map<std::string, std::vector<double>>> found;
  for (const std::string threads : {"1", "2"}) {
    const std::string file = folder / ("map" + threads + ".h5");
    REQUIRE(runs::frahm({"run", study, "-o", file, "--threads", threads}).code == 0);
    found.push_back(group_of(file, "branches"));
    for (auto& [name, values] : found.back())
      std::ranges::replace_if(
          values, [](double each) { return std::isnan(each); }, -1e300);
  }
  CHECK(found[0] == found[1]);
  CHECK(found[0]["zeta"] == std::vector<double>{0.05, 0.1, 0.2});
  const std::string csv = runs::frahm({"export", folder / "map1.h5", "--group", "branches", "-o", "-"}).out;
  CHECK(static_cast<std::size_t>(std::ranges::count(csv, '\n')) == found[0]["r"].size() + 1);
  CHECK(csv.find(",fold,") != std::string::npos);
  CHECK(csv.starts_with("zeta,"));
}

TEST_CASE("Branches of chosen rows alone, and of one as a result of its own") {
  const runs::Folder folder;
  const std::string text =
      runs::replaced(runs::replaced(runs::reduced("machine_on_stops", {{"r", 15}}), "[orbits]",
                                    "[[axis]]\nparameter = \"zeta\"\nvalues = [0.05, 0.1, 0.2]\n\n[orbits]"),
                     "branches = true", "branches = { along = \"r\", at = [{ zeta = 0.1 }] }");
  const std::string study = folder.write("study.toml", text);
  REQUIRE(runs::frahm({"run", study, "-o", folder / "map.h5"}).code == 0);
  CHECK(group_of(folder / "map.h5", "branches")["zeta"] == std::vector<double>{0.1});
  REQUIRE(runs::frahm({"branch", study, "--along", "r", "--at", "zeta=0.1", "-o", folder / "one.h5"}).code ==
          0);
  auto of_map = group_of(folder / "map.h5", "branches"), alone = group_of(folder / "one.h5", "branches");
  CHECK(alone["zeta"] == of_map["zeta"]);
  CHECK(alone["r"].size() == of_map["r"].size());
  CHECK(runs::frahm({"run", study, "-o", folder / "one.h5"}).code == 5);
}

TEST_CASE("bolted_joint.toml: until all of it slips a loop takes K^2 X^3/(3 F)") {
  constexpr double kOfSpread = 1.5 / (20.0 * 20.0);  // of a joint of 20 sliders, over the loss at X = 2 F/K
  const Map map = runs::run_study(runs::reduced("bolted_joint", {}));
  const double K = 1.0, F = 2.0, largest = 2.0 * F / K;
  int slipping = 0;
  for (std::size_t point = 0; point < map["part_peak"].size(); ++point) {
    const double X = map["part_peak"][point];
    INFO("point " << point << ", X " << X);
    CHECK(map["status"][point] == kOk);
    CHECK(map["energy_balance"][point] < kBalance);
    REQUIRE(X < largest);
    CHECK_THAT(map["joint_energy"][point], WithinAbs(K * K * X * X * X / (3.0 * F),
                                                     kOfSpread * K * K * std::pow(largest, 3) / (3.0 * F)));
    // Slider i of 20 slips beyond (i - 1/2)/20 of the largest displacement.
    CHECK(map["joint_slipping"][point] == std::floor(20.0 * X / largest + 0.5));
    if (map["joint_slipping"][point] > 4.0) ++slipping;
  }
  CHECK(slipping > 20);
}

TEST_CASE("duffing_jump.toml: two orbits at r = 1.6, as harmonic balance has them") {
  constexpr double kPrinted = 1e-7, kIntegrated = 1e-8;
  const std::string text = runs::replaced(runs::reduced("duffing_jump", {}),
                                          "from   = 1.0\nto     = 2.2\npoints = 13", "values = [0.5, 1.6]");
  const Map large = runs::run_study(text);
  const Map small = runs::run_study(runs::replaced(text, "\"largest\"", "\"smallest\""));
  CHECK(large["coexisting"] == std::vector<double>{1.0, 2.0});
  CHECK(large["status"] == std::vector<double>{kOk, kSeveral});
  CHECK_THAT(large["machine_peak"][1], WithinAbs(3.5225667, kPrinted));
  CHECK_THAT(small["machine_peak"][1], WithinAbs(0.66645785, kPrinted));
  for (const double balance : large["energy_balance"]) CHECK(balance < kIntegrated);
}

TEST_CASE("bump_and_rebound.toml: the spring carries the mean of the absorber's force") {
  const Map map = runs::run_study(runs::reduced("bump_and_rebound", {}));
  const double k = 20e3, rebound = 2400.0;
  std::size_t point = 0;
  for (const double bump : map.coordinate("bump")) {
    for (const double f : map.coordinate("f")) {
      INFO("bump " << bump << ", f " << f);
      // In a period T the velocity has each sign once: the mean of c_+ v while v > 0 is c_+ 2 A/T, A the
      // amplitude.
      const double mean_force = (rebound - bump) * 2.0 * map["ride_amplitude"][point] * f;
      CHECK(map["status"][point] == kOk);
      CHECK(map["error_bound"][point] < 1e-9);
      CHECK(map["energy_balance"][point] < kBalance);
      CHECK_THAT(map["ride_mean"][point], WithinAbs(-mean_force / k, kClosed * 0.01));
      if (bump == rebound) {
        const double w = 2.0 * M_PI * f;
        const Complex u = 300.0 * w * w / Complex(k - 300.0 * w * w, rebound * w);
        CHECK_THAT(map["ride_peak"][point], WithinRel(0.01 * std::abs(u), kClosed));
      }
      ++point;
    }
  }
}

// Whether the orbit that slides without a stop stands: f_s < X - cos(lag of the peak). Its first harmonic
// alone drives it (Den Hartog): the border of r = 0.8 is known.
TEST_CASE("static_over_kinetic.toml: rest and sliding coexist from f_s = 1 to the border of sliding") {
  constexpr double kBorder = 1.5914263943;
  const Map map = runs::run_study(runs::reduced("static_over_kinetic", {}));
  const std::vector<double>&f_s = map.coordinate("f_s"), &r = map.coordinate("r");
  const std::size_t at = index_of(r, 0.8);
  for (std::size_t i = 0; i < f_s.size(); ++i) {
    const std::size_t point = i * r.size() + at;
    INFO("f_s " << f_s[i]);
    const double peak = map["main_peak"][point], coexisting = map["coexisting"][point];
    if (f_s[i] < kBorder) CHECK_THAT(peak, WithinAbs(2.5001367841, 1e-9));
    if (std::abs(f_s[i] - 1.0) < 1e-9) continue;  // the force only just reaches the limit
    if (f_s[i] < 1.0) CHECK(coexisting == 1.0);
    if (f_s[i] > 1.0 && f_s[i] < kBorder) {
      CHECK(coexisting == 2.0);
      CHECK(map["status"][point] == kSeveral);
    }
  }
}

// A row where force and static force are equal has one response; on the next row there are two.
TEST_CASE("rows of one response leave the next ones to the search") {
  std::string text = runs::reduced("static_over_kinetic", {});
  text = text.substr(0, text.find("[[axis]]")) +
         "[[axis]]\nparameter = \"f_k\"\nvalues = [1.3, 0.2]\n[[axis]]\nparameter = \"r\"\nvalues = [0.75, "
         "0.8, 0.85]\n";
  const Map map = runs::run_study(text);
  CHECK(map["coexisting"] == std::vector<double>{1, 1, 1, 2, 2, 2});
  CHECK(map["status"] == std::vector<double>{kOk, kOk, kOk, kSeveral, kSeveral, kSeveral});
}

TEST_CASE("absorber_stops.toml: linear below the clearance, thrown back beyond it") {
  constexpr double mu = 0.05, nu = 0.95, D = 10.0;
  const runs::Folder folder;
  const std::string study = folder.write("study.toml", runs::reduced("absorber_stops", {}));
  const auto outcome = runs::frahm({"run", study, "-o", folder / "map.h5", "--threads", "1"});
  CHECK(outcome.code == 3);
  CHECK_THAT(outcome.err, Catch::Contains("points for which no periodic response was found"));
  const Map map = runs::read_map(folder / "map.h5");
  std::size_t point = 0, within = 0, beyond = 0, lost = 0;
  for (const double P : map.coordinate("P")) {
    for (const double r : map.coordinate("r")) {
      INFO("P " << P << ", r " << r);
      const Complex link(mu * nu * nu, 0.1 * mu * nu * r);
      // The absorber's stroke per displacement of the machine, and the force it returns.
      const Complex stroke = mu * r * r / (link - mu * r * r);
      const Complex X = P / (Complex(1.0 - r * r, 0.01 * r) - link * stroke);
      const bool is_free = std::abs(stroke * X) < D;
      const double status = map["status"][point];
      if (status == kNotPeriodic) {
        CHECK_FALSE(is_free);
        CHECK(std::isnan(map["machine_peak"][point++]));
        ++lost;
        continue;
      }
      CHECK(map["energy_balance"][point] < kBalance);
      CHECK((status == kOk || status == kSeveral));
      if (is_free && status == kOk) {
        CHECK_THAT(map["machine_peak"][point], WithinRel(std::abs(X), kClosed));
        CHECK_THAT(map["end_stops_stroke"][point], WithinRel(std::abs(stroke * X), kClosed));
        ++within;
      }
      if (!is_free) {
        CHECK(map["end_stops_stroke"][point] > D);
        if (P == 2.0) CHECK(map["end_stops_stroke"][point] < std::abs(stroke * X));
        ++beyond;
      }
      ++point;
    }
  }
  CHECK(within > 25);
  CHECK(beyond > 10);
  CHECK(lost > 0);
}

TEST_CASE("rig_play.toml: without play the teeth are a spring, and play takes inertance away") {
  const std::string text = runs::reduced("rig_play", {});
  const Map map = runs::run_study(text);
  std::string without = runs::replaced(text, "type = \"gap\"", "type = \"spring\"");
  without = runs::replaced(without, "clearance = \"play/2\"\n", "");
  without = runs::replaced(without, "damping = 500                      # while in contact\n", "");
  without = runs::replaced(
      without, "tension = true                     # the oil between the teeth pulls as well\n", "");
  without = runs::replaced(without, "damping = 5\n", "damping = 505\n");
  without = without.substr(0, without.find("[orbits]"));
  const Map linear = runs::run_study(without);
  const std::size_t inertances = map.coordinate("I").size();
  for (std::size_t i = 0; i < map["status"].size(); ++i) {
    INFO("point " << i);
    CHECK(map["energy_balance"][i] < kBalance);
    if (i < inertances) {
      CHECK(map["status"][i] == kOk);
      CHECK_THAT(map["main_peak"][i], WithinRel(linear["main_peak"][i], 1e-8));
      CHECK_THAT(map["tmd_peak"][i], WithinRel(linear["tmd_peak"][i], 1e-8));
    }
  }
  const std::vector<double>& I = map.coordinate("I");
  for (std::size_t i = inertances; i < map["status"].size(); ++i) {
    if (I[i % inertances] >= 8.0) CHECK(map["main_peak"][i] > map["main_peak"][i - inertances]);
  }
  const std::size_t at = index_of(I, 10.0), most = map["status"].size() - inertances + at;
  CHECK_THAT(map["main_peak"][most] / map["main_peak"][at], WithinAbs(1.11, 0.005));
}

// One mass on a spring and a damper, with one more element at it.
std::string damped_mass(const std::string& parameters, const std::string& element, const std::string& more) {
  return R"([study]
schema = 1
kind = "sweep"
units = "dimensionless"
[parameters]
)" + parameters +
         R"([[mass]]
name = "main"
mass = 1
[[element]]
name = "spring"
type = "spring"
between = ["ground", "main"]
stiffness = 1
[[element]]
name = "damper"
type = "damper"
between = ["ground", "main"]
damping = 0.1
[[element]]
between = ["ground", "main"]
)" + element +
         more;
}

// With a stop below it, without clearance: w = 2 w1 w2/(w1 + w2) = 1.5195.
std::string mass_on_a_stop(const std::string& excitation, const std::string& more = "") {
  return damped_mass("r = 3\n", R"(name = "stop"
type = "gap"
clearance = [0, inf]
stiffness = 9
)",
                     excitation + R"([[axis]]
parameter = "r"
values = [2.1, 2.6, 3.0, 3.1]
[output]
quantities = ["main_peak", "damper_energy", "energy_balance", "floquet_radius", "coexisting", "period_multiple", "status"]
)" + more);
}

const std::string kOrderOne = R"([excitation]
frequency = "r"
[[excitation.force]]
on = "main"
amplitude = 1
)";

TEST_CASE("a subharmonic takes two periods, and one where its order is counted as the second") {
  const std::string order_two = runs::replaced(runs::replaced(kOrderOne, "\"r\"", "\"r/2\""), "amplitude = 1",
                                               "amplitude = 1\norder = 2");
  const Map one = runs::run_study(mass_on_a_stop(kOrderOne)),
            two = runs::run_study(mass_on_a_stop(order_two));
  // The natural frequency by two: a subharmonic resonance at 3.04.
  CHECK(one["main_peak"][2] > 2.0);
  const std::vector<double> multiples{1, 4, 2, 2}, of_whole_periods{1, 2, 1, 1}, times{2, 1, 1, 1};
  for (std::size_t i = 0; i < multiples.size(); ++i) {
    INFO("point " << i);
    CHECK(one["period_multiple"][i] == multiples[i]);
    CHECK(two["period_multiple"][i] == of_whole_periods[i]);
    CHECK(one["energy_balance"][i] < kBalance);
    CHECK_THAT(two["main_peak"][i], WithinRel(one["main_peak"][i], kClosed));
    CHECK_THAT(two["damper_energy"][i], WithinRel(times[i] * one["damper_energy"][i], kClosed));
    CHECK_THAT(two["floquet_radius"][i], WithinRel(std::pow(one["floquet_radius"][i], times[i]), 1e-8));
  }
}

TEST_CASE("where no multiple that is tried has a stable orbit, the point is not periodic and has no number") {
  const runs::Folder folder;
  const std::string study =
      folder.write("study.toml", mass_on_a_stop(kOrderOne, "[orbits]\nmost_multiple = 1\n"));
  const auto outcome = runs::frahm({"run", study, "-o", folder / "map.h5"});
  CHECK(outcome.code == 3);
  CHECK_THAT(outcome.err, Catch::Contains("\n3 points for which no periodic response was found"));
  const Map map = runs::read_map(folder / "map.h5");
  CHECK(map["status"] == std::vector<double>{kOk, kNotPeriodic, kNotPeriodic, kNotPeriodic});
  CHECK(map["coexisting"] == std::vector<double>{1, -1, -1, -1});
  CHECK(map["unsettled"] == std::vector<double>{0, 8, 8, 8});  // recorded though it is not listed
  CHECK_THAT(outcome.out,
             Catch::Contains("at 3 of 4 points 24 of 24 starts reached no stable response of up to 1"));
  CHECK(std::isnan(map["main_peak"][1]));
}

// Below F/k_t the slider is a spring: x = 0.3/|1.5 - r^2 + 0.1 i r|.
TEST_CASE("where a slider never slips, file, run and point say that the response is one of a continuum") {
  const runs::Folder folder;
  const std::string study =
      folder.write("study.toml", damped_mass("r = 1\nF = 1\n", R"(name = "slider"
type = "jenkins"
stiffness = 0.5
force = "F"
)",
                                             runs::replaced(kOrderOne, "amplitude = 1", "amplitude = 0.3") +
                                                 R"([[axis]]
parameter = "F"
values = [0.1, 1]
[output]
quantities = ["main_peak"]
)"));
  const auto outcome = runs::frahm({"run", study, "-o", folder / "map.h5"});
  CHECK(outcome.code == 0);
  CHECK_THAT(outcome.out, Catch::Contains("1 of 2 points show one of a continuum of responses"));
  const Map map = runs::read_map(folder / "map.h5");
  CHECK(map["continuum"] == std::vector<double>{0, 1});
  CHECK_THAT(map["main_peak"][1], WithinRel(0.3 / std::abs(Complex(0.5, 0.1)), kClosed));
  const auto point = runs::frahm({"point", study});
  CHECK_THAT(point.out,
             Catch::Contains("one of a continuum: 1 slider of jenkins or iwan elements never slips") &&
                 Catch::Contains("z(T/2) = -z(0); the error bound refers to this one"));
  CHECK_THAT(runs::frahm({"point", study, "--at", "F=0.1"}).out,
             !Catch::Contains("one of a continuum: 1 slider"));
}

// Between its folds the machine has two stable responses; the small one never touches the stops and is
// linear: x = Re e^(i r tau)/(1 - r^2 + 0.1 i r), multipliers exp(-0.05 T) e^(+-i w T).
TEST_CASE("point --responses lists every stable response with its state, peaks and multipliers") {
  const runs::Folder folder;
  const std::string study = folder.write("study.toml", machine_on_stops("starts = 8\n", 3));
  const auto outcome = runs::frahm({"point", study, "--at", "r=1.6", "--responses"});
  CHECK(outcome.code == 0);
  CHECK_THAT(outcome.out, Catch::Contains("Stable responses that were found: 2"));
  CHECK_THAT(outcome.out, Catch::Contains("shown above"));
  const auto json = runs::frahm({"point", study, "--at", "r=1.6", "--responses", "--json"});
  const Complex x = 1.0 / Complex(1.0 - 1.6 * 1.6, 0.16);
  CHECK_THAT(json.out, Catch::Contains(fmt::format("{:.9f}", std::abs(x)).substr(0, 10)));
  CHECK_THAT(json.out, Catch::Contains(fmt::format("{:.9f}", x.real()).substr(0, 10)));
}

// Figures of a Dormand-Prince integration of order 8 from event to event, closed by Newton's method: a motion
// from -0.354874840919 to 0.351252539400, and its mirror image.
TEST_CASE("point --responses lists both of a mirror pair, and says which is the image of which") {
  const runs::Folder folder;
  const std::string study = folder.write("study.toml", damped_mass("r = 1.55\n", R"(name = "stops"
type = "gap"
clearance = 0.2
stiffness = 20
)",
                                                                   kOrderOne + R"([[axis]]
parameter = "r"
values = [1.55]
[orbits]
starts = 1
)"));
  const auto text = runs::frahm({"point", study, "--responses"});
  CHECK(text.code == 0);
  CHECK_THAT(text.out, Catch::Contains("Stable responses that were found: 2"));
  CHECK_THAT(text.out, Catch::Contains("the mirror image of 1: x(t) = -x_1(t + T/2)"));
  for (const std::string form : {"", "--json"}) {
    const std::string out = form.empty() ? text.out : runs::frahm({"point", study, "--responses", form}).out;
    INFO(out);
    // Displacement and velocity at omega t = 0 of either, and the peak of both.
    for (const std::string figure : {"0.27292490", "0.51940410", "0.30096490", "-0.42873710", "0.35487484"})
      CHECK_THAT(out, Catch::Contains(figure));
    if (form.empty()) continue;
    CHECK_THAT(out, Catch::Contains("\"mirror_of\": null") && Catch::Contains("\"mirror_of\": 0"));
    CHECK_THAT(out, Catch::Contains("\"shown\": true") && Catch::Contains("\"shown\": false"));
  }
}

// With a large force both sliders slip from one turning point almost to the next: at omega t = 0, between
// them, each has its own limit, 0.1 and 0.4.
TEST_CASE("point --responses gives the force of each slider of an iwan, without which no motion restarts") {
  const runs::Folder folder;
  const std::string study = folder.write("study.toml", damped_mass("r = 1.55\n", R"(name = "joint"
type = "iwan"
stiffnesses = [4, 4]
forces = [0.1, 0.4]
)",
                                                                   kOrderOne + R"([[axis]]
parameter = "r"
values = [1.55]
)"));
  const std::string out = runs::frahm({"point", study, "--responses", "--json"}).out;
  INFO(out);
  const auto value_of = [&](const std::string& name) {
    const auto place = out.find("\"" + name + "\"");
    REQUIRE(place != std::string::npos);
    return std::stod(out.substr(out.find("\"value\":", place) + 8));
  };
  CHECK_THAT(std::abs(value_of("joint_slider_1_force")), WithinRel(0.1, kClosed));
  CHECK_THAT(std::abs(value_of("joint_slider_2_force")), WithinRel(0.4, kClosed));
}

// It loses 2 F/k of amplitude from each turning point to the next, and stays at the first within F_s/k.
TEST_CASE("a free motion stays where static friction first holds it") {
  const auto outcome_of = [](const std::string& static_force) {
    const runs::Folder folder;
    const std::string study = folder.write("study.toml", R"([study]
schema = 1
kind = "decay"
units = "dimensionless"
[[mass]]
name = "main"
mass = 1
[[element]]
name = "spring"
type = "spring"
between = ["ground", "main"]
stiffness = 1
[[element]]
name = "guide"
type = "coulomb"
between = ["ground", "main"]
force = 0.1
)" + static_force + "[[initial]]\nnode = \"main\"\ndisplacement = 1.05\n");
    return runs::frahm({"run", study, "-o", folder / "decay.h5"}).out;
  };
  CHECK_THAT(outcome_of(""), Catch::Contains("main: 6 extrema, rests at -0.05"));
  CHECK_THAT(outcome_of("static_force = 0.3\n"), Catch::Contains("main: 5 extrema, rests at 0.25"));
}

TEST_CASE("a map of a system with several responses says what was searched") {
  const runs::Folder folder;
  const auto searched = [&](const std::string& name, const std::string& text) {
    const std::string study = folder.write(name, text);
    const auto outcome = runs::frahm({"run", study, "-o", folder / (name + ".h5")});
    CHECK(outcome.code == 0);
    const frahm::results::MapReader reader(folder / (name + ".h5"));
    const std::vector<frahm::results::Text> texts = reader.texts("provenance");
    const auto found = std::find_if(texts.begin(), texts.end(),
                                    [](const auto& each) { return each.first == "orbits_searched"; });
    return found == texts.end() ? "" : found->second;
  };
  CHECK_THAT(searched("search.toml", machine_on_stops("starts = 16\n", 3)),
             Catch::Contains("16 starts") && Catch::Contains("before and after") &&
                 Catch::Contains("largest peak of machine"));
  const std::string sweeps = searched("sweep.toml", runs::reduced("machine_on_stops", {{"r", 3}}));
  CHECK_THAT(sweeps, Catch::Contains("sweep of the frequency up, from rest") &&
                         Catch::Contains("Compared: a sweep of the frequency down") &&
                         !Catch::Contains("starts"));
}

}  // namespace
}  // namespace stops_test
