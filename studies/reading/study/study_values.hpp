#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/network.hpp"
#include "studies/reading/quantities/expression.hpp"
#include "studies/reading/quantities/parameters.hpp"
#include "studies/reading/quantities/units.hpp"
#include "studies/reading/study/characteristic.hpp"
#include "studies/reading/text/study_source.hpp"

namespace frahm::studies {

using mechanics::Range;

// A number of the network as the study gives it: a constant or an expression of the parameters, in SI.
struct StudyValue {
  Expression expression{0.0};
  Quantity quantity = Quantity::number;
  Range range = Range::finite;
  std::string where;  // for messages: `element "guide": force`
  Position position;
  UsualUnit unit{};  // of a number that the study gives one

  bool is_given() const { return !where.empty(); }
};

// A combination of coordinates as the study gives it: `along = { roof = 1, wheel = "-r" }`. Its factors are
// part of the topology: they are the same at every point of a study.
struct StudyDirection {
  std::vector<mechanics::Node> nodes{};  // each once
  std::vector<StudyValue> factors{};     // of each node, not zero
  bool rotational = false;               // u is an angle
  bool twists_ground = false;            // as in mechanics::Element
  Position position;

  bool is_given() const { return !nodes.empty(); }
};

// A period that is given by its course, as the components of the excitation that its Fourier series has.
struct PeriodSeries {
  std::string what;                  // for messages: `motion of "base"`
  std::size_t first = 0, count = 0;  // in Network::excitations
  int orders = 0, harmonics = 0;     // the highest that may be there; how many above 0 are
  double left_out = 0.0;             // mechanics::CornerSeries::left_out
  std::string note{};                // what else is left out: `, and its mean, 0.1 m/s`
  std::string file{};                // that it is from, "": none; its samples in SI
  std::vector<double> time{}, samples{};
};

// All numbers of a network, in the order of mechanics::NetworkValues, and the directions of its signals.
struct StudyValues {
  StudyValue omega;
  std::vector<StudyValue> mass, amplitude, phase;
  // [i][e]: number i of element e, in the order of mechanics::ElementKind::values(); the constant 0 where it
  // has none.
  std::array<std::vector<StudyValue>, mechanics::numbers_of_an_element> elements;
  std::vector<StudyValue> rod;        // of each excitation, the constant 0 where it is no crank
  std::vector<StudyDirection> along;  // of each element, not given where it is between two nodes
  std::vector<StudyDirection> signals{};
  std::vector<StudyValue> damping;  // of the structure: modal ratios, or the two of rayleigh
  std::vector<StudyCharacteristic> characteristic{};  // of each element; of a table, in place of its value
  std::vector<StudyValue> points{};                   // of all characteristics
  std::vector<PeriodSeries> series{};

  const StudyValue& value(std::size_t e) const { return elements[0][e]; }
  const StudyValue& second(std::size_t e) const { return elements[1][e]; }
  // Those of masses, elements and the damping of the structure.
  std::vector<const std::vector<StudyValue>*> lists_of_system() const;
  // All but the frequency.
  std::vector<const std::vector<StudyValue>*> lists() const;
  // Those of an element's characteristic.
  std::span<const StudyValue> points_of(std::size_t e) const {
    return std::span(points).subspan(characteristic[e].first, characteristic[e].count);
  }
  bool has_smooth_laws() const;
  // Indices of the parameters that masses, elements and the damping of the structure read, and what an
  // element that depends on it reads of the frequency.
  std::vector<std::size_t> read_by_system(const mechanics::Network& network) const;
  // Indices of the parameters that the factors of directions read.
  std::vector<std::size_t> read_by_factors() const;
};

// The numbers of the network at one point of the map.
// parameters: SI values of all parameters in the order of Parameters::list; those of expressions and tables
// are recomputed in place.  out: resized at the first call, no allocation after it but for characteristics.
// Outside a table, or where an expression has no value, the results are not finite: the solver gives such a
// point the status `failed`.
void evaluate(const StudyValues& values, const Parameters& definitions, std::span<double> parameters,
              mechanics::NetworkValues& out);

// The exact derivative of the numbers of the network by one number parameter (SI both), the others fixed:
// a column of the Jacobian, laid out as evaluate() lays out the values. Allocates one dual per parameter.
void differentiate(const StudyValues& values, const Parameters& definitions,
                   std::span<const double> parameters, std::size_t by, mechanics::NetworkValues& out);

}  // namespace frahm::studies
