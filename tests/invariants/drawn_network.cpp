#include "tests/invariants/drawn_network.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace frahm::invariants {
namespace {

using namespace mechanics;

double two_digits(double x) {
  if (x == 0.0) return 0.0;
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(x))) - 1.0);
  const double digits = std::round(x / unit);
  return unit < 1.0 ? digits / std::round(1.0 / unit) : digits * unit;
}

class Drawing {
 public:
  explicit Drawing(std::uint64_t seed) : random_(seed) { case_.seed = seed; }

  Case draw() {
    case_.network.masses.clear();
    choose_kind();
    add_masses();
    if (chance(0.35)) add_support();
    if (masses_ > 1 && chance(0.3)) add(ElementType::spring, mass(0), mass(masses_ - 1), spread(decades_));
    if (chance(0.25)) add_between_any(ElementType::inerter, 0.3 * spread(1.0));
    add_rate_dependent_elements();
    add_excitations();
    add_contacts();
    choose_frequency();
    return case_;
  }

 private:
  double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }
  bool chance(double probability) { return uniform() < probability; }
  std::size_t pick(std::size_t count) {
    return std::min(count - 1, static_cast<std::size_t>(uniform() * static_cast<double>(count)));
  }
  // A factor within so many decades about 1.
  double spread(double decades) { return two_digits(std::pow(10.0, decades * (uniform() - 0.5))); }
  double between_powers(double lowest, double highest) {
    return two_digits(std::pow(10.0, lowest + (highest - lowest) * uniform()));
  }
  static std::string numbered(char letter, std::size_t number) {
    return std::string(1, letter).append(std::to_string(number));
  }
  static Node mass(std::size_t i) { return {NodeKind::mass, i}; }
  static constexpr Node kGround{}, kSupport{NodeKind::prescribed, 0};
  bool shaken() const { return !case_.network.prescribed.empty(); }

  void add(ElementType type, Node a, Node b, double value, double second = 0.0) {
    case_.network.elements.push_back({numbered('e', case_.network.elements.size()), type, a, b});
    case_.values.element.push_back(value);
    case_.values.second.push_back(second);
  }
  // A mass and another node of any kind.
  std::pair<Node, Node> any_pair() {
    const Node b = mass(pick(masses_));
    const double u = uniform();
    if (shaken() && u < 0.25) return {kSupport, b};
    if (masses_ == 1 || u < 0.5) return {kGround, b};
    return {mass((b.index + 1 + pick(masses_ - 1)) % masses_), b};
  }
  void add_between_any(ElementType type, double value, double second = 0.0) {
    const auto [a, b] = any_pair();
    add(type, a, b, value, second);
  }

  void choose_kind() {
    masses_ = 1 + std::min(pick(6), pick(6));
    const double u = uniform();
    decades_ = u < 0.6 ? 1.0 : u < 0.9 ? 2.0 : 3.0;
    damping_ = std::array{0.1, 0.1, 0.03, 0.03, 0.01, 0.01, 1e-3, 1e-5}[pick(8)];
  }

  void add_masses() {
    for (std::size_t i = 0; i < masses_; ++i) {
      case_.network.masses.push_back(numbered('m', i));
      case_.values.mass.push_back(spread(decades_));
      const Node before = i == 0 || chance(0.3) ? kGround : mass(pick(i));
      const double stiffness = spread(decades_);
      add(ElementType::spring, before, mass(i), stiffness);
      const double damping = 2.0 * damping_ * spread(0.6) * std::sqrt(stiffness * case_.values.mass[i]);
      if (i == 0 || chance(0.9)) add(ElementType::damper, before, mass(i), two_digits(damping));
    }
  }

  void add_support() {
    case_.network.prescribed.push_back("s0");
    add(ElementType::spring, kSupport, mass(pick(masses_)), spread(1.0));
    if (chance(0.5)) add(ElementType::damper, kSupport, mass(pick(masses_)), 0.1 * spread(1.0));
    if (chance(0.3)) add(ElementType::inerter, kSupport, mass(pick(masses_)), 0.2 * spread(1.0));
  }

  void add_rate_dependent_elements() {
    if (chance(0.2)) add_between_any(ElementType::maxwell, spread(1.0), spread(1.5));
    if (chance(0.05)) add_between_any(ElementType::maxwell, spread(2.0), spread(2.0));
    if (chance(0.15)) add_between_any(ElementType::hysteretic, spread(1.0), two_digits(0.2 * spread(1.0)));
  }

  void add_excitations() {
    static const std::vector<std::vector<int>> kOrders = {{1},    {1},    {1},    {1},    {2},    {30},
                                                          {1, 3}, {1, 3}, {2, 3}, {1, 2}, {1, 2}, {2, 4},
                                                          {0, 1}, {0, 2}, {4, 6}, {3},    {1, 7}};
    orders_ = kOrders[pick(kOrders.size())];
    const auto phase = [&] { return chance(0.3) ? 0.0 : two_digits(6.2 * uniform()); };
    for (const int order : orders_) {
      if (!shaken() || chance(0.7)) {
        case_.network.excitations.push_back({ExcitationKind::force, pick(masses_), order});
        case_.values.excitation.push_back({spread(1.0), phase()});
      }
      if (!shaken()) continue;
      case_.network.excitations.push_back({ExcitationKind::motion, 0, order});
      case_.values.excitation.push_back({two_digits(0.5 * spread(1.0)), phase()});
    }
    case_.network.reference_order = orders_[0] > 0 ? orders_[0] : orders_[1];
  }

  double friction_force() {
    switch (kind_of_friction_) {
      case 0:
        return between_powers(-6.0, 6.0);
      case 1:
        return between_powers(1.0, 6.0);
      case 2:
        return between_powers(-6.0, -2.0);
      default:
        return between_powers(-2.0, 0.5);
    }
  }

  void add_contacts() {
    kind_of_friction_ = pick(8);
    const std::size_t contacts = pick(5);
    for (std::size_t j = 0; j < contacts; ++j) add_between_any(ElementType::coulomb, friction_force());
  }

  void choose_frequency() {
    const double lowest = case_.network.reference_order;
    const double ratio = chance(0.15) ? between_powers(-2.0, -1.0) : between_powers(-0.8, 0.6);
    constexpr double kMostStiffness = 150.0;  // fastest rate over omega: a period then takes milliseconds
    case_.values.omega = two_digits(std::max(ratio / lowest, fastest_rate() / kMostStiffness));
  }

  // Of the elements by themselves, roughly [rad/s].
  double fastest_rate() const {
    double fastest = 0.0;
    for (std::size_t e = 0; e < case_.network.elements.size(); ++e) {
      const Element& element = case_.network.elements[e];
      double per_mass = 0.0;
      for (const auto& [node, factor] : element.along)
        per_mass += node.kind == NodeKind::mass ? 1.0 / case_.values.mass[node.index] : 0.0;
      const double value = case_.values.element[e], second = case_.values.second[e];
      if (element.type == ElementType::damper) fastest = std::max(fastest, value * per_mass);
      if (element.type == ElementType::maxwell) fastest = std::max(fastest, value / second);
      if (element.type == ElementType::coulomb || element.type == ElementType::inerter) continue;
      fastest = std::max(fastest, std::sqrt(value * per_mass));
    }
    return fastest;
  }

  std::mt19937_64 random_;
  Case case_;
  std::size_t masses_ = 1;
  double decades_ = 1.0;
  double damping_ = 0.0;  // ratio
  std::size_t kind_of_friction_ = 0;
  std::vector<int> orders_;
};

}  // namespace

Case draw(std::uint64_t seed) {
  return Drawing(seed).draw();
}

}  // namespace frahm::invariants
