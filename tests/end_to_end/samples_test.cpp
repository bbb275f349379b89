// Uncertain parameters: axes of samples, their statistics and first-order sensitivities.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/end_to_end/runs.hpp"
#include "tests/study_path.hpp"

namespace samples_test {
namespace {

using frahm::results::MapReader;
using runs::Map;

constexpr double rounding = 1e-12;

const std::string heading = "[study]\nschema = 1\nkind = \"sweep\"\nunits = \"dimensionless\"\n";
// Below the resonance, without damping: X = 1/(k - r^2), which falls with k.
const std::string oscillator =
    heading +
    "[parameters]\nk = 1\nr = 0.5\n[[mass]]\nname = \"main\"\nmass = 1\n"
    "[[element]]\nname = \"spring\"\ntype = \"spring\"\nbetween = [\"ground\", \"main\"]\nstiffness = \"k\"\n"
    "[excitation]\nfrequency = \"r\"\n[[excitation.force]]\non = \"main\"\namplitude = 1\n"
    "[output]\nquantities = [\"main_peak\", \"status\"]\nprecision = \"full\"\n";

std::string samples_of_k(int count, const std::string& sequence, int seed) {
  return "[[axis]]\nsamples = " + std::to_string(count) + "\nsequence = \"" + sequence +
         "\"\nseed = " + std::to_string(seed) +
         "\n[[axis.of]]\nparameter = \"k\"\ndistribution = \"normal\"\nmean = 1\ndeviation = 0.1\nlower = "
         "0.6\n";
}

// A result in a folder of its own.
class Result {
 public:
  explicit Result(const std::string& text, const std::string& threads = "1") {
    const runs::Outcome run =
        runs::frahm({"run", folder_.write("study.toml", text), "-o", file(), "--threads", threads});
    INFO(run.err);
    REQUIRE(run.code == 0);
    told = run.out;
  }
  std::string file() const { return folder_ / "study.h5"; }
  // A column of a group that is no map.
  std::vector<double> of_column(const std::string& group, const std::string& name) const {
    for (const auto& column : MapReader(file()).columns(group)) {
      if (column.variable.name == name) return column.values;
    }
    FAIL(group << " has no " << name);
    return {};
  }

  // All values of a variable of a group, on the axes beside the samples.
  std::vector<double> of(const std::string& group, const std::string& name) const {
    const MapReader map(file(), group);
    const auto& variables = map.layout().variables;
    const auto found = std::ranges::find(variables, name, &frahm::results::Variable::name);
    INFO(group << ": " << name);
    REQUIRE(found != variables.end());
    const auto shape = shape_of(map.layout());
    return map.read(static_cast<std::size_t>(found - variables.begin()),
                    std::vector<std::uint64_t>(shape.size(), 0), shape);
  }

  std::string told;

 private:
  runs::Folder folder_;
};

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double covariance_of(const std::vector<double>& a, const std::vector<double>& b) {
  const double mean_a = mean_of(a), mean_b = mean_of(b);
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - mean_a) * (b[i] - mean_b);
  return sum / static_cast<double>(a.size() - 1);
}

// As numpy.quantile.
double quantile_of(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double at = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  return values[below] +
         (at - static_cast<double>(below)) * (values[std::min(below + 1, values.size() - 1)] - values[below]);
}

TEST_CASE("quantiles of 1000 random samples carry intervals that hold the true ones in 95 of 100 seeds",
          "[long]") {
  // P(X < x) = P(k > 1/x + r^2): the quantile of X at p is that of k at 1 - p. Of k, cut at four deviations
  // below, the shares 0.05, 0.5 and 0.95 lie at -1.644854, 0 and 1.644854 deviations, to 1e-4 of the share.
  const auto exact = [](double deviations) { return 1.0 / (1.0 + 0.1 * deviations - 0.25); };
  const std::map<std::string, double> truth{
      {"q5", exact(1.6448536)}, {"q50", exact(0.0)}, {"q95", exact(-1.6448536)}};
  std::map<std::string, int> held;
  for (int seed = 1; seed <= 100; ++seed) {
    const Result result(oscillator + samples_of_k(1000, "random", seed));
    for (const auto& [name, value] : truth) {
      const double low = result.of("statistics", "main_peak_" + name + "_low").front();
      const double high = result.of("statistics", "main_peak_" + name + "_high").front();
      held[name] += low <= value && value <= high;
    }
  }
  INFO(held["q5"] << ", " << held["q50"] << " and " << held["q95"] << " of 100 seeds");
  CHECK(held["q5"] + held["q50"] + held["q95"] >= 3 * 95);
}

TEST_CASE("statistics are those of the values in the map, wherever the samples lie among the axes") {
  const std::string r = "[[axis]]\nparameter = \"r\"\nfrom = 0.1\nto = 0.6\npoints = 7\n";
  for (const bool first : {true, false}) {
    const std::string samples = samples_of_k(300, "sobol", 5);
    const Result result(oscillator + (first ? samples + r : r + samples));
    const Map map = runs::read_map(result.file());
    const auto& peaks = map["main_peak"];
    const auto means = result.of("statistics", "main_peak_mean");
    const auto deviations = result.of("statistics", "main_peak_deviation");
    const auto quantiles = result.of("statistics", "main_peak_q95");
    const auto counts = result.of("statistics", "main_peak_samples");
    REQUIRE(means.size() == 7);
    for (std::size_t i = 0; i < 7; ++i) {
      std::vector<double> values;
      for (std::size_t s = 0; s < 300; ++s) values.push_back(peaks[first ? s * 7 + i : i * 300 + s]);
      CHECK_THAT(means[i], Catch::WithinRel(mean_of(values), rounding));
      CHECK_THAT(deviations[i], Catch::WithinRel(std::sqrt(covariance_of(values, values)), rounding));
      CHECK_THAT(quantiles[i], Catch::WithinRel(quantile_of(values, 0.95), rounding));
      CHECK(counts[i] == 300);
    }
  }
}

TEST_CASE("first-order sensitivities are the closed form's derivatives, and their shares add up to one") {
  std::string text = oscillator + samples_of_k(512, "sobol", 2) +
                     "[[axis.of]]\nparameter = \"P\"\ndistribution = \"uniform\"\nlower = 0.5\nupper = 1.5\n";
  text = runs::replaced(text, "k = 1\n", "k = 1\nP = 1\n");
  text = runs::replaced(text, "amplitude = 1", "amplitude = \"P\"");
  const Result result(text);
  const Map map = runs::read_map(result.file());
  const auto &k = map.coordinate("k"), &P = map.coordinate("P");
  // X = P/(k - r^2) at the mean of the samples.
  const double below = mean_of(k) - 0.25, by_P = 1.0 / below, by_k = -mean_of(P) / (below * below);
  const double kk = covariance_of(k, k), PP = covariance_of(P, P), kP = covariance_of(k, P);
  const double variance = by_k * by_k * kk + 2.0 * by_k * by_P * kP + by_P * by_P * PP;
  const auto number = [&](const std::string& name) {
    return result.of("tornado", "main_peak_" + name).front();
  };
  constexpr double derived = 1e-9;
  CHECK_THAT(number("at_mean"), Catch::WithinRel(mean_of(P) / below, derived));
  CHECK_THAT(number("by_k"), Catch::WithinRel(by_k * std::sqrt(kk), derived));
  CHECK_THAT(number("by_P"), Catch::WithinRel(by_P * std::sqrt(PP), derived));
  CHECK_THAT(number("first_order_deviation"), Catch::WithinRel(std::sqrt(variance), derived));
  CHECK_THAT(number("share_k"), Catch::WithinRel(by_k * (by_k * kk + by_P * kP) / variance, derived));
  CHECK_THAT(number("share_k") + number("share_P"), Catch::WithinAbs(1.0, rounding));
  CHECK_THAT(result.told, Catch::Contains("95 % quantile") && Catch::Contains("of the variance"));
}

TEST_CASE("a table of samples is a map of zipped axes, with the same values") {
  const runs::Folder folder;
  folder.write("samples.csv", "k,r\n1,0.2\n1.1,0.3\n0.9,0.25\n1.3,0.5\n");
  const std::string zipped =
      "[[axis]]\nparameter = \"k\"\nvalues = [1, 1.1, 0.9, 1.3]\nzip = \"draw\"\n"
      "[[axis]]\nparameter = \"r\"\nvalues = [0.2, 0.3, 0.25, 0.5]\nzip = \"draw\"\n";
  const auto map_of = [&](const std::string& name, const std::string& axes) {
    const auto run =
        runs::frahm({"run", folder.write(name + ".toml", oscillator + axes), "-o", folder / (name + ".h5")});
    INFO(run.err);
    REQUIRE(run.code == 0);
    return runs::read_map(folder / (name + ".h5"));
  };
  const Map table = map_of("table", "[[axis]]\nfrom = \"samples.csv\"\n"), axes = map_of("axes", zipped);
  CHECK(table["main_peak"] == axes["main_peak"]);
  CHECK(table.coordinate("k") == axes.coordinate("k"));
  CHECK(table.coordinate("r") == axes.coordinate("r"));
  CHECK(table.layout.axes.front().name == "draw");
  CHECK(MapReader(folder / "table.h5").has_group("statistics"));
  CHECK_FALSE(MapReader(folder / "axes.h5").has_group("statistics"));
}

TEST_CASE("the same seed gives the same samples and statistics on any number of threads") {
  const std::string text = oscillator + samples_of_k(500, "latin_hypercube", 3) +
                           "[[axis]]\nparameter = \"r\"\nfrom = 0.1\nto = 0.6\npoints = 41\n";
  const Result one(text, "1"), two(text, "2");
  CHECK(runs::read_map(one.file()).coordinate("k") == runs::read_map(two.file()).coordinate("k"));
  for (const char* name : {"mean", "mean_low", "deviation", "q5", "q5_low", "q95_high"})
    CHECK(one.of("statistics", std::string("main_peak_") + name) ==
          two.of("statistics", std::string("main_peak_") + name));
  CHECK(one.of("tornado", "main_peak_by_k") == two.of("tornado", "main_peak_by_k"));
}

TEST_CASE("check tells the samples with their distributions, mean and deviation") {
  const runs::Folder folder;
  const runs::Outcome check =
      runs::frahm({"check", folder.write("study.toml", oscillator + samples_of_k(1024, "sobol", 1))});
  CHECK(check.code == 0);
  CHECK_THAT(check.out, Catch::Contains("samples 1024 points of sobol, seed 1"));
  CHECK_THAT(check.out, Catch::Contains("normal, mean 1, deviation 0.1, lower 0.6; sampled mean 0.9997"));
}

TEST_CASE("statistics and tornado are exported as tables over the other axes") {
  const Result result(oscillator + samples_of_k(50, "sobol", 1) +
                      "[[axis]]\nparameter = \"r\"\nvalues = [0.1, 0.2]\n");
  for (const std::string group : {"statistics", "tornado"}) {
    const runs::Outcome table = runs::frahm({"export", result.file(), "--group", group, "-o", "-"});
    CHECK(table.code == 0);
    CHECK(table.out.starts_with("r,main_peak_"));
    CHECK(std::count(table.out.begin(), table.out.end(), '\n') == 3);
  }
}

TEST_CASE(
    "absorber_scatter.toml: the 95 % quantile is largest, 8.065, at r = 1.06, by the frequency above all") {
  const Result result(runs::reduced("absorber_scatter", {}));
  const auto quantiles = result.of("statistics", "machine_peak_q95");
  const auto worst = static_cast<std::size_t>(std::ranges::max_element(quantiles) - quantiles.begin());
  CHECK_THAT(runs::read_map(result.file()).coordinate("r")[worst], Catch::WithinAbs(1.06, 1e-9));
  CHECK_THAT(quantiles[worst], Catch::WithinAbs(8.065, 0.005));
  CHECK_THAT(result.of("statistics", "machine_peak_q50")[worst], Catch::WithinAbs(6.343, 0.005));
  CHECK_THAT(result.of("tornado", "machine_peak_share_nu")[worst], Catch::WithinAbs(0.91, 0.005));
}

TEST_CASE("absorber_scatter.toml: quantiles are those of the closed form of two masses") {
  const Result result(runs::reduced("absorber_scatter", {{"r", 13}}));
  const Map map = runs::read_map(result.file());
  const auto &nu = map.coordinate("nu"), &zeta = map.coordinate("zeta"), &r = map.coordinate("r");
  constexpr double mu = 0.05;
  const auto quantiles = result.of("statistics", "machine_peak_q95");
  const auto first_order = result.of("tornado", "machine_peak_first_order_deviation");
  const auto deviations = result.of("statistics", "machine_peak_deviation");
  for (std::size_t i = 0; i < r.size(); ++i) {
    std::vector<double> peaks;
    for (std::size_t s = 0; s < nu.size(); ++s) {
      const std::complex<double> inner(nu[s] * nu[s], 2.0 * nu[s] * zeta[s] * r[i]);
      const std::complex<double> absorbed = mu * r[i] * r[i] * inner / (inner - r[i] * r[i]);
      peaks.push_back(1.0 / std::abs(1.0 - r[i] * r[i] - absorbed));
    }
    INFO("r = " << r[i]);
    CHECK_THAT(quantiles[i], Catch::WithinRel(quantile_of(peaks, 0.95), 1e-9));
    // The response bends little within the scatter, but where its slope vanishes.
    CHECK(first_order[i] < 1.5 * deviations[i]);
  }
}

TEST_CASE("regimes have no borders between samples, which lie in no order") {
  std::string text = runs::reduced("den_hartog", {});
  text = text.substr(0, text.find("[[axis]]")) +
         "[[axis]]\nsamples = 20\n[[axis.of]]\nparameter = \"f\"\ndistribution = \"uniform\"\nlower = "
         "0.1\nupper = 0.95\n"
         "[[axis]]\nparameter = \"r\"\nfrom = 0.2\nto = 1.6\npoints = 29\n[output]\nborders = true\n";
  const Result result(text);
  const auto axes = result.of_column("borders", "axis");
  CHECK(axes.size() > 20);
  CHECK(std::ranges::all_of(axes, [](double axis) { return axis == 2.0; }));
}

TEST_CASE("an axis with a name that the statistics need is refused at its place") {
  const runs::Folder folder;
  std::string text = oscillator + samples_of_k(10, "sobol", 1) +
                     "[[axis]]\nparameter = \"main_peak_mean\"\nvalues = [1, 2]\n";
  text = runs::replaced(text, "k = 1\n", "k = 1\nmain_peak_mean = 1\n");
  const runs::Outcome run = runs::frahm({"run", folder.write("study.toml", text)});
  CHECK(run.code != 0);
  CHECK_THAT(run.err, Catch::Contains("\"main_peak_mean\" is a name in the statistics of the samples"));
}

// In one folder, where each result stands beside the next study.
TEST_CASE("rig_scatter.toml: the samples have the covariance that the rig's identification found") {
  namespace fs = std::filesystem;
  const runs::Folder folder;
  const fs::path source = fs::path(FRAHM_SOURCE_DIR) / "studies/identification";
  fs::create_directories(folder / "data");
  for (const auto& entry : fs::directory_iterator(source / "data"))
    fs::copy(entry.path(), folder / ("data/" + entry.path().filename().string()));
  for (const std::string study :
       {"identify_rig_tmd_mass", "identify_rig_tmd", "identify_rig_damping_law", "rig_scatter"}) {
    const runs::Outcome run = runs::frahm(
        {"run", folder.write(study + ".toml", runs::reduced(study, {})), "-o", folder / (study + ".h5")});
    INFO(study << ": " << run.err);
    REQUIRE(run.code == 0);
  }
  const auto refused = [&](const std::string& parameters) {
    const std::string text = runs::replaced(runs::reduced("rig_scatter", {}), "\"c_I\", \"d\"", parameters);
    return runs::frahm({"check", folder.write("wrong.toml", text)}).err;
  };
  CHECK_THAT(refused("\"A\""),
             Catch::Contains("parameters: identify_rig_damping_law.h5 has no estimate \"A\""));
  CHECK_THAT(refused("\"x0_low\""), Catch::Contains("no parameter is called \"x0_low\""));
  CHECK_THAT(refused("\"m\""), Catch::Contains("\"m\" already has an axis"));
  const Map map = runs::read_map(folder / "rig_scatter.h5");
  const auto columns = MapReader(folder / "identify_rig_damping_law.h5").columns("identification");
  const auto column = [&](const std::string& name) {
    const auto found =
        std::ranges::find_if(columns, [&](const auto& each) { return each.variable.name == name; });
    REQUIRE(found != columns.end());
    return found->values;
  };
  std::vector<std::string> names;  // in the order of the covariance
  for (const auto& each : columns) {
    if (each.variable.name.ends_with("_covariance"))
      names.push_back(each.variable.name.substr(0, each.variable.name.size() - 11));
  }
  const std::vector<std::string> scattered{"m", "k", "c_const", "c_I", "d"};
  for (const std::string& a : scattered) {
    const auto row = column(a + "_covariance");
    const double deviation = std::sqrt(covariance_of(map.coordinate(a), map.coordinate(a)));
    CHECK_THAT(mean_of(map.coordinate(a)), Catch::WithinAbs(column(a).front(), 0.02 * deviation));
    for (const std::string& b : scattered) {
      INFO("covariance of " << a << " and " << b);
      const auto place = static_cast<std::size_t>(std::ranges::find(names, b) - names.begin());
      const double other = std::sqrt(covariance_of(map.coordinate(b), map.coordinate(b)));
      CHECK_THAT(covariance_of(map.coordinate(a), map.coordinate(b)),
                 Catch::WithinAbs(row[place], 0.05 * deviation * other));
    }
  }
  // So small a scatter moves the response to first order.
  const MapReader statistics(folder / "rig_scatter.h5", "statistics"),
      tornado(folder / "rig_scatter.h5", "tornado");
  const auto value = [](const MapReader& group, const std::string& name) {
    const auto& variables = group.layout().variables;
    const auto found = std::ranges::find(variables, name, &frahm::results::Variable::name);
    REQUIRE(found != variables.end());
    return group.read(static_cast<std::size_t>(found - variables.begin()), std::vector<std::uint64_t>{0},
                      shape_of(group.layout()));
  };
  const auto sampled = value(statistics, "main_peak_deviation");
  const auto first_order = value(tornado, "main_peak_first_order_deviation");
  REQUIRE(sampled.size() == 101);
  for (std::size_t i = 0; i < sampled.size(); ++i)
    CHECK_THAT(first_order[i], Catch::WithinRel(sampled[i], 1e-3));
  const auto& omega = map.coordinate("omega");
  const auto worst = static_cast<std::size_t>(std::ranges::find(omega, 194.0) - omega.begin());
  CHECK_THAT(value(statistics, "main_peak_mean").at(worst), Catch::WithinAbs(0.10239, 1e-5));
  // g^T C g of the identified covariance itself, 0.2663 mm; four hundred points miss it by half a percent.
  CHECK_THAT(sampled.at(worst), Catch::WithinRel(0.2663e-3, 0.01));
  CHECK_THAT(value(tornado, "main_peak_share_c_const").at(worst), Catch::WithinAbs(0.9, 0.01));
}

}  // namespace
}  // namespace samples_test
