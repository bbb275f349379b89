#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "solvers/quantities/quantity.hpp"
#include "studies/reading/study/study.hpp"

// Periodic responses along rows of points, in memory: the kernel of a map without tiles, logs and a file.
namespace frahm::studies {

// A parameter that runs over values.
struct RowAxis {
  std::size_t parameter = 0;      // index in Parameters::list, of a number
  std::vector<double> si_values;  // at least one
};

// The points of all axes, the last of which is a row and runs fastest.
struct RowGrid {
  std::vector<double> parameters;  // SI, of all parameters; those of the axes are overwritten
  std::vector<RowAxis> axes;       // at least one

  std::size_t points() const;
};

struct RowResponses {
  std::vector<periodic::QuantityDescription> variables;
  std::vector<std::vector<double>> values;  // of each variable, of each point in row-major order
  std::vector<std::string> reasons;         // of each point why it failed; empty if it did not
};

// The quantities called by name or pattern; none given: those that a map of the study records. Throws
// StudyError, with the nearest name, for one that there is not.
std::vector<periodic::Quantity> quantities_called(const Study& study, const std::vector<std::string>& names);

// Solves all points with a team of threads (0: engine::default_threads()). Rows are cut where the study does
// not sweep the frequency, into pieces that do not depend on the threads, so neither does the result.
// stop_asked: called in the calling thread between pieces; where it is true the work ends, and what is not
// computed has no value. Throws StudyError for a network that cannot move, and where the frequency is swept
// but is not what the rows run along.
RowResponses solve_rows(const Study& study, const std::vector<periodic::Quantity>& quantities, RowGrid grid,
                        int threads, const std::function<bool()>& stop_asked = {});

}  // namespace frahm::studies
