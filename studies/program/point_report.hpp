#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "solvers/quantities/quantity.hpp"
#include "solvers/response/periodic_response.hpp"
#include "studies/program/modes_table.hpp"
#include "studies/program/point_gradient.hpp"
#include "studies/program/point_responses.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_units.hpp"

namespace frahm::studies {

// The full report of one point.
struct PointReport {
  struct Parameter {
    std::string name;
    SpokenValue value;
  };
  struct QuantityValue {
    periodic::QuantityDescription description;
    double value = 0.0;  // NaN or a count of -1: no value
  };

  std::vector<Parameter> parameters;  // the numbers of the study
  std::string status;                 // meaning of the flag: "ok", "grazing", "several", "failed" ...
  std::string reason;                 // why there is no response; otherwise empty
  double residual = 0.0;              // 1
  std::string why_no_bound;           // of a response without an error bound: the reason; otherwise empty
  int newton_iterations = 0;
  periodic::Way way{};                         // how the orbit was found
  int passages = 0;                            // of the flow that the search took
  std::vector<QuantityValue> quantities;       // all_quantities, and those of a comparison
  std::vector<std::string> friction_elements;  // in the order of Stretch::contacts
  std::vector<periodic::Stretch> stretches;    // over the period; empty without a response
  std::optional<ModesAtPoint> modes;           // absent for invalid matrices
  std::optional<periodic::History> history;    // if asked for and there is a response
  std::optional<PointGradient> gradient;       // if asked for
  // If the response is one of a continuum, that and by which rule it was chosen; otherwise empty.
  std::string continuum;
  std::optional<std::vector<FoundResponse>> responses;  // if asked for
};

// Solves a point from nothing known, as a map does. parameters: SI values of all parameters, complete.
// path: the ways that are tried.
// history_samples: of the time history, both ends of the period included; 0: none is wanted. gradient: exact
// derivatives, next to differences, are wanted. responses: every one that was found is.
// Throws StudyError for a network that cannot move at any values.
PointReport tell_point(const Study& study, std::vector<double> parameters, periodic::Path path,
                       std::size_t history_samples, bool gradient, bool responses = false);

// "event phases" or "shooting".
const char* way_name(periodic::Way way);
// The value of a flag in words: "one_stop"; "" for a value that is no flag.
std::string flag_meaning(const periodic::QuantityDescription& description, double value);
// Whether a quantity has a value at the point: not NaN, and no count of -1.
bool has_value(const PointReport::QuantityValue& quantity);

// Prints the report as text. An excerpt of more than a hundred quantities has those of four masses and four
// elements, evenly chosen, and of the first modes.
void print_point(const Study& study, const PointReport& report, Listing listing, std::ostream& out);
// Prints one JSON object; a missing value is null. Angles in rad, the rest with its unit next to it.
void print_point_json(const Study& study, const PointReport& report, std::ostream& out);

}  // namespace frahm::studies
