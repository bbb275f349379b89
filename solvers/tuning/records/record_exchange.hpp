#pragma once

#include <functional>
#include <string>
#include <vector>

#include "solvers/tuning/optimum.hpp"
#include "solvers/tuning/problem/problem.hpp"
#include "solvers/tuning/records/record_peaks.hpp"

namespace frahm::tuning {

// The exchange: a problem at finitely many times solved, then the true peaks of its design found, which join
// these times, until the two agree (Remez; tuning/exchange/exchange.hpp).
//
// With a share below 1 the objective Q is an order statistic of the scenarios' peaks, which has a kink where
// two of them change places. So the scenarios above Q are left out, and the worst of the others is pressed
// down; then those above are chosen again:
//   Q(x') <= worst of the kept at x' <= worst of the kept at x = Q(x),
// so that Q never rises. Where the choice stays the same, each scenario that holds the design is left out in
// turn in place of the lowest of those left out, as long as that lowers Q. What is reached is a local
// minimum of Q wherever no scenario above Q is as low as Q: near it Q is the worst of the kept.
class RecordExchange {
 public:
  // Both must outlive the exchange.
  RecordExchange(const RecordTask& task, const std::function<bool()>& stop_asked)
      : task_(task), stop_asked_(stop_asked) {}

  Optimum run(std::vector<double> design);

 private:
  // The best design so far.
  struct Best {
    std::vector<double> design;
    DesignPeaks found;              // of it
    Solution solution;              // it is of
    std::vector<PeakPlace> solved;  // the active times of that solution
  };

  bool goes_on() const { return best_.found.failure.empty() && failure_.empty() && !stop_asked_(); }
  DesignPeaks look(const std::vector<double>& design);
  double counted(const DesignPeaks& found) const;
  void join(const DesignPeaks& found);
  std::vector<PeakPlace> active_kept() const;
  void close_gap();
  bool choose_again();
  bool exchange_one();
  bool lowers(std::vector<bool> left_out);
  std::vector<std::size_t> holding() const;

  Optimum written();
  void weigh();
  void judge();
  void end(Outcome outcome, std::string reason);
  void write_parameters(bool known);
  void write_peaks(bool known);

  const RecordTask& task_;
  const std::function<bool()>& stop_asked_;
  std::vector<bool> left_out_;  // scenarios
  std::vector<std::vector<bool>> chosen_;
  std::vector<PeakPlace> active_;
  Best best_;
  std::string failure_;   // why a motion could not be followed
  std::string why_none_;  // why one had no derivative where the last round ended
  Optimum optimum_;
};

}  // namespace frahm::tuning
