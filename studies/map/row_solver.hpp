#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "solvers/response/periodic_response.hpp"
#include "studies/reading/study.hpp"

namespace frahm::studies {

// Responses of one network along the rows of a map, each starting from those before it. A point without one
// fails with a reason; it never ends the work.
class RowSolver {
 public:
  // study: whose parameters the values read; must outlive the solver. matrices_change: masses or elements
  // change along a row.
  RowSolver(const Study& study, const mechanics::Network& network, StudyValues values,
            std::vector<periodic::Quantity> quantities, bool matrices_change);

  void forget() { response_.forget(); }  // all earlier points
  void begin_row();                      // of element values
  // The next point starts from the first one of the row or stretch of frequencies in hand.
  void turn() { points_onwards_ = 0; }
  // Completes the parameters (SI) and sets the network's values at the point.
  void set_parameters(std::span<double> parameters);
  // The quantities of that point; `reason` says why it fails, empty if it does not.
  std::span<const double> solve(std::string& reason);
  // The stretches of its orbit, if it has one (PeriodicResponse::stretches).
  std::vector<periodic::Stretch> stretches() const { return response_.stretches(); }

 private:
  void set_point();
  void turn_where_frequency_does();

  const Parameters& parameters_;
  StudyValues values_;
  std::vector<double> missing_;  // of each quantity: its value at a point that failed before it was solved
  bool matrices_change_;
  periodic::PeriodicResponse response_;
  bool matrices_set_ = false;         // to the row's
  std::uint64_t points_onwards_ = 0;  // with the frequency going one way
  double omega_ = 0.0;                // of the last of them [rad/s]
  double direction_ = 0.0;            // the step to it
  mechanics::NetworkValues numbers_;
  std::vector<double> point_;
};

}  // namespace frahm::studies
