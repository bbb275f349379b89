#pragma once

#include <string>
#include <vector>

#include "tests/invariants/answers.hpp"

// Changes of a network that leave its motion as it is, but for known factors.
namespace frahm::invariants {

struct Change {
  std::string name;
  Case changed;
  Factors factors;           // of the numbers
  double periods = 1.0;      // of the old motion in one period of the new
  double sign = 1.0;         // of displacements
  std::string without = {};  // the element or mass whose own figures are not compared
};

std::vector<Change> changes_of(const Case& original);

// The two parts of the excitation of a network without friction, each by itself; empty where there is
// friction or one component only.
std::vector<Case> parts_of_excitation(const Case& original);

}  // namespace frahm::invariants
