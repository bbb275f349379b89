#include "tests/invariants/shrinking.hpp"

#include <algorithm>
#include <functional>

namespace frahm::invariants {
namespace {

using namespace mechanics;

bool still_violates(const Case& smaller, const Violation& violation) {
  if (smaller.network.masses.empty() || smaller.network.excitations.empty()) return false;
  const auto violations = violations_of(smaller, nullptr, violation.invariant);
  return std::any_of(violations.begin(), violations.end(),
                     [&](const Violation& other) { return other.same_kind(violation); });
}

template <class List>
void drop(List& list, std::size_t place) {
  list.erase(list.begin() + static_cast<std::ptrdiff_t>(place));
}

void drop_element(Case& c, std::size_t e) {
  drop(c.network.elements, e);
  drop(c.values.element, e);
  drop(c.values.second, e);
}

void drop_excitation(Case& c, std::size_t k) {
  drop(c.network.excitations, k);
  drop(c.values.excitation, k);
}

// With its elements and forces.
void drop_mass(Case& c, std::size_t i) {
  const Node gone{NodeKind::mass, i};
  for (std::size_t e = c.network.elements.size(); e-- > 0;) {
    const Direction& along = c.network.elements[e].along;
    if (std::ranges::find(along, gone, &Share::node) != along.end()) drop_element(c, e);
  }
  const auto acts_on = [](const Excitation& x, std::size_t mass) {
    return x.kind == ExcitationKind::force && x.node == mass;
  };
  for (std::size_t k = c.network.excitations.size(); k-- > 0;) {
    if (acts_on(c.network.excitations[k], i)) drop_excitation(c, k);
  }
  drop(c.network.masses, i);
  drop(c.values.mass, i);
  const auto close_up = [&](Node& node) {
    if (node.kind == NodeKind::mass && node.index > i) --node.index;
  };
  for (Element& element : c.network.elements) {
    for (Share& share : element.along) close_up(share.node);
  }
  for (Excitation& x : c.network.excitations) {
    if (x.kind == ExcitationKind::force && x.node > i) --x.node;
  }
}

// The numbers that may as well be 1 (or 0, of a phase).
std::vector<std::pair<double*, double>> numbers_to_round(Case& c) {
  std::vector<std::pair<double*, double>> result;
  for (double& value : c.values.mass) result.push_back({&value, 1.0});
  for (double& value : c.values.element) result.push_back({&value, 1.0});
  for (ExcitationValue& value : c.values.excitation) {
    result.push_back({&value.amplitude, 1.0});
    result.push_back({&value.phase, 0.0});
  }
  return result;
}

class Shrinking {
 public:
  Shrinking(Case large, const Violation& violation) : case_(std::move(large)), violation_(violation) {}

  Case smallest() {
    for (bool smaller = true; smaller;) {
      smaller = drop_each(case_.network.masses, drop_mass);
      smaller |= drop_each(case_.network.excitations, drop_excitation);
      smaller |= drop_each(case_.network.elements, drop_element);
    }
    make_round();
    return case_;
  }

 private:
  bool try_instead(const Case& smaller) {
    if (!still_violates(smaller, violation_)) return false;
    case_ = smaller;
    return true;
  }
  template <class List>
  bool drop_each(const List& list, void (*drop_one)(Case&, std::size_t)) {
    bool dropped = false;
    for (std::size_t i = list.size(); i-- > 0;) {
      Case smaller = case_;
      drop_one(smaller, i);
      dropped |= try_instead(smaller);
      i = std::min(i, list.size());
    }
    return dropped;
  }
  void make_round() {
    for (std::size_t i = 0; i < numbers_to_round(case_).size(); ++i) {
      Case rounder = case_;
      const auto [value, round] = numbers_to_round(rounder)[i];
      if (*value == round) continue;
      *value = round;
      try_instead(rounder);
    }
  }

  Case case_;
  const Violation& violation_;
};

}  // namespace

Case shrunk(Case large, const Violation& violation) {
  return Shrinking(std::move(large), violation).smallest();
}

}  // namespace frahm::invariants
