#include "solvers/mechanics/element_table.hpp"

#include <algorithm>

#include "solvers/laws/coulomb.hpp"
#include "solvers/laws/damper_bend.hpp"
#include "solvers/laws/elastic_stop.hpp"
#include "solvers/laws/jenkins.hpp"
#include "solvers/laws/spring_bend.hpp"

namespace frahm::mechanics {
namespace {

constexpr ElementKind kKinds[] = {
    {.type = ElementType::spring,
     .name = "spring",
     .force = "k u + cubic u^3",
     .value = {"stiffness", "k", Dimension::stiffness, Range::finite},
     .adds = [](auto k, auto, auto) { return Added<decltype(k)>{.stiffness = k}; },
     .holds = true,
     .cubic = {"cubic", "", Dimension::cubic_stiffness, Range::finite, true, ForceLaw::cubic},
     .stroke_is_standard = true,
     .table = &laws::spring_bend},
    {.type = ElementType::damper,
     .name = "damper",
     .force = "c v",
     .value = {"damping", "c", Dimension::damping, Range::not_negative},
     .adds = [](auto c, auto, auto) { return Added<decltype(c)>{.damping = c}; },
     .dissipates = true,
     .table = &laws::damper_bend},
    {.type = ElementType::inerter,
     .name = "inerter",
     .force = "b v'",
     .value = {"inertance", "b", Dimension::inertance, Range::not_negative},
     .adds = [](auto b, auto, auto) { return Added<decltype(b)>{.inertance = b}; }},
    {.type = ElementType::coulomb,
     .name = "coulomb",
     .force = "F sgn(v) while it slides, at rest up to F_s",
     .value = {"force", "F", Dimension::force, Range::not_negative},
     .second = {"static_force", "F_s", Dimension::force, Range::not_negative, true, ForceLaw::exact},
     .adds = [](auto F, auto, auto) { return Added<decltype(F)>{.limit = F}; },
     .law = &laws::coulomb,
     .dissipates = true,
     .slope = {"slope", "", Dimension::inverse_speed, Range::positive, false, ForceLaw::arctan}},
    {.type = ElementType::hysteretic,
     .name = "hysteretic",
     .force = "k u + (eta k / omega_h) v: the complex stiffness k (1 + i eta) at omega_h",
     .value = {"stiffness", "k", Dimension::stiffness, Range::not_negative},
     .second = {"loss_factor", "eta", Dimension::number, Range::not_negative},
     .adds = [](auto k, auto eta,
                auto omega_h) { return Added<decltype(k)>{.stiffness = k, .damping = eta * k / omega_h}; },
     .dissipates = true,
     .depends_on_frequency = true,
     .holds = true},
    {.type = ElementType::maxwell,
     .name = "maxwell",
     .force = "s, s' = k v - (k/c) s: a spring and a damper in series",
     .value = {"stiffness", "k", Dimension::stiffness, Range::positive},
     .second = {"damping", "c", Dimension::damping, Range::positive},
     .adds =
         [](auto k, auto c, auto) {
           return Added<decltype(k)>{.internal_stiffness = k, .internal_rate = k / c, .internal_damping = c};
         },
     .has_internal_force = true,
     .dissipates = true},
    {.type = ElementType::jenkins,
     .name = "jenkins",
     .force = "s, s' = k v while its slider sticks, s = +-F while it slides",
     .value = {"stiffness", "k", Dimension::stiffness, Range::positive},
     .second = {"force", "F", Dimension::force, Range::not_negative},
     .adds = [](auto k, auto F, auto) { return Added<decltype(k)>{.limit = F, .internal_stiffness = k}; },
     .law = &laws::jenkins,
     .has_internal_force = true,
     .dissipates = true},
    {.type = ElementType::gap,
     .name = "gap",
     .force =
         "k (abs(u) - D) + c abs(u)' towards the middle beyond the clearance D on either side, 0 within it",
     .value = {"stiffness", "k", Dimension::stiffness, Range::not_negative},
     .second = {"damping", "c", Dimension::damping, Range::not_negative, true},
     .adds = [](auto k, auto, auto) { return Added<decltype(k)>{}; },
     .dissipates = true,
     .stroke_is_standard = true,
     .stop = &laws::elastic_stop,
     .pulling_stop = &laws::spring_bend},
};

constexpr bool rows_stand_as_enumerators_do() {
  std::size_t row = 0;
  for (const ElementKind& kind : kKinds) {
    if (kind.type != static_cast<ElementType>(row++)) return false;
  }
  return true;
}
static_assert(rows_stand_as_enumerators_do(), "kind_of() looks a row up by its ElementType");

const Element* first_element(const Network& network, bool (*is_meant)(const ElementKind&)) {
  for (const Element& element : network.elements) {
    if (is_meant(kind_of(element))) return &element;
  }
  return nullptr;
}

}  // namespace

std::span<const ElementKind> element_kinds() {
  return kKinds;
}

const ElementKind& kind_of(ElementType type) {
  return kKinds[static_cast<std::size_t>(type)];
}

bool ElementKind::is_inertia_alone() const {
  const Added<double> unit = adds(1.0, 1.0, 1.0);
  return unit.stiffness == 0.0 && unit.damping == 0.0 && law == nullptr && !has_internal_force &&
         stop == nullptr;
}

bool is_linear(const Element& element) {
  return !has_contact(element) && element.bends.empty() && element.law == ForceLaw::exact;
}

std::size_t reported_by(const Network& network, std::size_t e) {
  while (network.elements[e].parts == 0) --e;
  return e;
}

const Element* frequency_dependent_element(const Network& network) {
  return first_element(network, [](const ElementKind& kind) { return kind.depends_on_frequency; });
}

const Element* element_unfit_for_noise(const Network& network) {
  const auto is_unfit = [](const Element& element) {
    return !is_linear(element) || kind_of(element).depends_on_frequency;
  };
  const auto found = std::ranges::find_if(network.elements, is_unfit);
  return found == network.elements.end() ? nullptr : &*found;
}

double number_of(const NetworkValues& values, std::size_t i, std::size_t e) {
  if (i == 0) return values.element[e];
  if (i == 1) return second_value(values, e);
  return e < values.smooth.size() ? values.smooth[e].*smooth_numbers.at(i - first_smooth_number) : 0.0;
}

double second_value(const NetworkValues& values, std::size_t element) {
  return element < values.second.size() ? values.second[element] : 0.0;
}

double static_force(const Element& element, const NetworkValues& values, std::size_t index) {
  return element.has_static_force && element.law == ForceLaw::exact ? second_value(values, index) : 0.0;
}

}  // namespace frahm::mechanics
