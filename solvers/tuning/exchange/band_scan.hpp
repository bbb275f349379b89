#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "solvers/tuning/exchange/band_curve.hpp"
#include "solvers/tuning/exchange/resonance_places.hpp"
#include "solvers/tuning/problem/problem.hpp"

namespace frahm::tuning {

// All true local maxima of the curves of one design over their bands.
struct Scan {
  struct Maximum {
    std::size_t curve = 0;
    double at = 0.0, value = 0.0;
    std::size_t sides = 1;
    bool is_end = false;  // the curve jumps down next to it
  };
  struct Extreme {
    double at = 0.0, value = -kInfinity;
    bool periodic = true;  // its point is that of an orbit
  };
  std::vector<Maximum> maxima;    // by curve, then along the band
  std::vector<Extreme> tightest;  // of each curve, where it is highest, however low that is
  double worst = 0.0;             // of the objective's curves; infinite where the response has no bound
  double violation = 0.0;         // by which the other curves exceed 1
  bool failed = false, unbounded = false;
  double at = 0.0;     // where it failed or is unbounded; NaN: a variance, which is of no place of the band
  std::string reason;  // why
};

// Scans of designs, one after the other.
class BandScan {
 public:
  // All must outlive the scan. stop_asked: a stopped scan ends at once and is invalid.
  BandScan(const Task& task, const DesignSpace& space, const std::vector<CurveKind>& curves, Effort& effort,
           const std::function<bool()>& stop_asked);

  // floor, accuracy: see find_band_maxima.
  Scan of(std::span<const double> x, double floor, double accuracy);

 private:
  void scan_curve(std::span<const double> x, std::size_t curve, double floor, double accuracy, Scan& scan);

  const Task& task_;
  const DesignSpace& space_;
  const std::vector<CurveKind>& curves_;
  const std::function<bool()>& stop_asked_;
  std::vector<std::unique_ptr<BandCurve>> responses_;  // of each curve
};

// The width below which a scan may miss a peak [band parameter, SI]: its points lie no closer about a
// resonance, and intervals are halved no further.
double least_width_seen(const Band& band);

// Points of a curve's band at a design between which no peak is missed (resonance_places.hpp): a list for
// each stretch between leaps of a schedule.
std::vector<std::vector<double>> places_of(const Task& task, const DesignSpace& space, const CurveKind& curve,
                                           std::span<const double> x, const PlacesFineness& fineness);

}  // namespace frahm::tuning
