#include "studies/python/response_rows.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <span>
#include <thread>
#include <utility>

#include "engine/team.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "studies/map/output_quantities.hpp"
#include "studies/map/row_solver.hpp"
#include "studies/reading/text/name_pattern.hpp"

namespace frahm::studies {
namespace {

constexpr std::size_t longest_piece = 256;  // points: long for warm starts, short for many threads

std::string name_of(const Study& study, const periodic::Quantity& quantity) {
  return periodic::describe(quantity, study.network, study.dimensionless).name;
}

// Points of a row that one thread solves.
struct Piece {
  std::size_t row = 0, first = 0, count = 0;
};

std::vector<Piece> pieces_of(const RowGrid& grid, bool whole_rows) {
  const std::size_t length = grid.axes.back().si_values.size();
  const std::size_t most = whole_rows ? length : longest_piece;
  std::vector<Piece> pieces;
  for (std::size_t row = 0; row < grid.points() / length; ++row) {
    for (std::size_t first = 0; first < length; first += most)
      pieces.push_back({row, first, std::min(most, length - first)});
  }
  return pieces;
}

// Gives the parameters of the axes their values at a point, numbered in row-major order.
void set_point(const RowGrid& grid, std::size_t point, std::span<double> parameters) {
  for (std::size_t a = grid.axes.size(); a-- > 0;) {
    const RowAxis& axis = grid.axes[a];
    parameters[axis.parameter] = axis.si_values[point % axis.si_values.size()];
    point /= axis.si_values.size();
  }
}

bool sweeps_slowly(const Study& study) {
  return study.orbits_wanted().is_slow_sweep();
}

// Whether the excitation frequency depends on a number parameter.
bool sets_frequency(const Study& study, std::size_t parameter) {
  const auto inputs = study.parameters.inputs_of(study.values.omega.expression.reads());
  return std::ranges::binary_search(inputs, parameter);
}

void refuse_slow_sweep_along(const Study& study, std::size_t along) {
  if (!sweeps_slowly(study) || sets_frequency(study, along)) return;
  throw StudyError(
      rules::wrong_option,
      "{}: [orbits] sweeps the frequency, which does not depend on \"{}\": a row has to run along "
      "what it depends on",
      study.source.name, study.parameters.list[along].name);
}

// The work of all threads.
class RowTeam {
 public:
  RowTeam(const Study& study, const std::vector<periodic::Quantity>& quantities, const RowGrid& grid,
          const std::function<bool()>& stop_asked, RowResponses& out)
      : study_(study),
        quantities_(quantities),
        grid_(grid),
        stop_asked_(stop_asked),
        pieces_(pieces_of(grid, sweeps_slowly(study))),
        out_(out) {}

  std::size_t pieces() const { return pieces_.size(); }

  // The part of one thread.
  void take_part(const std::atomic<bool>& failed) {
    RowSolver solver(study_, study_.network, study_.values, quantities_, study_.orbits_wanted());
    std::vector<double> parameters = grid_.parameters;
    for (std::size_t next = taken_++; next < pieces_.size(); next = taken_++) {
      if (failed || is_stopped()) return;
      solve(pieces_[next], solver, parameters);
    }
  }

 private:
  bool is_stopped() {
    if (stop_asked_ && std::this_thread::get_id() == caller_ && stop_asked_()) stopped_ = true;
    return stopped_;
  }

  void solve(const Piece& piece, RowSolver& solver, std::vector<double>& parameters) {
    const std::size_t start = piece.row * grid_.axes.back().si_values.size() + piece.first;
    solver.forget();
    solver.begin_row();
    for (std::size_t i = 0; i < piece.count; ++i) {
      set_point(grid_, start + i, parameters);
      solver.add_point(parameters);
    }
    solver.solve();
    for (std::size_t i = 0; i < piece.count; ++i) {
      const std::span<const double> found = solver.quantities(i);
      for (std::size_t q = 0; q < found.size(); ++q) out_.values[q][start + i] = found[q];
      out_.reasons[start + i] = solver.reason(i);
    }
  }

  const Study& study_;
  const std::vector<periodic::Quantity>& quantities_;
  const RowGrid& grid_;
  const std::function<bool()>& stop_asked_;
  std::vector<Piece> pieces_;
  RowResponses& out_;  // each point is written by one thread
  std::thread::id caller_ = std::this_thread::get_id();
  std::atomic<std::size_t> taken_ = 0;
  std::atomic<bool> stopped_ = false;
};

// No point is computed yet.
RowResponses without_values(const Study& study, const std::vector<periodic::Quantity>& quantities,
                            std::size_t points) {
  RowResponses empty;
  for (const periodic::Quantity& quantity : quantities) {
    empty.variables.push_back(periodic::describe(quantity, study.network, study.dimensionless));
    empty.values.emplace_back(points, periodic::missing_value(empty.variables.back().kind));
  }
  empty.reasons.resize(points);
  return empty;
}

}  // namespace

std::size_t RowGrid::points() const {
  std::size_t product = 1;
  for (const RowAxis& axis : axes) product *= axis.si_values.size();
  return product;
}

std::vector<periodic::Quantity> quantities_called(const Study& study, const std::vector<std::string>& names) {
  if (names.empty())
    return study.sweep() ? output_quantities(study) : periodic::standard_quantities(study.network);
  const std::vector<periodic::Quantity> all = periodic::all_quantities(study.network);
  std::vector<periodic::Quantity> called;
  for (const std::string& name : names) {
    bool is_known = false;
    for (const periodic::Quantity& each : all) {
      if (!matches(name, name_of(study, each))) continue;
      is_known = true;
      if (std::ranges::find(called, each) == called.end()) called.push_back(each);
    }
    if (is_known) continue;
    std::vector<std::string> known;
    for (const periodic::Quantity& each : all) known.push_back(name_of(study, each));
    throw StudyError(rules::unknown_name, "{}: there is no quantity \"{}\"{}", study.source.name, name,
                     hint_of_unmatched(name, known));
  }
  return periodic::with_always_stored(std::move(called), study.network);
}

RowResponses solve_rows(const Study& study, const std::vector<periodic::Quantity>& quantities, RowGrid grid,
                        int threads, const std::function<bool()>& stop_asked) {
  refuse_slow_sweep_along(study, grid.axes.back().parameter);
  RowResponses found = without_values(study, quantities, grid.points());
  RowTeam team(study, quantities, grid, stop_asked, found);
  const std::exception_ptr error =
      engine::run_team(engine::team_size(threads, team.pieces()),
                       [&](const std::atomic<bool>& failed) { team.take_part(failed); });
  try {
    if (error) std::rethrow_exception(error);
  } catch (const mechanics::MechanicsError& refused) {
    throw StudyError(rules::not_computed, "{}: {}", study.source.name, refused.what());
  }
  return found;
}

}  // namespace frahm::studies
