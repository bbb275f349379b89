#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "solvers/transient/record.hpp"
#include "studies/reading/study/map_choice.hpp"
#include "studies/reading/study/study_values.hpp"

// The options of a study of kind "decay" or "transient".
namespace frahm::studies {

// A mass's initial values [m], [m/s].
struct InitialValues {
  std::size_t mass = 0;  // index in Network::masses
  StudyValue displacement, velocity;
};

// One motion from initial values.
struct MotionChoice {
  std::optional<StudyValue> duration;  // [s]
  int samples = 0;                     // of the history; 0: none
  std::vector<InitialValues> initial;
};

// [decay]
struct DecayChoice : MotionChoice {
  std::optional<StudyValue> reference_frequency;  // omega_h [rad/s]
};

// [[excitation.record]], or corners of a force or motion: what drives one component of the excitation.
struct DrivingRecord {
  std::size_t excitation = 0;                // in Network::excitations, of a recorded kind
  bool on_axis = false;                      // an axis gives the records
  std::vector<transient::Record> records{};  // one, or that of each value of the axis
  Position position{};                       // of corners

  bool is_corners() const { return !records.empty() && records.front().is_corners; }
};

// What drives the motion at a value of the axis of records: records of `driving`.
std::vector<transient::RecordedExcitation> driven_by(const std::vector<DrivingRecord>& driving,
                                                     std::size_t of_axis);
double end_of_records(const std::vector<DrivingRecord>& driving);  // of the longest [s]

// [transient]
struct TransientChoice : MotionChoice {
  std::optional<StudyValue> sweep_to;    // of a run-up or run-down: the last frequency [rad/s]
  std::optional<StudyValue> sweep_rate;  // its angular acceleration, without sign [rad/s2]
  std::optional<MapChoice> map;          // a motion at each point of its axes; nothing: one motion
  std::vector<DrivingRecord> records;    // without their samples where data are left (DataFiles)
};

}  // namespace frahm::studies
