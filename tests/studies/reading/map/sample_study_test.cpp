#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "studies/reading/parse_study.hpp"
#include "studies/reading/study/study.hpp"

namespace sample_study_test {
namespace {

using namespace frahm::studies;

const std::string head =
    "[study]\nschema = 1\nkind = \"sweep\"\n[parameters]\nk = { value = 300, unit = \"kN/m\" }\nc = 200\n"
    "omega = { value = 600, unit = \"rpm\" }\n[[mass]]\nname = \"main\"\nmass = 80\n"
    "[[element]]\nname = \"spring\"\ntype = \"spring\"\nbetween = [\"ground\", \"main\"]\nstiffness = \"k\"\n"
    "[[element]]\nname = \"damper\"\ntype = \"damper\"\nbetween = [\"ground\", \"main\"]\ndamping = \"c\"\n"
    "[excitation]\nfrequency = \"omega\"\n[[excitation.force]]\non = \"main\"\namplitude = 100\n";

std::string of(const std::string& parameter, const std::string& distribution, const std::string& unit = "") {
  return "[[axis.of]]\nparameter = \"" + parameter + "\"\n" + distribution +
         (unit.empty() ? "" : "unit = \"" + unit + "\"\n");
}

SweepChoice sweep_of(const std::string& axes) {
  return *parse_study(head + axes, "study.toml").sweep();
}

TEST_CASE("the values of a seed are those of its generator, to twelve digits") {
  // The first three draws of a default mt19937_64, whose seed is 5489, over 2^64.
  constexpr double first = 14514284786278117030.0, second = 4620546740167642908.0,
                   third = 13109570281517897720.0;
  const SweepChoice sweep = sweep_of("[[axis]]\nsamples = 3\nsequence = \"random\"\nseed = 5489\n" +
                                     of("c", "distribution = \"uniform\"\nlower = 0\nupper = 1\n"));
  const auto& values = sweep.axes.front().values;
  REQUIRE(values.size() == 3);
  const double draws[] = {first, second, third};
  for (std::size_t i = 0; i < 3; ++i) {
    const double share = draws[i] / 18446744073709551616.0;
    CHECK_THAT(values[i], Catch::WithinAbs(share, 5e-13));
    CHECK(values[i] * 1e12 == Catch::Detail::Approx(std::round(values[i] * 1e12)).epsilon(1e-15));
  }
}

TEST_CASE("samples have a dimension of their own, their parameters in the units of their tables") {
  const SweepChoice sweep =
      sweep_of("[[axis]]\nsamples = 16\n" +
               of("k", "distribution = \"normal\"\nmean = 300\nvariation = 0.1\n", "kN/m") +
               of("c", "distribution = \"triangular\"\nlower = 100\nmode = 150\nupper = 400\n") +
               "[[axis]]\nparameter = \"omega\"\nunit = \"rpm\"\nfrom = 300\nto = 900\npoints = 5\n");
  REQUIRE(sweep.dimensions.size() == 2);
  CHECK(sweep.dimensions[0].name == "draw");
  CHECK(sweep.dimensions[0].size == 16);
  REQUIRE(sweep.samples);
  CHECK(sweep.samples->dimension == 0);
  CHECK(sweep.samples->texts ==
        std::vector<std::string>{"normal, mean 300, variation 0.1 (kN/m)",
                                 "triangular, mode 150, lower 100, upper 400 (N s m-1)"});
  CHECK(sweep.samples->quantiles == std::vector<double>{0.05, 0.5, 0.95});
  CHECK_THAT(sweep.axes[0].si_values[3], Catch::WithinRel(1000.0 * sweep.axes[0].values[3], 1e-15));
}

TEST_CASE("rows go along the frequency's own axis, not along samples of it") {
  const std::string samples = "[[axis]]\nsamples = 8\n" +
                              of("omega", "distribution = \"uniform\"\nlower = 500\nupper = 700\n", "rpm");
  CHECK(sweep_of(samples).frequency_dimension == std::size_t{0});
  const std::string both = "[[coordinate]]\nname = \"twice\"\nvalue = \"2*k\"\n";
  const std::string driven =
      "[[axis]]\nparameter = \"k\"\nunit = \"kN/m\"\nvalues = [200, 300]\n" + samples + both;
  std::string text = head + driven;
  text.replace(text.find("frequency = \"omega\""), 19, "frequency = \"omega*k/(3e5 + 0*k)\"");
  CHECK_NOTHROW(parse_study(text, "study.toml"));
  CHECK(parse_study(text, "study.toml").sweep()->frequency_dimension == std::size_t{0});
}

TEST_CASE("quantiles are named by their percentage") {
  CHECK(quantile_name(0.05) == "q5");
  CHECK(quantile_name(0.975) == "q97_5");
  CHECK(quantile_name(0.001) == "q0_1");
  const std::string samples = "[[axis]]\nsamples = 8\nzip = \"built\"\n" +
                              of("c", "distribution = \"uniform\"\nlower = 1\nupper = 2\n");
  const SweepChoice sweep = sweep_of(samples + "[output]\nquantiles = [0.1, 0.999]\n");
  CHECK(sweep.dimensions.front().name == "built");
  CHECK(sweep.samples->quantiles == std::vector<double>{0.1, 0.999});
}

}  // namespace
}  // namespace sample_study_test
