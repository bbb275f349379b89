#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "solvers/tuning/exchange/band_scan.hpp"
#include "studies/provenance/group_columns.hpp"
#include "studies/tuning/optimum_columns.hpp"

// Shared by the parts of the record of a tuning.
namespace frahm::studies {

// A design parameter with its name and unit.
struct NamedDesign {
  const DesignChoice& choice;
  std::string name, unit;
};

// A result with the names and units of the study. study and result: must outlive it.
struct TuningAbout {
  TuningAbout(const Study& of_study, const TuningResult& of_result);

  double spoken_band(double si) const { return tune.band ? si / tune.band->unit.si_factor : si; }
  // For the certificate of a worst peak over a band, in the band's unit.
  std::optional<double> least_width_seen() const {
    if (!tune.band || tune.objective != tuning::Objective::minimax) return std::nullopt;
    return spoken_band(tuning::least_width_seen(tune.band->range));
  }

  const Study& study;
  const TuneChoice& tune;
  const TuningResult& result;
  const tuning::Optimum& optimum;
  std::vector<NamedDesign> designs;
  std::string band, band_unit = "1";
};

// A result with one number wherever there can be one, 1 in SI: all names of the record, and their units.
TuningResult example_of(const Study& study);

// Everything along the band: the responses, the schedule and the columns next to it; and the objectives of
// the designs compared, which a variance has even without a band.
void add_band(const TuningAbout& about, GroupColumns& columns);

// Every design parameter of several optima, a column for each knot of a schedule. named: of "k2_0" and
// "k2 at knot 0".
using NamedKnot = std::function<Named(const std::string& knot, const std::string& words)>;
void add_designs(const TuningAbout& about, const NamedKnot& named, const std::string& dimension,
                 const std::vector<const tuning::Optimum*>& optima, GroupColumns& columns);

}  // namespace frahm::studies
