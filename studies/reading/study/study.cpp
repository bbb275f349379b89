#include "studies/reading/study/study.hpp"

#include <algorithm>
#include <utility>

#include "solvers/mechanics/bends.hpp"
#include "solvers/mechanics/smooth_laws.hpp"
#include "studies/reading/keys/study_keys.hpp"

namespace frahm::studies {

std::string_view kind_name(StudyKind kind) {
  return study_key("study", "kind").words[static_cast<std::size_t>(kind)].word;
}

std::string_view kind_noun(StudyKind kind) {
  switch (kind) {
    case StudyKind::sweep:
      return "a sweep";
    case StudyKind::decay:
      return "a decay";
    case StudyKind::transient:
      return "a transient";
    case StudyKind::tune:
      return "a tuning";
    case StudyKind::identify:
      return "an identification";
  }
  return "a study";
}

mechanics::FreeMasses free_masses(StudyKind kind, const mechanics::Network& network) {
  const auto is_recorded = [](const mechanics::Excitation& each) {
    return mechanics::is_recorded(each.kind);
  };
  const bool is_of_responses =
      kind == StudyKind::sweep ||
      (kind == StudyKind::tune && std::ranges::none_of(network.excitations, is_recorded));
  const bool is_motion = kind == StudyKind::decay || kind == StudyKind::transient;
  const bool may_be = is_motion || (is_of_responses && !mechanics::has_smooth_law(network) &&
                                    network.joints.empty() && !mechanics::has_stop(network));
  return may_be ? mechanics::FreeMasses::allowed : mechanics::FreeMasses::refused;
}

const MapChoice* Study::map() const {
  if (sweep()) return sweep();
  return transient() && transient()->map ? &*transient()->map : nullptr;
}

MapChoice* Study::map() {
  return const_cast<MapChoice*>(std::as_const(*this).map());
}

const MotionChoice* Study::motion() const {
  if (decay()) return decay();
  return transient();
}

MotionChoice* Study::motion() {
  return const_cast<MotionChoice*>(std::as_const(*this).motion());
}

periodic::OrbitsWanted Study::orbits_wanted() const {
  if (tune()) return tune()->orbits;
  return sweep() ? sweep()->orbits : periodic::OrbitsWanted{};
}

std::span<const InitialValues> Study::initial() const {
  if (identify()) return identify()->initial;
  return motion() ? std::span(motion()->initial) : std::span<const InitialValues>();
}

std::vector<const StudyValue*> Study::values_of_its_kind() const {
  std::vector<const StudyValue*> all;
  if (sweep()) all = sweep()->values();
  if (map()) {
    for (const DerivedCoordinate& coordinate : map()->coordinates) all.push_back(&coordinate.value);
  }
  const auto add = [&](const std::optional<StudyValue>& value) {
    if (value) all.push_back(&*value);
  };
  if (motion()) add(motion()->duration);
  if (decay()) add(decay()->reference_frequency);
  if (transient()) {
    add(transient()->sweep_to);
    add(transient()->sweep_rate);
  }
  for (const InitialValues& of_mass : initial())
    all.insert(all.end(), {&of_mass.displacement, &of_mass.velocity});
  if (identify()) {
    const auto more = identify()->values();
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

void set_along(const MapChoice& map, std::size_t dimension, std::size_t index, std::span<double> parameters) {
  for (const std::size_t axis : map.dimensions[dimension].axes) {
    parameters[map.axes[axis].parameter] = map.axes[axis].si_values[index];
  }
}

std::vector<std::size_t> dimensions_moving(const Study& study, std::span<const std::size_t> reads) {
  std::vector<std::size_t> moving;
  const MapChoice* map = study.map();
  if (!map) return moving;
  const auto inputs = study.parameters.inputs_of(reads);
  const auto is_input = [&](std::size_t axis) {
    return std::find(inputs.begin(), inputs.end(), map->axes[axis].parameter) != inputs.end();
  };
  for (std::size_t d = 0; d < map->dimensions.size(); ++d) {
    const auto& axes = map->dimensions[d].axes;
    if (std::any_of(axes.begin(), axes.end(), is_input)) moving.push_back(d);
  }
  return moving;
}

bool runs_over_band(const TuneChoice& tune, std::size_t parameter) {
  return tune.band && tune.band->parameter == parameter;
}

bool has_axis(const Study& study, std::size_t parameter) {
  return study.map() ? of_parameter(study.map()->axes, parameter) != nullptr
                     : study.tune() && runs_over_band(*study.tune(), parameter);
}

UsualUnit usual_unit(const Study& study, std::size_t parameter) {
  if (study.map()) {
    if (const auto* axis = of_parameter(study.map()->axes, parameter)) return {axis->unit, axis->si_factor};
  }
  if (study.tune()) {
    if (runs_over_band(*study.tune(), parameter)) return study.tune()->band->unit;
    if (const auto* design = of_parameter(study.tune()->designs, parameter)) return design->unit;
  }
  if (study.identify()) {
    if (const auto* fitted = of_parameter(study.identify()->parameters, parameter)) return fitted->unit;
  }
  const Parameter& definition = study.parameters.list[parameter];
  if (!definition.unit) return {};
  return {definition.unit->text, si_factor(definition, *definition.unit)};
}

}  // namespace frahm::studies
