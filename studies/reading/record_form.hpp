#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "studies/reading/study.hpp"
#include "studies/reading/units.hpp"

// Which columns a record of measurements has, by the method that reads it.
namespace frahm::studies {

// What a column of measurements stands for.
struct Role {
  std::string name;
  Quantity quantity = Quantity::number;
  Range range = Range::finite;
  bool required = true;
  bool increases = false;  // from row to row
};

// Columns that belong together.
struct RecordForm {
  std::vector<Role> roles;
  std::size_t least_rows = 1;
  bool is_trace = false;  // over the time: no row has a label

  const Role* find(const std::string& name) const;
};

// Columns beside these: of any form which is no trace, and of any form.
inline constexpr const char* label_role = "label";
inline constexpr const char* doubtful_role = "doubtful";  // 1: the row is left out; 0: it counts

// The forms that a record of the study may have, the first preferred. Of a grey box: time, and
// <mass>_displacement, <mass>_velocity, <mass>_acceleration, <mass>_force and <support>_displacement.
std::vector<RecordForm> record_forms(const Study& study);

// All names that a column may have in one form or another.
std::vector<std::string> role_names(const std::vector<RecordForm>& forms);

// The form to which the columns found belong: the first that has all it requires, else the one of which most
// are there.
const RecordForm& form_of(const std::vector<RecordForm>& forms, const std::vector<std::string>& found);

// What it requires and what it may have, in words: `time and displacement`.
std::string described(const RecordForm& form);

// Columns of a measured excitation or of a mass's motion.
bool is_excitation(const Study& study, const std::string& role);
bool is_motion(const Study& study, const std::string& role);

}  // namespace frahm::studies
