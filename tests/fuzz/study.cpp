// Any text as a study: read and planned as `frahm check` does, up to its modes at the first point, or
// refused.
#include "studies/reading/study/study.hpp"

#include <cstddef>
#include <cstdint>
#include <string>

#include "solvers/mechanics/linear_system.hpp"
#include "studies/map/first_modes.hpp"
#include "studies/map/map_plan.hpp"
#include "studies/program/modes_table.hpp"
#include "studies/reading/parse_study.hpp"
#include "tests/fuzz/outcome.hpp"

namespace {

using namespace frahm;

// The tables that studies name beside them.
const char* const place = FRAHM_SOURCE_DIR "/tests/studies/reading/wrong/fuzzed.toml";

void look_at_modes(const studies::MapPlan& plan) {
  constexpr std::size_t few_masses = 20;  // more take longer, not another way
  if (plan.study.network.masses.size() > few_masses) return;
  try {
    studies::modes_at_point(plan.study, studies::values_at_first_point(plan.study));
  } catch (const mechanics::MechanicsError&) {  // told as "No modes"
  }
}

void check(std::string text) {
  studies::Study study = studies::parse_study(std::move(text), place, studies::DataFiles::leave);
  if (!study.map()) {
    studies::plan_without_map(std::move(study), {});
    return;
  }
  look_at_modes(studies::plan_map(std::move(study), {}));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    check(std::string(reinterpret_cast<const char*>(data), size));
    fuzz::count(fuzz::Outcome::read);
  } catch (const studies::StudyError&) {
    fuzz::count(fuzz::Outcome::refused);
  }
  return 0;
}
