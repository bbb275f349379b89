#pragma once

#include <vector>

#include "solvers/identification/identification.hpp"

// Mass and stiffness from the natural frequency without and with masses added.
namespace frahm::identification {

struct AddedMassRows {
  std::vector<double> added;  // [kg], >= 0
  std::vector<double> omega;  // natural frequency with it [rad/s], > 0
  std::vector<double> sigma;  // its standard error [rad/s], > 0; empty: not known, all equal parts of omega
  // Behind each standard error; empty: infinite.
  std::vector<double> degrees_of_freedom = {};
};

// 1/omega^2 = (m + added) / k by least squares. Intervals come from the given standard errors, otherwise from
// the residuals. The degrees of freedom of an estimate are then those of Welch and Satterthwaite, nu = u^4 /
// sum u_i^4 / nu_i, u_i the part of the standard error u that frequency i has.
// Estimates: mass [kg], stiffness [N m-1].
// failure: fewer than two different added masses, or frequencies that do not fall with the mass.
Identification added_mass(const AddedMassRows& rows);

}  // namespace frahm::identification
