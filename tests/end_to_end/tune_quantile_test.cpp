// studies/uncertainty/tune_quantile.toml: the tuned slip force against a map of the same motions.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/end_to_end/runs.hpp"
#include "tests/study_path.hpp"

namespace tune_quantile_test {
namespace {

constexpr double certified = 1e-6;  // the certificate gap, as promised
constexpr double same = 1e-8;       // relative, of a quantile by the tuning and by a map
constexpr double no_higher = 1e-4;  // relative, than the least of the scan
constexpr std::size_t records = 2, samples = 20, kth = 18;

// The study as a transient over its records, its samples and slip forces: of each force the worst drifts of
// all samples, sorted, of which the k-th is the quantile.
std::vector<double> quantiles_at(double from, double to, int points) {
  std::ifstream file(study_path("tune_quantile"));
  std::stringstream whole;
  whole << file.rdbuf();
  std::string text = whole.str();
  const std::size_t tune = text.find("[tune]"), first = text.find("records   = "),
                    last = text.find("duration  = 11");
  const std::size_t axis = text.find("[[axis]]");
  REQUIRE(axis != std::string::npos);
  std::ostringstream changed;
  changed.precision(17);
  changed << text.substr(0, tune) << "[transient]\nduration = 11\n\n[[axis]]\n"
          << text.substr(first, last - first) << "\n"
          << text.substr(axis) << "\n[[axis]]\nparameter = \"F\"\nunit = \"kN\"\n";
  if (points == 1)
    changed << "values = [" << from << "]\n";
  else
    changed << "from = " << from << "\nto = " << to << "\npoints = " << points << "\n";
  changed << "\n[output]\nquantities = [\"columns_stroke\"]\n";
  const std::vector<double> all = runs::run_study(
      runs::replaced(changed.str(), "kind   = \"tune\"", "kind   = \"transient\""))["columns_stroke"];
  const auto forces = static_cast<std::size_t>(points);
  REQUIRE(all.size() == records * samples * forces);
  std::vector<double> quantiles;
  for (std::size_t f = 0; f < forces; ++f) {
    std::vector<double> worst(samples, 0.0);
    for (std::size_t r = 0; r < records; ++r) {
      for (std::size_t s = 0; s < samples; ++s)
        worst[s] = std::max(worst[s], all[(r * samples + s) * forces + f]);
    }
    std::ranges::sort(worst);
    quantiles.push_back(worst[kth - 1]);
  }
  return quantiles;
}

TEST_CASE("tune_quantile.toml: no slip force of a dense scan has a smaller quantile of the worst drifts",
          "[long]") {
  const runs::Folder folder;
  const std::string file = folder / "tuned.h5";
  const runs::Outcome run = runs::frahm({"run", study_path("tune_quantile"), "-o", file});
  INFO(run.err << run.out);
  REQUIRE(run.code == 0);
  CHECK_THAT(run.out, Catch::Contains("20 points of sobol, seed 1, of which the share 0.9 counts"));
  std::map<std::string, std::vector<double>> optimum;
  const frahm::results::MapReader reader(file);
  for (const frahm::results::Column& column : reader.columns("optimum"))
    optimum[column.variable.name] = column.values;
  const double objective = optimum["objective"][0], F = optimum["F"][0];
  CHECK(optimum["outcome"][0] == 1.0);
  CHECK(std::abs(optimum["certificate_gap"][0]) <= certified);
  CHECK(optimum["peak_value"].size() == records * samples);
  CHECK(std::abs(quantiles_at(F, F, 1)[0] - objective) <= same * objective);
  const std::vector<double> wide = quantiles_at(1.0, 60.0, 60);
  const std::vector<double> near = quantiles_at(0.98 * F, 1.02 * F, 41);
  const double least = std::min(*std::ranges::min_element(wide), *std::ranges::min_element(near));
  INFO("F = " << F << ", tuned " << objective << ", least " << least);
  CHECK(objective <= least * (1.0 + no_higher));
}

}  // namespace
}  // namespace tune_quantile_test
