#include "studies/page/crank_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solvers/mechanics/crank.hpp"
#include "studies/motion/motion_columns.hpp"

namespace frahm::studies {
namespace {

using mechanics::crank_displacement;

std::vector<double> angles_of_a_turn() {
  std::vector<double> angles;
  for (int i = 0; i < kCrankAngles; ++i) angles.push_back(2.0 * std::numbers::pi * i / (kCrankAngles - 1));
  return angles;
}

void add_crank(MotionColumns& columns, const std::string& name, double radius, double rod) {
  const std::vector<double> angles = angles_of_a_turn();
  std::vector<double> motion;
  for (const double angle : angles) motion.push_back(crank_displacement(radius, rod, angle));
  columns.add({"*_motion", name}, "m", "angle", motion);
  for (const int order : {1, 2, 4}) {
    std::vector<double> cut, error;
    for (std::size_t i = 0; i < angles.size(); ++i) {
      cut.push_back(crank_displacement(radius, rod, angles[i], order));
      error.push_back(std::abs(cut[i] - motion[i]) / (motion[i] + rod));
    }
    const std::vector<std::string> words{name, std::to_string(order)};
    columns.add({"*_taylor_*", words, words}, "m", "angle", cut);
    columns.add({"*_taylor_*_error", words, words}, "1", "angle", error);
  }
}

// A name for the next crank on a node.
std::string next_name(const std::string& node, std::vector<std::string>& taken) {
  std::string name = node;
  for (int number = 2; std::find(taken.begin(), taken.end(), name) != taken.end(); ++number)
    name = fmt::format("{}_{}", node, number);
  taken.push_back(name);
  return name;
}

}  // namespace

std::vector<results::Column> crank_motions(const Study& study) {
  const auto& excitations = study.network.excitations;
  const auto is_crank = [](const auto& e) { return e.kind == mechanics::ExcitationKind::crank; };
  MotionColumns columns(study);
  if (std::none_of(excitations.begin(), excitations.end(), is_crank)) return columns.take();
  columns.add("angle", "rad", "angle", angles_of_a_turn());
  std::vector<double> parameters = study.parameters.nominal();
  mechanics::NetworkValues values;
  evaluate(study.values, study.parameters, parameters, values);
  std::vector<std::string> taken;
  for (std::size_t k = 0; k < excitations.size(); ++k) {
    if (!is_crank(excitations[k])) continue;
    const std::string name = next_name(study.network.prescribed[excitations[k].node], taken);
    add_crank(columns, name, values.excitation[k].amplitude, values.excitation[k].rod);
  }
  return columns.take();
}

}  // namespace frahm::studies
