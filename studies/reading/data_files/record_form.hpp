#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "studies/reading/quantities/units.hpp"
#include "studies/reading/study/study.hpp"

// Which columns a record of measurements has. The forms of each method: identify_methods.hpp.
namespace frahm::studies {

// The meaning of a column of measurements.
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
  bool is_trace = false;  // over time: no row has a label
  // A key of the record that this form needs and the method's other forms have no use for, and its meaning.
  std::string key{}, meaning_of_key{};

  const Role* find(const std::string& name) const;
};

// Further columns: labels in every form except traces, doubtful marks in every form.
inline constexpr const char* label_role = "label";
inline constexpr const char* doubtful_role = "doubtful";  // 1: the row is left out; 0: it counts

// All names that a column may have in any form.
std::vector<std::string> role_names(const std::vector<RecordForm>& forms);

// The form of the columns found: the first whose required columns are all there, otherwise the one with most
// of them.
const RecordForm& form_of(const std::vector<RecordForm>& forms, const std::vector<std::string>& found);

// The required and the optional columns, in words: `time and displacement`.
std::string described(const RecordForm& form);

// Columns of a measured excitation or of a mass's motion.
bool is_excitation(const Study& study, const std::string& role);
bool is_motion(const Study& study, const std::string& role);

}  // namespace frahm::studies
