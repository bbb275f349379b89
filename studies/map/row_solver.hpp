#pragma once

#include <span>
#include <string>
#include <vector>

#include "solvers/response/periodic_response.hpp"
#include "studies/reading/study_file.hpp"

namespace frahm::studies {

// Responses of one network along the rows of a map. A point without one fails with a reason; it never ends
// the work.
class RowSolver {
 public:
  // study: whose parameters the values read; must outlive the solver. matrices_change: masses or elements
  // change along a row.
  RowSolver(const StudyFile& study, const mechanics::Network& network, StudyValues values,
            std::vector<periodic::Quantity> quantities, bool matrices_change);

  void forget() { response_.forget(); }        // all earlier points
  void begin_row() { matrices_set_ = false; }  // of element values
  void turn() { response_.begin_row(); }       // the frequency does not go on in its direction
  // Completes the parameters (SI) and puts the point's numbers in place.
  void place(std::span<double> parameters);
  double omega() const { return numbers_.omega; }  // of the point in place [rad/s]
  // The quantities of the point in place; `reason` is why it fails, empty if it does not.
  std::span<const double> solve(std::string& reason);

 private:
  void set_point();

  const Parameters& parameters_;
  StudyValues values_;
  std::vector<double> missing_;  // of each quantity: what a point has that failed before it was solved
  bool matrices_change_;
  periodic::PeriodicResponse response_;
  bool matrices_set_ = false;  // to the row's
  mechanics::NetworkValues numbers_;
  std::vector<double> point_;
};

}  // namespace frahm::studies
