#include <catch2/catch.hpp>
#include <sstream>
#include <string>

#include "studies/motion/one_motion.hpp"
#include "studies/reading/parse_study.hpp"
#include "studies/reading/study/study.hpp"

namespace decay_words_test {
namespace {

using namespace frahm::studies;

std::string words_of_decay(const std::string& damping) {
  const Study study = parse_study(
      "[study]\nschema = 1\nkind = \"decay\"\nunits = \"SI\"\n[[mass]]\nname = \"main\"\nmass = 1\n"
      "[[element]]\nname = \"spring\"\ntype = \"spring\"\nbetween = [\"ground\", \"main\"]\nstiffness = 1\n"
      "[[element]]\nname = \"damper\"\ntype = \"damper\"\nbetween = [\"ground\", \"main\"]\ndamping = " +
          damping +
          "\n[[element]]\nname = \"guide\"\ntype = \"coulomb\"\nbetween = [\"ground\", \"main\"]\nforce = "
          "0.1\n"
          "[[initial]]\nnode = \"main\"\ndisplacement = 1\n",
      "decay.toml");
  std::ostringstream words;
  print_decay(study, solve_decay(study), words);
  return words.str();
}

// With zeta = 0.95 it passes its rest by 1e-4 and is stopped at pi/omega_d; with 0.995 by 2e-14; with 1 it
// never is.
TEST_CASE("A decay that friction stops is never said never to arrive") {
  CHECK_THAT(words_of_decay("1.9"), Catch::Contains("comes to rest at 10.06114863 s"));
  CHECK_THAT(words_of_decay("1.99"), Catch::Contains("creeps towards its rest") && !Catch::Contains("never"));
  CHECK_THAT(words_of_decay("2"), Catch::Contains("creeps towards its rest") && !Catch::Contains("never"));
}

}  // namespace
}  // namespace decay_words_test
