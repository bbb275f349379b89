#include "studies/motion/motion_columns.hpp"

#include <algorithm>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/coordinates.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/rotation.hpp"
#include "solvers/mechanics/structural_damping.hpp"
#include "studies/reading/study/study_units.hpp"

namespace frahm::studies {

void MotionColumns::add(const Named& named, std::string_view unit, const std::string& dimension,
                        std::vector<double> values, std::size_t size) {
  values.resize(std::max(size, values.size()), kNone);
  const std::string written(study_.dimensionless && unit != "rad" ? "1" : unit);
  columns_.push_back({variable(named, written), dimension, std::move(values)});
}

void MotionColumns::add_quantity(const transient::MotionQuantity& quantity, double value) {
  const auto description = transient::describe(quantity, study_.network, false);
  add_number(Named::by_study(description.name, description.long_name), description.unit, value);
}

void MotionColumns::add_frequencies(const Named& named, const std::string& dimension,
                                    std::vector<double> omega) {
  const UsualUnit unit = frequency_unit_in_file(study_);
  for (double& each : omega) each /= unit.si_factor;
  add(named, unit.text, dimension, std::move(omega));
}

void MotionColumns::add_samples(const transient::Samples& samples) {
  add("time", "s", "time", samples.time);
  for (std::size_t i = 0; i < mechanics::coordinate_count(study_.network); ++i) {
    const std::string& name = mechanics::coordinate_name(study_.network, i);
    const auto unit = [&](const char* linear) {
      return mechanics::coordinate_unit(study_.network, i, linear);
    };
    add({"*_displacement", name}, unit("m"), "time", samples.displacement[i]);
    add({"*_velocity", name}, unit("m s-1"), "time", samples.velocity[i]);
    if (i >= study_.network.masses.size())
      add({"*_acceleration", name}, unit("m s-2"), "time", samples.acceleration[i]);
  }
  for (std::size_t e = 0; e < study_.network.elements.size(); ++e) {
    const mechanics::Element& element = study_.network.elements[e];
    if (!mechanics::kind_of(element).dissipates || element.parts == 0) continue;
    add({"*_dissipated", element.name}, "J", "time", samples.dissipated[e]);
  }
  if (mechanics::has_structural_damping(study_.network))
    add({"*_dissipated", {"damping"}, {"the damping of the structure"}}, "J", "time",
        samples.dissipated.back());
}

}  // namespace frahm::studies
