#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "solvers/response/periodic_response.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// Responses of one network along the rows of a map. A point without one fails with a reason; it never ends
// the work.
class RowSolver {
 public:
  // study: whose parameters the values read; must outlive the solver.  wanted: of several responses.
  RowSolver(const Study& study, const mechanics::Network& network, StudyValues values,
            const std::vector<periodic::Quantity>& quantities, const periodic::OrbitsWanted& wanted);

  void forget() { response_.forget(); }  // all earlier points
  void begin_row() { points_ = 0; }
  // The next point of the row: completes its parameters (SI) and keeps its values.
  void add_point(std::span<double> parameters);
  // Solves the row.
  void solve();
  // For point i of the row: its quantities; and why it fails, empty if it does not.
  std::span<const double> quantities(std::size_t i) const;
  const std::string& reason(std::size_t i) const { return found_[i].reason; }

  // Solves one point by shooting; then the stretches of its orbit, if it has one
  // (PeriodicResponse::stretches).
  std::span<const double> solve_alone(std::span<double> parameters);
  std::vector<periodic::Stretch> stretches() const { return response_.stretches(); }

 private:
  const Parameters& parameters_;
  StudyValues values_;
  std::vector<double> missing_;  // of each quantity: its value at a point that failed before it was solved
  periodic::PeriodicResponse response_;

  // For the row in hand; their memory is used again by the next.
  std::size_t points_ = 0;
  std::vector<mechanics::NetworkValues> numbers_;
  std::vector<periodic::ResponseSummary> found_;
  std::vector<double> row_;
};

}  // namespace frahm::studies
