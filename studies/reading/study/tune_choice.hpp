#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "solvers/algebra/no_value.hpp"
#include "solvers/quantities/quantity.hpp"
#include "solvers/transient/motion_quantity.hpp"
#include "solvers/tuning/records/record_task.hpp"
#include "solvers/tuning/task.hpp"
#include "studies/reading/quantities/parameters.hpp"
#include "studies/reading/study/motion_choice.hpp"
#include "studies/reading/study/study_values.hpp"

// The options of a study of kind "tune". Numbers are SI unless stated otherwise.
namespace frahm::studies {

// The range of frequencies over which the response counts.
struct BandChoice {
  std::size_t parameter = 0;  // index in Parameters::list, of a number on which the frequency depends
  UsualUnit unit;             // of the parameter in the study
  tuning::Band range;
  Position position;
};

// [[design]]
struct DesignChoice {
  std::size_t parameter = 0;  // index in Parameters::list, of a number
  UsualUnit unit;
  double lower = 0.0, upper = 0.0;
  std::vector<double> knots;       // of its schedule over the band parameter; empty: one constant
  double max_slope = kInfinity;    // of the schedule, either way
  bool may_leap = false;           // schedule = { jumps = 1 }
  std::optional<StudyValue> rule;  // another schedule to compare with, over parameters and the band
  Position position;

  bool is_scheduled() const { return !knots.empty(); }
  // For the tuned parameter: one, or one for each knot, both sides of a jump among them.
  std::size_t count() const { return is_scheduled() ? knots.size() + (may_leap ? 2 : 0) : 1; }
};

// [[constraint]]
struct LimitChoice {
  std::string name;  // of the quantity
  periodic::Quantity quantity;
  UsualUnit unit;
  double lower = -kInfinity;
  double upper = kInfinity;
  std::optional<tuning::Band> band;
};

// The problem solved again for each upper limit of a quantity.
struct TradeOffChoice {
  std::string name;  // of the quantity
  periodic::Quantity quantity;
  UsualUnit unit;
  std::vector<double> limits;  // at least one
};

// [[scenario]]
struct ScenarioChoice {
  std::string name;
  std::vector<Assignment> set;
};

// [[column]]: a number next to the schedule, such as the ratio of a gear that sets it.
struct ColumnChoice {
  std::string name;
  StudyValue value;
  std::string unit = "1";  // of the number in the file
  double si_factor = 1.0;  // the expression gives si_factor x that number: factor_of_label()
  double lower = -kInfinity;
  double upper = kInfinity;
};

// The peak that a tuning over records presses down.
struct PeakChoice {
  tuning::PeakGoal goal;
  transient::MotionQuantity quantity;  // the peak of a mass or signal, or the stroke of an element
  double duration = 0.0;               // of each motion [s]
  std::vector<std::string> records;    // names of the motions, at least one
  std::vector<DrivingRecord> driving;  // without their samples where data are left (DataFiles)
};

// [tune] and its tables.
struct TuneChoice {
  tuning::Objective objective = tuning::Objective::minimax;
  std::optional<PeakChoice> peaks;  // a tuning over records: no objective, quantity, band or limits with it
  std::string quantity_name;
  periodic::Quantity quantity;
  std::optional<BandChoice> band;  // only a variance without limits has none
  tuning::SolverKind solver = tuning::SolverKind::ipopt;
  tuning::SolverKind global_solver = tuning::SolverKind::crs2;
  tuning::Start start = tuning::Start::given;
  bool start_is_given = false;  // else a map of the box comes first where it takes well below a second
  std::size_t starts = 1;
  double tolerance = 0.0;  // relative, of the certificate gap
  std::optional<StudyValue> weight;
  bool dominate_constant = false;
  std::optional<TradeOffChoice> trade_off;
  tuning::Noise noise;
  periodic::OrbitsWanted orbits;      // of a system that may have several responses
  std::vector<DesignChoice> designs;  // at least one
  std::vector<LimitChoice> limits;
  std::vector<ScenarioChoice> scenarios;  // none: the study alone
  std::string drawn;  // the samples that the scenarios are, for readers; "" where they are no samples
  std::vector<ColumnChoice> columns;

  bool has_schedule() const;
};

}  // namespace frahm::studies
