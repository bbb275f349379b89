// What `frahm explain` tells comes from the tables that the readers and solvers use.
#include "studies/program/explain_command.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <sstream>
#include <string>

#include "studies/reading/keys/element_keys.hpp"
#include "studies/reading/keys/study_keys.hpp"
#include "studies/reading/quantities/units.hpp"
#include "studies/tuning/outcome_words.hpp"

namespace explain_command_test {
namespace {

using namespace frahm::studies;
using namespace frahm::mechanics;

std::string explained(const std::string& word) {
  std::ostringstream out;
  explain_command(word, out);
  return out.str();
}

}  // namespace

TEST_CASE("every type of element is explained by its force and its keys with units and ranges") {
  for (const ElementKind& kind : frahm::mechanics::element_kinds()) {
    INFO(kind.name);
    const std::string text = explained(kind.name);
    CHECK_THAT(text, Catch::Contains(std::string("its force is ") + kind.force));
    for (const ValueKey* value : kind.values()) {
      if (!value->exists()) continue;
      const Quantity quantity = element_quantity(value->dimension, false);
      CHECK_THAT(text, Catch::Contains("  " + std::string(value->key)) &&
                           Catch::Contains("[" + std::string(written_si_unit(quantity)) + "]"));
    }
    for (const std::string& key : keys_of_type(kind.name)) CHECK_THAT(text, Catch::Contains("\n  " + key));
  }
  CHECK_THAT(explained("spring"),
             Catch::Contains("stiffness = k [N/m], for a rotation [N m/rad], any number"));
  CHECK_THAT(explained("maxwell"), Catch::Contains("damping = c [N s/m], for a rotation [N m s/rad], > 0"));
  CHECK_THAT(explained("coulomb"),
             Catch::Contains("static_force = F_s") && Catch::Contains(">= 0; may be left out"));
  CHECK_THAT(explained("gap"), Catch::Contains("on either side") && Catch::Contains("[lower, upper]"));
  CHECK_THAT(explained("tension"), Catch::Contains("may also pull"));
  CHECK_THAT(explained("mass.mass"), Catch::Contains("0 where an inerter moves with it, or of a joint"));
  CHECK_THAT(explained("nrmse"), Catch::Contains("100 is a perfect fit"));
  CHECK_THAT(explained("iwan"), Catch::Contains("jenkins") && Catch::Contains("\n  chi: "));
}

TEST_CASE("every word of a choice is explained with the key that it is of") {
  for (const StudyKey& key : study_keys()) {
    for (const StudyWord& each : key.words) {
      INFO(key.section << "." << key.key << " = " << each.word);
      CHECK_THAT(explained(each.word), Catch::Contains(key.key) &&
                                           Catch::Contains(written_section(key.section)) &&
                                           Catch::Contains(each.meaning));
    }
  }
}

TEST_CASE("a key that not all forms of its section have is told with those that have it") {
  CHECK_THAT(explained("ground_damping"), Catch::Contains("for generate = kanai_tajimi"));
  CHECK_THAT(explained("compare"), Catch::Contains("for kind = sweep"));
  CHECK_THAT(explained("element.type"), Catch::Contains("spring, damper") && Catch::Contains("or iwan"));
}

TEST_CASE("a key is explained with what it is where it is left out") {
  CHECK_THAT(explained("starts"), Catch::Contains("starts; default 8\n"));
  CHECK_THAT(explained("tolerance"), Catch::Contains("; default 1e-06"));
  CHECK_THAT(explained("borders"), Catch::Contains("; default false; for kind = sweep"));
  for (const StudyKey& key : study_keys()) {
    if (!key.by_default) continue;
    INFO(key.section << ": " << key.key);
    CHECK(key.limits.hold(*key.by_default));
    CHECK((key.form == KeyForm::number || key.form == KeyForm::integer || key.form == KeyForm::boolean ||
           key.form == KeyForm::choice));
    CHECK_THAT(explained(key.key), Catch::Contains("; default "));
  }
}

TEST_CASE("a word of a choice that is misspelt gets the nearest one") {
  CHECK_THROWS_WITH(explained("kanai_tajimy"), Catch::Contains("did you mean \"kanai_tajimi\""));
}

TEST_CASE("every outcome of a tuning is explained, also where a point has a status of that name") {
  for (const std::string& word : outcome_words()) {
    INFO(word);
    CHECK_THAT(explained(word), Catch::Contains(word + ": outcome of a tuning"));
  }
  CHECK_THAT(explained("infeasible"), Catch::Contains("no design met the limits"));
  CHECK_THAT(explained("failed"), Catch::Contains("failed: status: "));
}

TEST_CASE("a unit is explained with every quantity that may have it, as the reader takes it") {
  for (const char* unit : {"Hz", "kN/mm", "gravity", "g", "N m", "rpm"}) {
    INFO(unit);
    const Unit read = UnitSystem().parse(unit);
    REQUIRE_FALSE(quantities_in(read).empty());
    for (const Quantity quantity : quantities_in(read))
      CHECK_THAT(explained(unit), Catch::Contains(fmt::format(
                                      "{0}: unit of {1}: 1 {0} = {2:.10g} {3}", unit, quantity_name(quantity),
                                      si_factor(read, quantity), written_si_unit(quantity))));
  }
  CHECK_THAT(explained("Hz"), Catch::Contains("1 Hz = 6.283185307 rad/s, as it counts cycles"));
  CHECK_THAT(explained("gravity"), Catch::Contains("1 gravity = 9.80665 m/s2"));
  CHECK_THAT(explained("g"), Catch::Contains("1 g = 0.001 kg") && Catch::Contains("the same as gravity"));
  CHECK(explained("%") == "%: unit of a pure number: 1 % = 0.01; such as 1 or %\n");
  CHECK_THAT(explained("K"), Catch::Contains("a temperature"));
  CHECK_THAT(explained("force"), !Catch::Contains("unit of"));
}
}  // namespace explain_command_test
