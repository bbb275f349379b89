#pragma once

#include <memory>
#include <span>
#include <string>

#include "solvers/identification/grey_box.hpp"
#include "solvers/quantities/observed_motion.hpp"

namespace frahm::identification {

// The model's prediction of a record: values of each channel at the record's times, and their derivatives.
class Simulation {
 public:
  // Throws mechanics::MechanicsError for a network that cannot move, or with the arctan law.
  // `record` must outlive it.
  Simulation(const mechanics::Network& network, const TimeRecord& record, const transient::Watch& watch);
  ~Simulation();
  Simulation(Simulation&&) noexcept;

  // out: as many rows as samples, the record's first so many; a column for each channel; a derivative along
  // each of `by`.  Returns "" or a sentence why there are no values, or, where `by` is not empty, no
  // derivatives.
  // Forced motions have the phase omega t of the record's own time. In free ones no harmonic is
  // excited, but constant loads and belts act; hysteretic elements then need NetworkValues::hysteretic_omega.
  // Throws mechanics::MechanicsError for values without a meaning.
  std::string run(const Model& model, std::span<const Model> by, std::size_t samples,
                  periodic::ObservedMotion& out);

  // For the model without excitation [s].
  double longest_period(const Model& model) const;

  struct Kind;

 private:
  std::unique_ptr<Kind> kind_;  // of the record's motion
};

}  // namespace frahm::identification
