#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "solvers/laws/bend.hpp"

// A mechanical system as a network: masses, elements along combinations of their coordinates, and an
// excitation. A mass may be a moment of inertia: its displacement is then an angle.
//
// Topology (`Network`) and numbers (`NetworkValues`) are apart, because a map over parameters changes the
// numbers at every point and the topology never.
namespace frahm::mechanics {

enum class NodeKind { ground, mass, prescribed, joint };

struct Node {
  NodeKind kind = NodeKind::ground;
  std::size_t index = 0;  // in Network::masses, prescribed or joints; 0 for ground

  friend bool operator==(const Node&, const Node&) = default;
};

// A node's share in a combination of coordinates.
struct Share {
  Node node;
  double factor = 1.0;  // [1], or [m/rad] of a rotation in a length

  friend bool operator==(const Share&, const Share&) = default;
};

// A combination of coordinates: u = sum of factor x displacement of the node. Ground moves nothing, but takes
// force.
using Direction = std::vector<Share>;

// u = q_b - q_a
inline Direction between(Node a, Node b) {
  return {{a, -1.0}, {b, +1.0}};
}

inline bool is_between_two_nodes(const Direction& u) {
  return u.size() == 2 && u[0].factor == -1.0 && u[1].factor == 1.0;
}

// Force of an element on its displacement u (of two nodes the relative one, q_b - q_a) and velocity v = u';
// it acts on each node by its factor. Of a rotational element u is in rad, k in N m/rad, c in N m s/rad, b in
// kg m2 and F in N m:
//   spring      k u (+ cubic u^3)            value = stiffness k [N/m]
//   damper      c v                          value = damping c [N s/m]
//   inerter     b v'                         value = inertance b [kg]
//   coulomb     F Sgn(v), Sgn(0) = [-1, 1]   value = friction force F [N], second = static limit F_s >= F of
//                                            the force at rest [N], 0: F
//   hysteretic  k u + (eta k / omega_h) v    value = stiffness k [N/m], second = loss factor eta [1]
//   maxwell     s, s' = k v - (k/c) s        value = stiffness k [N/m], second = damping c [N s/m], in series
//   jenkins     s, s' = k v, or s = +-F      value = stiffness k [N/m], second = friction force F [N], in
//   series
//   gap         k (u - D) + c v beyond D     value = stiffness k [N/m], second = damping c [N s/m]; D of its
//   bends
// Bends add to springs and dampers what makes them characteristics of several pieces (laws/bend.hpp). Their
// values are NetworkValues::bends.
enum class ElementType { spring, damper, inerter, coulomb, hysteretic, maxwell, jenkins, gap };

// A bend of an element, in the direction side x u.
struct BendPlace {
  double side = 1.0;  // +1 or -1
  const laws::Bend* law = nullptr;
};

// The law of an element's force. All but the exact one are smooth, and their numbers are
// NetworkValues::smooth. Of a coulomb element: arctan, F (2/pi) arctan(slope v), and stribeck, a curve of the
// force over the speed in place of F. Of a spring: cubic, which adds cubic u^3.
enum class ForceLaw { exact, arctan, stribeck, cubic };

struct Element {
  Element() = default;
  Element(std::string given_name, ElementType kind, Direction direction, ForceLaw of_force = ForceLaw::exact)
      : name(std::move(given_name)), type(kind), along(std::move(direction)), law(of_force) {}
  Element(std::string given_name, ElementType kind, Node a, Node b, ForceLaw of_force = ForceLaw::exact)
      : Element(std::move(given_name), kind, between(a, b), of_force) {}

  std::string name;
  ElementType type = ElementType::spring;
  Direction along;  // its displacement u; each node once
  ForceLaw law = ForceLaw::exact;
  std::vector<BendPlace> bends;
  bool has_static_force = false;  // of a coulomb element that follows the exact law: it is given one
  // For an iwan element: how many jenkins elements in parallel it is, from this one on, the first, by which
  // all are reported as one; 0 of those that follow.
  std::size_t parts = 1;
  bool rotational = false;     // u is an angle
  bool twists_ground = false;  // its factor there is of an angle: what the ground takes of it is a torque
};

enum class ExcitationKind {
  force,   // P cos(order omega t + phase) on a mass [N], on a rotation [N m]
  motion,  // displacement A cos(order omega t + phase) of a prescribed node [m]
  crank,   // displacement of a prescribed node by a crank that turns with omega t + phase (crank.hpp)
  belt,  // displacement V cos(phase) t of a prescribed node, for ever: nothing may ask for it but by its rate
  recorded_force,   // A cos(phase) times a record, a force on a mass: of a transient (transient/record.hpp)
  recorded_motion,  // likewise a displacement of a prescribed node
};

inline bool is_recorded(ExcitationKind kind) {
  return kind == ExcitationKind::recorded_force || kind == ExcitationKind::recorded_motion;
}

// One component of the excitation; order 0 is a constant. Components on one node add up.
struct Excitation {
  ExcitationKind kind = ExcitationKind::force;
  // index into Network::masses and, after them, joints (force) or into Network::prescribed (motion, crank)
  std::size_t node = 0;
  int order = 1;         // of a crank: 1; of a belt or a record: 0
  int even_orders = 0;   // of a crank: how many of its orders 2, 4, 6 ... are included
  int taylor_order = 0;  // of a crank: 1, 2 or 4 cuts its Taylor series in crank/rod there; 0: exact
};

// A combination of coordinates that is reported as a mass is: a drift, a displacement relative to the base.
struct Signal {
  std::string name;
  Direction along{};
  bool rotational = false;  // it is an angle
};

// Damping of the structure as a whole, in addition to that of elements (structural_damping.hpp).
enum class DampingModel {
  none,
  modal,     // a ratio for each natural mode, in the order of their frequencies
  rayleigh,  // a M + b K
};

// A part of the system that is given by its matrices, such as a reduced finite-element model.
struct MatrixPart {
  std::string name;
  std::vector<std::size_t> nodes;            // of each row: index into Network::masses
  Eigen::MatrixXd mass, damping, stiffness;  // [kg], [N s/m], [N/m]; damping: 0 x 0 where it has none
};

struct Network {
  std::vector<std::string> masses;        // names of the moving nodes
  std::vector<std::string> prescribed{};  // names of the nodes of prescribed motion
  std::vector<Element> elements{};
  std::vector<Excitation> excitations{};
  int reference_order = 1;       // the harmonic of which phases are taken
  std::vector<bool> rotation{};  // of each mass: it is a moment of inertia; may be empty where none is
  std::vector<Signal> signals{};
  DampingModel damping = DampingModel::none;
  std::vector<MatrixPart> matrices{};
  // Names of moving nodes without mass or inerter, where springs and dampers meet (joints.hpp); whether each
  // one's displacement is an angle, which may be empty where none is.
  std::vector<std::string> joints{};
  std::vector<bool> joint_rotation{};
};

inline std::string node_name(const Network& network, const Node& node) {
  switch (node.kind) {
    case NodeKind::mass:
      return network.masses[node.index];
    case NodeKind::prescribed:
      return network.prescribed[node.index];
    case NodeKind::joint:
      return network.joints[node.index];
    case NodeKind::ground:
      break;
  }
  return "ground";
}

// The name of the node that a force acts on (Excitation::node).
inline const std::string& forced_node(const Network& network, std::size_t node) {
  const std::size_t masses = network.masses.size();
  return node < masses ? network.masses[node] : network.joints[node - masses];
}

// Whether a prescribed node moves on for ever.
inline bool has_belt(const Network& network) {
  return std::ranges::any_of(network.excitations,
                             [](const Excitation& each) { return each.kind == ExcitationKind::belt; });
}
// Whether a part of the excitation is a record.
inline bool has_records(const Network& network) {
  return std::ranges::any_of(network.excitations,
                             [](const Excitation& each) { return is_recorded(each.kind); });
}
// Whether a combination of coordinates has a share of a node that moves on for ever: it grows for ever.
inline bool is_on_belt(const Network& network, const Direction& u) {
  return std::ranges::any_of(u, [&](const Share& share) {
    return share.node.kind == NodeKind::prescribed &&
           std::ranges::any_of(network.excitations, [&](const Excitation& each) {
             return each.kind == ExcitationKind::belt && each.node == share.node.index;
           });
  });
}

struct ExcitationValue {
  // [N] for a force ([N m] on a rotation), [m] for a motion; radius [m] of a crank; velocity V [m/s] of a
  // belt; what multiplies a record [1]
  double amplitude = 0.0;
  double phase = 0.0;  // [rad]
  double rod = 0.0;    // length [m] of a crank's rod, > amplitude

  friend bool operator==(const ExcitationValue&, const ExcitationValue&) = default;
};

// The numbers of a bend, along its side; of a rotation in rad and N m.
struct BendValue {
  double place = 0.0;      // D [m], or [m/s] of a velocity
  double stiffness = 0.0;  // that it adds beyond [N/m]; 0 of a velocity
  double damping = 0.0;    // that it adds beyond [N s/m]

  friend bool operator==(const BendValue&, const BendValue&) = default;
};

// A point of a curve of friction over the speed; of a rotation in rad/s and N m.
struct CurvePoint {
  double speed = 0.0, force = 0.0;  // [m/s], [N]

  friend bool operator==(const CurvePoint&, const CurvePoint&) = default;
};

// The numbers of an element's smooth law, where it follows one.
struct SmoothValue {
  double slope = 0.0;               // of arctan [s/m], of a rotation [s/rad]
  double cubic = 0.0;               // of a spring [N/m3], of a rotation [N m/rad3]
  std::vector<CurvePoint> curve{};  // of stribeck, from (0, 0)

  friend bool operator==(const SmoothValue&, const SmoothValue&) = default;
};
// Those of its numbers that a study gives one by one.
inline constexpr std::array smooth_numbers{&SmoothValue::slope, &SmoothValue::cubic};

// The numbers of a network at one point of a map, in the order of the lists in `Network`.
struct NetworkValues {
  double omega = 0.0;  // fundamental angular frequency [rad/s], > 0
  // [kg], [kg m2] of a rotation, >= 0 (zero where an inerter keeps the mass matrix definite)
  std::vector<double> mass;
  std::vector<double> element;  // stiffness, damping, inertance or force of each element (see ElementType)
  std::vector<ExcitationValue> excitation{};  // of each excitation component
  std::vector<double> second{};  // of each element, 0 where it has none; may be empty where none has one
  std::vector<std::vector<BendValue>> bends{};  // of each element; may be empty where none has any
  std::vector<SmoothValue> smooth{};            // of each element; may be empty where no law is smooth
  double hysteretic_omega = 0.0;  // omega_h [rad/s] of hysteretic elements; 0: reference order x omega
  // modal: ratios [1] of the first modes, the last one of all higher modes too; rayleigh: a [1/s], b [s]
  std::vector<double> damping{};
};

}  // namespace frahm::mechanics
