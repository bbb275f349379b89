#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "solvers/mechanics/linear_system.hpp"
#include "solvers/mechanics/network.hpp"
#include "studies/reading/quantities/parameters.hpp"
#include "studies/reading/study/identify_choice.hpp"
#include "studies/reading/study/motion_choice.hpp"
#include "studies/reading/study/study_values.hpp"
#include "studies/reading/study/sweep_choice.hpp"
#include "studies/reading/study/tune_choice.hpp"
#include "studies/reading/text/study_source.hpp"

namespace frahm::studies {

enum class StudyKind { sweep, decay, transient, tune, identify };

// A study, complete and checked: every value here is valid for the solvers.
struct Study {
  StudySource source;
  std::string title;  // "" if the study has none
  bool dimensionless = false;

  Parameters parameters;
  mechanics::Network network;  // empty in an identification by a formula
  StudyValues values;          // in a decay, frequency and excitation are unused

  // The options of its kind, in the order of StudyKind.
  std::variant<SweepChoice, DecayChoice, TransientChoice, TuneChoice, IdentifyChoice> choice;

  StudyKind kind() const { return static_cast<StudyKind>(choice.index()); }

  // Its choice, where the study is of this kind; otherwise null.
  const SweepChoice* sweep() const { return std::get_if<SweepChoice>(&choice); }
  const DecayChoice* decay() const { return std::get_if<DecayChoice>(&choice); }
  const TransientChoice* transient() const { return std::get_if<TransientChoice>(&choice); }
  const TuneChoice* tune() const { return std::get_if<TuneChoice>(&choice); }
  const IdentifyChoice* identify() const { return std::get_if<IdentifyChoice>(&choice); }
  SweepChoice* sweep() { return std::get_if<SweepChoice>(&choice); }
  TransientChoice* transient() { return std::get_if<TransientChoice>(&choice); }
  TuneChoice* tune() { return std::get_if<TuneChoice>(&choice); }
  IdentifyChoice* identify() { return std::get_if<IdentifyChoice>(&choice); }
  // The axes and what is recorded of a sweep, or of a transient with axes; otherwise null.
  const MapChoice* map() const;
  MapChoice* map();
  // For a decay or a transient.
  const MotionChoice* motion() const;
  MotionChoice* motion();

  // What is searched where it may have several responses.
  periodic::OrbitsWanted orbits_wanted() const;

  // The initial values of its masses: of a decay, a transient or an identification.
  std::span<const InitialValues> initial() const;

  // The values outside the network that are expressions of parameters.
  std::vector<const StudyValue*> values_of_its_kind() const;
};

// Whether the measurements and earlier results of an identification, and the records that drive a transient,
// are read too. If not, its records have no columns, no samples, and no parameter is fixed.
enum class DataFiles { read, leave };

std::string_view kind_name(StudyKind kind);  // as the study writes it
std::string_view kind_noun(StudyKind kind);  // in sentences: "a tuning"

// Whether masses may be held by no spring: in motions from initial values, and in periodic responses under
// exact laws of networks without joints and stops.
mechanics::FreeMasses free_masses(StudyKind kind, const mechanics::Network& network);

// Gives the parameters of a dimension of the map their SI values at one index (Parameters::list order).
void set_along(const MapChoice& map, std::size_t dimension, std::size_t index, std::span<double> parameters);

// The dimensions of the map along which these parameters change, ascending; none unless the study has a map.
std::vector<std::size_t> dimensions_moving(const Study& study, std::span<const std::size_t> reads);

// Whether a parameter runs over the band of a tuning.
bool runs_over_band(const TuneChoice& tune, std::size_t parameter);
// Whether it runs over that band or along an axis of a map.
bool has_axis(const Study& study, std::size_t parameter);

// The unit of a number parameter in messages and for bare numbers in orbits, --at and --set: that of its
// axis, band or bounds, otherwise that of its definition, otherwise "" for SI; with its factor to SI.
UsualUnit usual_unit(const Study& study, std::size_t parameter);

}  // namespace frahm::studies
