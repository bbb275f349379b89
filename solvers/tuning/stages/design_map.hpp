#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "solvers/tuning/exchange/band_curve.hpp"

// The responses over the whole box of a tuning's constants, and the places where a search begins.
namespace frahm::tuning {

// What a design is worth on the map.
struct DesignMerit {
  double objective = 0.0;  // NaN: no value, or without bound
  double violation = 0.0;  // of the limits, relative, <= 0 where they are met

  // One measure of both: a broken limit counts ten times its share.
  double joint() const;
};
using MeritAt = std::function<DesignMerit(std::span<const double> value)>;

// For a search that was stopped: the first cells only.
struct DesignMap {
  std::size_t dimensions = 0;  // the parameters whose bounds differ
  int along = 0;               // cells of each of them
  std::vector<std::vector<double>>
      design;                      // middle of each cell, one value per parameter; the first varies most
  std::vector<DesignMerit> merit;  // of each
  std::size_t seen() const;        // cells whose design has a value
};

// Whether a map of the constants takes well below a second: at most three that vary, few masses, one response
// at each frequency.
bool may_be_mapped(const Task& task);

// Cells of equal share of the box: even, or by equal ratios where a parameter ranges over more than a decade.
DesignMap map_designs(const DesignSpace& space, const MeritAt& merit_at,
                      const std::function<bool()>& stop_asked);

// The cells that none of their neighbours, diagonal ones too, undercuts, the best first: by objective and
// violation jointly or, where no cell meets the limits, by the violation. At most `most`.
std::vector<std::vector<double>> lowest_places(const DesignMap& map, std::size_t most);

// Low cells elsewhere: each the lowest of those that lie two cells or more from all lowest places and from
// one another. A valley narrower than a cell may have its mouth there. At most `most`.
std::vector<std::vector<double>> low_places_elsewhere(const DesignMap& map, std::size_t most);

// The largest of the curves of constant designs at a few places about every resonance: within some per cent
// of the true maxima.
class SampledCurves {
 public:
  // All must outlive it. task: not of several responses. stop_asked: between responses; after it a design has
  // no merit.
  SampledCurves(const Task& task, const DesignSpace& space, const std::vector<CurveKind>& curves,
                Effort& effort, const std::function<bool()>& stop_asked);

  // Its objective is 0 where no curve is of the objective.
  DesignMerit at(std::span<const double> value);

 private:
  const Task& task_;
  const DesignSpace& space_;
  const std::vector<CurveKind>& curves_;
  std::vector<BandCurve> responses_;  // of each curve
  std::vector<double> heights_;       // of one of them
};

}  // namespace frahm::tuning
