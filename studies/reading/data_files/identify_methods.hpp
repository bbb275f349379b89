#pragma once

#include <string>
#include <vector>

#include "studies/reading/data_files/record_form.hpp"
#include "studies/reading/study/study.hpp"

namespace frahm::studies {

// What the reading has to know of a method of identification. Its words are in keys/study_words.hpp, its
// formula in studies/identification/closed_form_methods.cpp.
struct MethodRow {
  std::vector<RecordForm> forms;  // that a record may have, the preferred first
  std::string estimates{};      // that a parameter can take, by what is stated and measured: "mass|stiffness"
  bool several_traces = false;  // takes several records, if all of them are traces
};

// The row of a study's method, once the headings of the records are read.
MethodRow method_row(const Study& study);

}  // namespace frahm::studies
