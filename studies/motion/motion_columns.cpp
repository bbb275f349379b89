#include "studies/motion/motion_columns.hpp"

#include <algorithm>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/coordinates.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/rotation.hpp"
#include "solvers/mechanics/structural_damping.hpp"
#include "studies/motion/motion_columns.hpp"
#include "studies/reading/study/study_units.hpp"

namespace frahm::studies {

void MotionColumns::add(const std::string& name, std::string_view unit, const std::string& long_name,
                        const std::string& dimension, std::vector<double> values, std::size_t size) {
  values.resize(std::max(size, values.size()), kNone);
  const std::string written(study_.dimensionless && unit != "rad" ? "1" : unit);
  columns_.push_back({.variable = {.name = name, .unit = written, .long_name = long_name},
                      .dimension = dimension,
                      .values = std::move(values)});
}

void MotionColumns::add_number(const std::string& name, std::string_view unit, const std::string& long_name,
                               double value) {
  add(name, unit, long_name, "", {value});
}

void MotionColumns::add_frequencies(const std::string& name, const std::string& long_name,
                                    const std::string& dimension, std::vector<double> omega) {
  const UsualUnit unit = frequency_unit_in_file(study_);
  for (double& each : omega) each /= unit.si_factor;
  add(name, unit.text, long_name, dimension, std::move(omega));
}

void MotionColumns::add_samples(const transient::Samples& samples) {
  add("time", "s", "time since the initial values", "time", samples.time);
  for (std::size_t i = 0; i < mechanics::coordinate_count(study_.network); ++i) {
    const std::string& name = mechanics::coordinate_name(study_.network, i);
    const auto unit = [&](const char* linear) {
      return mechanics::coordinate_unit(study_.network, i, linear);
    };
    add(name + "_displacement", unit("m"), "displacement of " + name, "time", samples.displacement[i]);
    add(name + "_velocity", unit("m s-1"), "velocity of " + name, "time", samples.velocity[i]);
    if (i >= study_.network.masses.size())
      add(name + "_acceleration", unit("m s-2"), "acceleration of " + name, "time", samples.acceleration[i]);
  }
  for (std::size_t e = 0; e < study_.network.elements.size(); ++e) {
    const mechanics::Element& element = study_.network.elements[e];
    if (!mechanics::kind_of(element).dissipates || element.parts == 0) continue;
    const std::string& name = element.name;
    add(name + "_dissipated", "J", "energy dissipated so far by " + name, "time", samples.dissipated[e]);
  }
  if (mechanics::has_structural_damping(study_.network))
    add("damping_dissipated", "J", "energy dissipated so far by the damping of the structure", "time",
        samples.dissipated.back());
}

}  // namespace frahm::studies
