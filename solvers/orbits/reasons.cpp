#include "solvers/orbits/reasons.hpp"

#include <cstdio>

namespace frahm::periodic {
namespace {

std::string with_numbers(const char* format, auto... numbers) {
  char text[200];
  std::snprintf(text, sizeof text, format, numbers...);
  return text;
}

}  // namespace

std::string no_convergence(int passages, double residual) {
  return with_numbers(
      "no convergence: the period map contracts too slowly; the residual is %.1e after %d passages", residual,
      passages);
}

std::string none_stable(int starts, int most_multiple, bool found_unstable) {
  return with_numbers("no stable orbit of up to %d periods was found from %d starts%s", most_multiple, starts,
                      found_unstable ? "; only unstable ones exist among those found" : "");
}

std::string not_settled(int periods, int most_multiple) {
  return with_numbers("the motion of the sweep reached no stable orbit of up to %d periods within %d periods",
                      most_multiple, periods);
}

std::string unbalanced(double balance) {
  return with_numbers("the energy put in and dissipated in a period differ by %.1e of it", balance);
}

std::string unbalanced_motion(double balance) {
  return with_numbers("its energies differ by %.1e of the largest of them: an event was missed", balance);
}

}  // namespace frahm::periodic
