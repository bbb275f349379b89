#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "solvers/branches/branch.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// A branch of responses (solvers/branches) in words and as CSV.
class BranchTable {
 public:
  // along: the parameter, index in Parameters::list.  quantities: of the branch's points. The study must
  // outlive the table.
  BranchTable(const Study& study, std::size_t along, const std::vector<periodic::Quantity>& quantities);

  // How many points are stable, why the branch ends, and its special points.
  void print(const periodic::Branch& branch, std::ostream& out) const;
  // Why there is no response at the start [SI].
  void print_failure(double start, const std::string& reason, std::ostream& out) const;
  // Every point along the curve with the special ones in their places, with all digits: the parameter in its
  // usual unit, the quantities in SI; then largest_multiplier (of the period), stable (1, 0), multiple and
  // the kind of a special point, otherwise nothing.
  std::string csv(const periodic::Branch& branch) const;

 private:
  std::string row(const periodic::BranchPoint& point, const char* special) const;
  double spoken(double si) const;

  const Study& study_;
  std::size_t along_;
  std::string name_, unit_;  // of the parameter
  std::vector<periodic::QuantityDescription> quantities_;
  std::size_t headline_ = 0;  // of the quantities: the one that the table of special points shows
};

}  // namespace frahm::studies
