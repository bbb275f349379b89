#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "solvers/algebra/no_value.hpp"
#include "solvers/identification/measurement.hpp"
#include "studies/reading/quantities/parameters.hpp"
#include "studies/reading/study/motion_choice.hpp"
#include "studies/reading/study/study_values.hpp"

// The options of a study of kind "identify", with its data. Numbers are SI.
namespace frahm::studies {

enum class IdentifyMethod {
  half_power,
  resonance_magnification,
  log_decrement,
  free_decay,
  forced_resonance,
  energy_balance,
  hysteresis_loop,
  added_mass,
  grey_box,
};

// The group of an identification in a result file, and its flag `outcome` for a converged fit
// (results/FORMAT.md).
inline constexpr const char* identification_group = "identification";
inline constexpr double converged_outcome = 1.0;

// Names of the methods, as a study writes them, in the order of IdentifyMethod.
std::string method_name(IdentifyMethod method);

// A column of measurements: its role (the measured quantity) and its numbers [SI].
struct DataColumn {
  std::string role;  // "time", "main_displacement", "amplitude", "lower_frequency" ...
  std::vector<double> values;
};

// [[identify.record]]
struct RecordChoice {
  std::string name;  // an identifier, unique
  std::filesystem::path file;
  identification::MotionKind motion = identification::MotionKind::free;  // of a grey box
  transient::Interpolation interpolation = {};    // of the displacements of supports that drive it
  std::vector<Assignment> set;                    // of a grey box: parameters of this record
  std::vector<DataColumn> columns;                // all of one length, doubtful rows left out
  std::vector<std::string> labels;                // of the rows, where the file has them; otherwise empty
  std::size_t doubtful = 0;                       // rows marked doubtful in the file, left out
  std::optional<StudyValue> added_mass;           // [kg], of the method added_mass with traces
  std::optional<StudyValue> static_displacement;  // [m], of the method resonance_magnification
  Position position;

  const DataColumn* find(const std::string& role) const;
};

// [[identify.parameter]]
struct IdentifiedParameter {
  std::size_t parameter = 0;  // index in Parameters::list, of a number
  UsualUnit unit;
  double lower = -kInfinity;
  double upper = kInfinity;
  bool each_record = false;
  std::string estimate;  // of the other methods: the estimate whose value it takes; "" of a grey box
  Position position;
};

// `fixed_from`: the value of a parameter as an earlier identification found it.
struct FixedEstimate {
  std::size_t parameter = 0;              // index in Parameters::list, of a number
  double value = 0.0;                     // SI
  double degrees_of_freedom = kInfinity;  // behind its variance
};

enum class IdentifyStart { given, free_decay };

// The excitation of a response curve: a force on the mass or the motion of its support.
enum class CurveOf { force, support };

// [identify]
struct IdentifyChoice {
  IdentifyMethod method = IdentifyMethod::grey_box;
  IdentifyStart start = IdentifyStart::given;  // of a grey box
  CurveOf curve = CurveOf::force;              // of half_power, resonance_magnification, forced_resonance
  std::optional<std::size_t> cycles;           // of log_decrement: number used; absent: all
  bool sensor_offset = false;                  // of free_decay: the sensor's zero is to be fitted
  // For free_decay and forced_resonance: converts ratios to N s/m and N. A free decay takes at most one of
  // the two, because it determines the other; a forced resonance takes the stiffness.
  std::optional<StudyValue> mass, stiffness;
  std::optional<StudyValue> reference_frequency;  // omega_h [rad/s] of free records
  std::vector<RecordChoice> records;              // at least one
  std::vector<IdentifiedParameter> parameters;    // of a grey box: at least one
  std::vector<FixedEstimate> fixed;
  std::vector<std::filesystem::path> files;           // all files read: of the records and of `fixed_from`
  std::vector<std::vector<double>> fixed_covariance;  // of `fixed`, in its order

  std::vector<InitialValues> initial;  // of the free records of a grey box

  // The values, except those in `initial`, that are expressions of parameters.
  std::vector<const StudyValue*> values() const;
};

}  // namespace frahm::studies
