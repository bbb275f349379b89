#include "tests/benchmarks/works.hpp"

#include <numbers>

namespace frahm::benchmarks {
namespace {

using namespace mechanics;
using std::numbers::pi;

Node mass_node(int i) {
  return {NodeKind::mass, static_cast<std::size_t>(i)};
}

Network single_mass() {
  const Node ground{}, mass = mass_node(0);
  Network network;
  network.masses = {"mass"};
  network.elements = {{"spring", ElementType::spring, ground, mass},
                      {"damper", ElementType::damper, ground, mass},
                      {"friction", ElementType::coulomb, ground, mass}};
  network.excitations = {{ExcitationKind::force, 0, 1}};
  return network;
}

}  // namespace

Work one_mass() {
  Work work{"W1, one mass", single_mass(), {}};
  for (int i = 0; i <= 28; ++i) {
    auto& row = work.rows.emplace_back();
    for (int k = 0; k <= 400; ++k)
      row.push_back({0.2 + 1.8 * k / 400.0, {1.0}, {1.0, 0.04, 0.025 * i}, {{1.0, 0.0}}});
  }
  return work;
}

Work den_hartog() {
  Work work{"Den Hartog's map", single_mass(), {}};
  for (int i = 0; i <= 44; ++i) {
    auto& row = work.rows.emplace_back();
    for (int k = 0; k <= 400; ++k)
      row.push_back({0.1001 + 1.9 * k / 400.0, {1.0}, {1.0, 0.0, 0.025 * i}, {{1.0, 0.0}}});
  }
  return work;
}

Work rig(int inertances) {
  Work work{"rig", {}, {}};
  const Node ground{}, main = mass_node(0), tmd = mass_node(1), exciter{NodeKind::prescribed, 0};
  work.network.masses = {"main", "tmd"};
  work.network.prescribed = {"exciter"};
  work.network.elements = {
      {"suspension", ElementType::spring, ground, main}, {"drive", ElementType::spring, exciter, main},
      {"guide", ElementType::coulomb, ground, main},     {"guide_damper", ElementType::damper, ground, main},
      {"tmd_spring", ElementType::spring, main, tmd},    {"tmd_damper", ElementType::damper, main, tmd},
      {"inerter", ElementType::inerter, main, tmd},      {"tmd_friction", ElementType::coulomb, main, tmd}};
  work.network.excitations = {{ExcitationKind::motion, 0, 1}};
  for (int j = 0; j < inertances; ++j) {
    const double inertance = 4.72 + (12.9 - 4.72) * j / (inertances - 1);
    for (int i = 0; i <= 30; ++i) {
      auto& row = work.rows.emplace_back();
      for (int k = 0; k <= 400; ++k) {
        row.push_back({(150.0 + 0.5 * k) * pi / 30.0,
                       {102.66, 12.82},
                       {6 * 8181.0, 8181.0, 0.01 * i * 8181.0 * 0.02955, 1.7688, 10985.1,
                        26.5104 + 0.4811 * inertance, inertance, 15.0109},
                       {{0.02955, -pi / 2}}});
      }
    }
  }
  return work;
}

Work shear_building(int storeys, int every) {
  Work work{std::to_string(storeys) + " storeys, friction at every " + std::to_string(every), {}, {}};
  NetworkValues values{.omega = 0.0, .mass = {}, .element = {}, .excitation = {{1.0, 0.0}}};
  work.network.prescribed = {"ground_motion"};
  work.network.excitations = {{ExcitationKind::motion, 0, 1}};
  for (int i = 0; i < storeys; ++i) {
    const std::string number = std::to_string(i + 1);
    work.network.masses.push_back("floor" + number);
    values.mass.push_back(1.0);
    const Node below = i == 0 ? Node{NodeKind::prescribed, 0} : mass_node(i - 1);
    work.network.elements.push_back({"columns" + number, ElementType::spring, below, mass_node(i)});
    values.element.push_back(1.0);
    work.network.elements.push_back({"damper" + number, ElementType::damper, below, mass_node(i)});
    values.element.push_back(0.02);
    if (i % every != 0) continue;
    work.network.elements.push_back({"brace" + number, ElementType::coulomb, below, mass_node(i)});
    values.element.push_back(0.01);
  }
  auto& row = work.rows.emplace_back();
  const double first = pi / (2.0 * storeys + 1.0);  // about the first natural frequency
  for (int k = 0; k < 200; ++k) {
    values.omega = first * (0.5 + 4.5 * k / 199.0);
    row.push_back(values);
  }
  return work;
}

Work five_masses() {
  Work work = shear_building(5, 2);
  work.name = "five masses, three contacts";
  std::vector<NetworkValues> row = work.rows[0];
  work.rows.clear();
  for (int i = 0; i <= 10; ++i) {
    for (NetworkValues& values : row) {
      for (std::size_t e = 0; e < values.element.size(); ++e) {
        if (work.network.elements[e].type == ElementType::coulomb) values.element[e] = 0.01 * i;
      }
    }
    work.rows.push_back(row);
  }
  return work;
}

Work thinned(Work work, std::size_t rows, std::size_t points) {
  Work result{work.name, work.network, {}};
  for (std::size_t i = 0; i < work.rows.size(); i += rows) {
    auto& row = result.rows.emplace_back();
    for (std::size_t k = 0; k < work.rows[i].size(); k += points) row.push_back(work.rows[i][k]);
  }
  return result;
}

}  // namespace frahm::benchmarks
