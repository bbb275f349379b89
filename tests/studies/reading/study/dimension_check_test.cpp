#include <catch2/catch.hpp>
#include <string>

#include "studies/reading/parse_study.hpp"
#include "studies/reading/study/study.hpp"

namespace dimension_check_test {
namespace {

using frahm::studies::parse_study;

// A mass whose spring, force and frequency are given.
std::string study(const std::string& parameters, const std::string& stiffness, const std::string& force,
                  const std::string& frequency = "omega") {
  return "[study]\nschema = 1\nkind = \"sweep\"\n[parameters]\nomega = { value = 20, unit = \"rad/s\" }\n" +
         parameters +
         "\n[[mass]]\nname = \"main\"\nmass = 1\n[[element]]\nname = \"spring\"\ntype = \"spring\"\n"
         "between = [\"ground\", \"main\"]\nstiffness = \"" +
         stiffness + "\"\n[excitation]\nfrequency = \"" + frequency +
         "\"\n[[excitation.force]]\non = \"main\"\namplitude = \"" + force +
         "\"\n[[axis]]\nparameter = \"omega\"\nvalues = [10, 20]\n";
}

void check_refused(const std::string& text, const std::string& part) {
  INFO(text);
  CHECK_THROWS_WITH(parse_study(text, "small.toml"), Catch::Contains(part));
}

TEST_CASE("a derived parameter has the dimension of its expression, through any number of others") {
  const std::string chain = "K = { value = 1, unit = \"kN/m\" }\nhalf = \"K/2\"\nthird = \"half/3\"\n";
  CHECK_NOTHROW(parse_study(study(chain, "half + third", "3"), "small.toml"));
  check_refused(study(chain, "4", "third"),
                "amplitude: the expression is a stiffness (N/m), but a force (N)");
}

TEST_CASE("a law of the frequency alone may leave its factor out, where no frequency is expected") {
  CHECK_NOTHROW(parse_study(study("", "5e3 - omega", "omega^2"), "small.toml"));
  check_refused(study("", "5e3", "1", "omega^2"), "frequency: the expression is an angular acceleration");
}

TEST_CASE("numbers without units have no dimension that could be wrong") {
  CHECK_NOTHROW(parse_study(study("k = 9\nm = 3", "k + m", "k/m + sqrt(m)", "k*m"), "small.toml"));
}

TEST_CASE("dimensions are not checked where there are none") {
  const std::string bare = study("", "omega^2", "exp(omega) + omega");
  std::string dimensionless = bare;
  dimensionless.replace(dimensionless.find("{ value = 20, unit = \"rad/s\" }"), 30, "20");
  dimensionless.insert(dimensionless.find("[parameters]"), "units = \"dimensionless\"\n");
  CHECK_NOTHROW(parse_study(dimensionless, "small.toml"));
  check_refused(bare, "exp takes a pure number");
}

}  // namespace
}  // namespace dimension_check_test
