#pragma once

#include <string>
#include <vector>

#include "solvers/transient/record.hpp"
#include "studies/reading/study/study_context.hpp"
#include "studies/reading/system/network_reading.hpp"

// [[excitation.record]]: measured or generated forces and motions of supports, of a transient.
namespace frahm::studies {

// What a record drives.
struct RecordedPlace {
  std::string key;   // acceleration_of, velocity_of, displacement_of or force_on
  std::string node;  // a mass or a support
  transient::RecordOf of = transient::RecordOf::force;
};

// The tables of all records, each as a section. Throws StudyError for unknown keys.
std::vector<TomlSection> record_sections(const StudySource& source, const TomlValue& excitation);

// Throws StudyError unless exactly one of the four keys is there.
RecordedPlace place_of(const TomlSection& section);

// What a force or motion is counted in: a force (of a rotation a torque), a length, a speed or an
// acceleration. node: as mechanics::Excitation::node counts masses, joints and supports.
Quantity quantity_of_course(const mechanics::Network& network, transient::RecordOf of, std::size_t node);
Quantity quantity_of(const RecordedPlace& place, const mechanics::Network& network);

// Refuses records in studies other than transients.
void refuse_records(const StudyContext& context, const TomlValue& excitation, StudyKind kind);

// The components of the excitation that are records; their values are read once units are converted.
void read_recorded_components(NetworkReading& reading, const TomlValue& excitation);

}  // namespace frahm::studies
