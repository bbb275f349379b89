#include <catch2/catch.hpp>
#include <sstream>
#include <string>

#include "studies/motion/one_motion.hpp"
#include "studies/reading/parse_study.hpp"
#include "studies/reading/study/study.hpp"

namespace transient_words_test {
namespace {

using namespace frahm::studies;

// A block let go on a spring, with what else the study reports of it.
std::string words_of_motion(const std::string& more) {
  const Study study = parse_study(
      "[study]\nschema = 1\nkind = \"transient\"\nunits = \"SI\"\n[parameters]\n"
      "r = { value = 0.5, unit = \"m\" }\n[[mass]]\nname = \"block\"\nmass = 1\n"
      "[[element]]\nname = \"spring\"\ntype = \"spring\"\nbetween = [\"ground\", \"block\"]\nstiffness = 1\n"
      "[excitation]\nfrequency = 1\n[[excitation.force]]\non = \"block\"\norder = 0\namplitude = 1\n"
      "[transient]\nduration = 4\n" +
          more,
      "transient.toml");
  std::ostringstream words;
  print_transient(study, solve_transient(study), words);
  return words.str();
}

TEST_CASE("The peaks of a motion have the unit of what moves, also where a signal alone is an angle") {
  CHECK_THAT(words_of_motion(""), Catch::Contains("peak [m]"));
  const std::string with_angle =
      words_of_motion("[[output.signal]]\nname = \"turn\"\nalong = { block = \"1/r\" }\n");
  // A load suddenly applied moves the block by twice P/k = 1 m: 4 rad over the radius.
  CHECK_THAT(with_angle, Catch::Contains("peak [SI]") && !Catch::Contains("[m]"));
  CHECK_THAT(with_angle, Catch::Matches("(.|\n)*\nblock +2 .* m\nturn +4 .* rad\n(.|\n)*"));
}

}  // namespace
}  // namespace transient_words_test
