#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "solvers/identification/grey_box.hpp"
#include "solvers/identification/least_squares.hpp"
#include "solvers/identification/simulation.hpp"

namespace frahm::identification {

// The residuals of all records as functions of the unknowns.
class Misfit {
 public:
  explicit Misfit(const GreyBoxTask& task);  // the task must outlive it

  const std::vector<Unknown>& unknowns() const { return unknowns_; }
  Eigen::VectorXd start() const {
    Eigen::VectorXd p(static_cast<Eigen::Index>(unknowns_.size()));
    for (std::size_t i = 0; i < unknowns_.size(); ++i) p[static_cast<Eigen::Index>(i)] = unknowns_[i].start;
    return p;
  }
  // For all records: one for each channel.
  std::size_t series() const {
    std::size_t count = 0;
    for (const std::vector<double>& weights : weights_) count += weights.size();
    return count;
  }
  // The parameter of an unknown.
  std::size_t parameter(std::size_t unknown) const { return parameter_[unknown]; }
  Eigen::Index residuals() const {
    std::size_t count = 0;
    for (std::size_t r = 0; r < horizon_.size(); ++r) count += horizon_[r] * weights_[r].size();
    return static_cast<Eigen::Index>(count);
  }

  // As `Residuals` (least_squares.hpp). Unknowns that the mechanics refuses have no residuals.
  bool operator()(const Eigen::VectorXd& p, Eigen::VectorXd& r, Eigen::MatrixXd* by);
  // Throws what the mechanics refuses. by, by_fixed: unless null, derivatives by unknowns and fixed ones.
  bool evaluate(const Eigen::VectorXd& p, Eigen::VectorXd& r, Eigen::MatrixXd* by, Eigen::MatrixXd* by_fixed);
  const std::string& reason() const { return reason_; }  // why there were no residuals

  // From now on follows the first `seconds` of each record, and enough to determine every unknown. False: all
  // records are already followed in full.
  bool follow(double seconds);
  void follow_all();
  double longest_period(const Eigen::VectorXd& p);  // of all records [s]

  // At p some channel that varies in the measurement moves in the model too. True if no channel varies.
  bool moves(const Eigen::VectorXd& p);
  // Extremes of the computed motion at p, of the channel that has most.
  int turns(const Eigen::VectorXd& p);
  // Unknowns that change the friction force of a contact.
  std::vector<Eigen::Index> frictions(const Eigen::VectorXd& p) const;

  // p with one unknown moved to where a static force equals its force, for each that makes static forces
  // alone.
  std::vector<Eigen::VectorXd> without_static_forces(const Eigen::VectorXd& p) const;

  // 1 / standard deviation of each channel's residuals at p.  Returns by what factor, minus 1, the weights
  // change most against each other.
  double weigh_by_residuals(const Eigen::VectorXd& p);
  std::vector<FittedRecord> fitted(const Eigen::VectorXd& p);

 private:
  void add_unknowns(std::size_t parameter);
  bool simulate(std::size_t record, const Eigen::VectorXd& p, periodic::ObservedMotion& motion);
  std::vector<double> at(std::size_t record, const Eigen::VectorXd& p) const;
  Model model(std::size_t record, const Eigen::VectorXd& p, std::vector<Model>* by) const;
  Eigen::Index place(std::size_t record, std::size_t parameter) const {
    return static_cast<Eigen::Index>(first_[parameter] +
                                     (task_.parameters[parameter].each_record ? record : 0));
  }

  const GreyBoxTask& task_;
  std::vector<Simulation> simulations_;
  std::vector<std::size_t> horizon_;          // samples of each record that are followed
  std::vector<std::vector<double>> weights_;  // of each record's channels
  std::vector<Unknown> unknowns_;
  std::vector<std::size_t> first_;      // of each parameter: its first unknown
  std::vector<std::size_t> parameter_;  // of each unknown
  std::string reason_;
};

}  // namespace frahm::identification
