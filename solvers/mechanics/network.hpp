#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

// A mechanical system as a network: masses, elements between two nodes, and an excitation.
//
// Topology (`Network`) and numbers (`NetworkValues`) are apart, because a map over parameters changes the
// numbers at every point and the topology never.
namespace frahm::mechanics {

enum class NodeKind { ground, mass, prescribed };

struct Node {
  NodeKind kind = NodeKind::ground;
  std::size_t index = 0;  // in Network::masses or Network::prescribed; 0 for ground

  friend bool operator==(const Node&, const Node&) = default;
};

// Force of an element on its relative displacement u = q_b - q_a and relative velocity v = u':
//   spring   k u        value = stiffness k [N/m]
//   damper   c v        value = damping c [N s/m]
//   inerter  b v'       value = inertance b [kg]
//   coulomb  F Sgn(v)   value = friction force F [N], Sgn(0) = [-1, 1]
enum class ElementType { spring, damper, inerter, coulomb };

struct Element {
  std::string name;
  ElementType type = ElementType::spring;
  Node a, b;
};

enum class ExcitationKind {
  force,   // P cos(order omega t + phase) on a mass [N]
  motion,  // displacement A cos(order omega t + phase) of a prescribed node [m]
};

// One component of the excitation; order 0 is a constant. Components on one node add up.
struct Excitation {
  ExcitationKind kind = ExcitationKind::force;
  std::size_t node = 0;  // index into Network::masses (force) or Network::prescribed (motion)
  int order = 1;
};

struct Network {
  std::vector<std::string> masses;      // names of the moving nodes
  std::vector<std::string> prescribed;  // names of the nodes of prescribed motion
  std::vector<Element> elements;
  std::vector<Excitation> excitations;
  int reference_order = 1;  // the harmonic of which phases are taken
};

struct Harmonic {
  double amplitude = 0.0;  // [N] for a force, [m] for a motion
  double phase = 0.0;      // [rad]
};

// The numbers of a network at one point of a map, in the order of the lists in `Network`.
struct NetworkValues {
  double omega = 0.0;           // fundamental angular frequency [rad/s], > 0
  std::vector<double> mass;     // [kg], >= 0 (zero where an inerter keeps the mass matrix definite)
  std::vector<double> element;  // stiffness, damping, inertance or force of each element (see ElementType)
  std::vector<Harmonic> excitation;  // of each excitation component
};

}  // namespace frahm::mechanics
