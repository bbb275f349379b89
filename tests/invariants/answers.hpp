#pragma once

#include <string>
#include <vector>

#include "solvers/quantities/quantity.hpp"
#include "tests/invariants/drawn_network.hpp"

// What PeriodicResponse answers to a network, by name.
namespace frahm::invariants {

// New units in old ones, or the factors of a change of size.
struct Factors {
  double length = 1.0, time = 1.0, force = 1.0;
};
// What a number in this unit is multiplied by.
double factor_of(const std::string& unit, const Factors& factors);

struct Figure {
  std::string name, unit;
  periodic::Quantity quantity;
  double value = 0.0;
};

struct Answer {
  int status = 0;      // as in periodic::Status; 0: the network was refused
  std::string reason;  // of a refusal or a failure
  std::vector<Figure> figures;
  std::vector<std::vector<double>> displacements;  // of each mass at 64 phases of a period [m]

  const Figure* find(const std::string& name) const;
  double operator[](const std::string& name) const;  // NaN where there is none
  bool has_response() const { return status == 1 || status == 2; }
};

// From nothing known.
Answer answer(const Case& asked);
// At the end of a row of frequencies that leads to it, the second of two rows.
Answer answer_of_sweep(const Case& asked);

}  // namespace frahm::invariants
