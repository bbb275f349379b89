#pragma once

#include <functional>
#include <vector>

#include "solvers/tuning/problem/problem.hpp"
#include "solvers/tuning/records/record_peaks.hpp"

namespace frahm::tuning {

// The design problem at finitely many times (epigraph):
//   minimise t, or the mean of one t_m for each motion m, over x and t
//   row i:  sign_i x(time_i; x) - t <= 0  for each active time i, t that of its motion
// A displacement at a fixed time is a lower bound of the peak, so the least t is one of the least peak.
class RecordProblem final : public Problem {
 public:
  // All must outlive the problem. start: a design; of each motion its largest peak there.
  RecordProblem(const RecordTask& task, const std::vector<PeakPlace>& active,
                const std::function<bool()>& stop_asked, std::span<const double> start,
                std::span<const double> peaks);

  double objective(std::span<const double> x, std::span<double> gradient) override;
  void constrain(std::span<const double> x, std::span<double> values, std::span<double> entries) override;
  bool stop_asked() override { return stop_asked_(); }

  std::size_t gradients() const { return gradients_; }  // motions followed with their derivatives
  // Why a motion of the design gone to last has no derivative; "": all have.
  const std::string& why_no_derivative() const { return why_none_; }

 private:
  std::size_t bounds() const { return variables.size() - task_.parameters.size(); }
  std::size_t motion_of(const PeakPlace& place) const {
    return place.scenario * task_.records.size() + place.record;
  }
  std::size_t bound_of(const PeakPlace& place) const {
    return task_.parameters.size() + (bounds() == 1 ? 0 : motion_of(place));
  }
  void add_rows();
  void go_to(std::span<const double> design);
  void follow(std::size_t scenario, std::size_t record, const mechanics::NetworkValues& values,
              const std::vector<mechanics::NetworkValues>& along);

  const RecordTask& task_;
  const std::vector<PeakPlace>& active_;
  const std::function<bool()>& stop_asked_;
  std::vector<double> design_;           // gone to last
  std::vector<double> sizes_;            // sign x of each active time there; NaN: not computed
  std::vector<std::vector<double>> by_;  // of each active time: by each design parameter
  std::size_t gradients_ = 0;
  std::string why_none_;
};

}  // namespace frahm::tuning
