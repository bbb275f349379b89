#pragma once

#include <array>
#include <complex>
#include <span>
#include <vector>

#include "solvers/nonstop/kernel.hpp"
#include "solvers/nonstop/sliding_forms.hpp"
#include "solvers/nonstop/sliding_modes.hpp"
#include "solvers/quantities/measured.hpp"
#include "solvers/quantities/request.hpp"

namespace frahm::periodic::nonstop {

// Orbits of a network on which no contact ever sticks, up to kLanes of them side by side. Where nothing
// sticks the response is linear but for the reversals, and these are one equation each, in their phases; the
// motion between them and all its quantities are explicit (solvers/README.md, 4). An orbit is proved not
// to stick, with a margin; by uniqueness it then is the only one. A point that is not proved is left to
// another solver.
//
// The value of a point depends on nothing but its own values: not on its neighbours, nor on the processor.
class NonstopSolver {
 public:
  // The assembly must outlive the solver.
  NonstopSolver(const mechanics::Assembly& assembly, const std::vector<Quantity>& quantities);

  // Whether it can serve the network at all: its contacts slide or stick, with no spring of their own.
  static bool serves(const mechanics::Assembly& assembly);

  // Takes the matrices of a row's points. False if they change from its first points on, but for friction
  // limits; if their modes are too close to each other; or if the values are refused.
  bool set_row(std::span<const mechanics::NetworkValues> points);
  // Puts a point of that row into a lane; false if its values are refused, or its matrices are others.
  bool set_point(int lane, const mechanics::NetworkValues& values);

  // Solves the points in the first `count` lanes.
  void solve(int count);
  bool is_found(int lane) const { return value_in_lane(pack_.is_found, 0, lane) != 0.0; }
  // For a point that is found: out[i] is quantity i. False if its energies do not balance; it then is not
  // found.
  bool quantities(int lane, std::span<double> out);
  // For the point whose quantities were taken last.
  const Measured& measured() const { return measured_; }

  void use(const Kernel& kernel) { kernel_ = &kernel; }  // another than the fastest, for tests

 private:
  bool shares_matrices(const mechanics::NetworkValues& values) const;
  bool set_matrices();
  void lay_out_shape();
  void lay_out_pack();
  void share_matrices();
  template <class Share>
  void share_inputs(const Share& share);
  void set_forms();
  Form integrated_form(const SlidingForms& forms, Eigen::Index row) const;
  void set_lane(int of, int lane);
  void measure(int lane);
  void set_motion(const mechanics::LinearSystem& system);
  double error_bound(int lane) const;
  double static_norm(const mechanics::LinearSystem& system) const;

  bool asks(Measure measure) const;
  static std::size_t size(Eigen::Index n) { return static_cast<std::size_t>(n); }
  static double value_in_lane(const double* array, std::size_t index, int lane) {
    return array[index * kLanes + static_cast<std::size_t>(lane)];
  }
  static void give(double* array, std::size_t index, int lane, double value) {
    array[index * kLanes + static_cast<std::size_t>(lane)] = value;
  }
  static void give(double* array, std::size_t index, int lane, std::complex<double> value) {
    give(array, 2 * index, lane, value.real());
    give(array, 2 * index + 1, lane, value.imag());
  }

  const mechanics::Assembly& assembly_;
  Request request_;
  std::array<mechanics::LinearSystem, kLanes> systems_;
  std::array<mechanics::NetworkValues, kLanes> values_;  // of these systems
  SlidingModes modes_;
  mechanics::NetworkValues modes_of_;  // the values that the modes are of, once has_modes_
  bool has_modes_ = false;
  bool needs_forces_ = false;    // some quantity follows from the forces that drive, next to the motion
  std::vector<Form> forms_;      // in the order of Shape
  std::vector<char> is_direct_;  // of each form: whether it has parts outside the state
  std::vector<std::size_t> forms_with_friction_;  // of single elements
  std::vector<Eigen::Index> driven_masses_;
  std::vector<std::size_t> elements_in_matrices_;
  Eigen::MatrixXd K_inverse_, M_inverse_;
  Eigen::VectorXd friction_norm_;        // energy norm of the static response to a unit force of each contact
  double fastest_rate_ = 0.0;            // of the modes [1/s]
  double displacement_of_energy_ = 0.0;  // largest displacement [m] of a unit of the energy norm
  Eigen::MatrixXcd left_force_, left_internal_;  // left * (0; M^-1; 0), left * (0; 0; I)

  struct Entry {
    Eigen::Index row = 0, column = 0;  // of the Gram matrix that a product is
  };
  std::vector<Eigen::Index> integrated_;  // rows of the Gram matrix: states and signals
  std::vector<Product> products_, powers_;
  std::vector<Entry> entries_;        // of the first products; the others are of structural_rates_
  Eigen::MatrixXd structural_rates_;  // what the structure dissipates is the sum of their squares
  Shape shape_;
  Pack pack_;
  std::vector<double> buffer_;
  double* workspace_ = nullptr;
  const Kernel* kernel_ = &fastest_kernel();
  Measured measured_;
};

}  // namespace frahm::periodic::nonstop
