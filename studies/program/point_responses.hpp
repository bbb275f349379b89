#pragma once

#include <complex>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "solvers/response/periodic_response.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// A stable response of a point, of several that may have been found.
struct FoundResponse {
  struct Number {
    std::string name, unit;
    double value = 0.0;
  };
  bool is_shown = false;                          // as the response of the point
  int period_multiple = 1;                        // of the excitation's period
  std::optional<std::size_t> mirror_of;           // index of an earlier one: this is -x(t + T/2) of it
  std::vector<Number> peaks;                      // of masses and signals
  std::vector<std::complex<double>> multipliers;  // over its own period, the largest first; none at grazing
  // At omega t = 0: displacement and velocity of each mass, force of each element that has a state.
  std::vector<Number> state;
};

// Every stable response that the search of a point has found, `coexisting` of them. response: solved there,
// for these quantities; it is left at the last one.
std::vector<FoundResponse> found_responses(const Study& study, std::span<const periodic::Quantity> quantities,
                                           periodic::PeriodicResponse& response, int coexisting);

}  // namespace frahm::studies
