#pragma once

#include <string>
#include <vector>

// The classical systems that have closed forms, solved by the general path.
namespace frahm::studies {

// One comparison over many points.
struct VerifyCase {
  std::string name;
  double allowed = 0.0;  // deviation, relative to max(|exact value|, 1)
  int points = 0;
  double worst = 0.0;  // deviation met
  int wrong = 0;       // points without a value, or of another status or regime than the known one

  void compare(double found, double exact);  // counts a point
  void expect(bool holds);                   // status or regime of the point in hand

  bool passes() const { return points > 0 && wrong == 0 && worst <= allowed; }
};

// Materials under a harmonic force and free decays with friction, added to the cases.
void add_linear_cases(std::vector<VerifyCase>& cases);

// All of them, in order; takes less than a second of one core.
std::vector<VerifyCase> verify_cases();

}  // namespace frahm::studies
