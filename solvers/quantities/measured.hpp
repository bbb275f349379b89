#pragma once

#include <Eigen/Core>
#include <vector>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "solvers/quantities/candidate.hpp"
#include "solvers/quantities/contact_history.hpp"
#include "solvers/quantities/extreme_values.hpp"
#include "solvers/quantities/trace.hpp"

// The measurements of a periodic response, regardless of its solver's sizes, law and units of time. All
// quantities follow from them (quantity_values.hpp, quantity_derivatives.hpp).
namespace frahm::periodic {

// How joints follow y: rows over it of their displacements [m] and velocities [m/s]; none where there are no
// joints.
struct JointRows {
  Eigen::MatrixXd displacement, velocity;
};

// A requested quantity, and the index of its trace among those measured.
struct Asked {
  Quantity quantity;
  std::size_t trace = 0;
};

// Everything is SI. Only the data that the requested quantities need are filled in (request.hpp).
// y = (q, v, s, u): displacements [m] and velocities [m/s] of the masses, internal forces [N], and the
// oscillators of the forcing u = (1, cos(order_1 omega t), sin(order_1 omega t), ...).
struct Measured {
  const mechanics::Assembly* assembly = nullptr;
  const mechanics::LinearSystem* system = nullptr;
  const std::vector<Trace>* traces = nullptr;

  double period = 0.0;       // [s]
  bool half_period = false;  // x(t + T/2) = -x(t)

  std::vector<Extremes> extremes;                  // of each trace
  std::vector<std::vector<Candidate>> candidates;  // of each trace, if derivatives are requested

  // Integral of y y^T over a period [units of y^2 x s], y followed by the signals; of a signal its products
  // with the oscillators and its square alone.
  Eigen::MatrixXd gram;
  Eigen::MatrixXd motion, motion_velocity;  // of the prescribed nodes, rows on u [m], [m/s]
  JointRows joints;

  // What a period of the excitation adds to the displacements of free masses [m]; empty where none is free.
  Eigen::VectorXd drift;

  std::vector<ContactHistory> histories;  // of each contact; none of a law that never sticks
  std::vector<double> friction_loss;      // of each element in a period [J]
  std::vector<double> bend_loss;          // of each bend: the work that goes into it
  std::vector<double> loss;               // of each element in all
  double structural_loss = 0.0;           // of the structure's damping
  double dissipated = 0.0;                // in all [J] in a period
  double input = 0.0, input_size = 0.0;   // work of the excitation, integral of |its power| [J] in a period

  Status status{};
  double residual = 0.0;        // 1
  double error_bound = kNone;   // [m]
  double floquet_radius = 0.0;  // 1
  int coexisting = 1, multiple = 1, unsettled = 0;
  int free_sliders = 0;  // of jenkins and iwan elements, which never slip
  int newton_iterations = 0;
  int events = -1;           // in a period; -1: the law has none
  double static_norm = 0.0;  // energy norm of the static response to the excitation's amplitudes [sqrt(J)]
  double state_norm = 0.0;   // of the state at the section, where its motion is exact [sqrt(J)]

  std::vector<double> natural_frequency, modal_damping;  // [rad/s], 1

  Eigen::Index masses() const { return system->masses(); }
  // Where the oscillators begin in y: the constant, then cosine and sine of each order.
  Eigen::Index oscillators() const { return 2 * masses() + system->internal_forces(); }
  // Where the signals begin in the Gram matrix.
  Eigen::Index signals() const {
    return oscillators() + 1 + 2 * static_cast<Eigen::Index>(system->orders.size());
  }
  // The row of a mass, or of a joint or signal, in the Gram matrix.
  Eigen::Index row_of(const Asked& asked) const {
    const auto coordinate = static_cast<Eigen::Index>(asked.quantity.index);
    return coordinate < masses() ? coordinate : signals() + coordinate - masses();
  }
  const Trace& trace(const Asked& asked) const { return (*traces)[asked.trace]; }
};

// Converts velocities from displacement per step, of `step` seconds, to displacement per second.
void in_seconds(Eigen::Index masses, double step, Eigen::MatrixXd& gram);

// Adds the rows and columns of signals to the integral of y y^T. products: a row for each signal, its
// products with the oscillators, which y ends with, and last its square.
void append_signals(const Eigen::MatrixXd& products, Eigen::MatrixXd& gram);

// Derivatives a unit of the parameter: of a candidate's value [its unit] and of its instant as an angle omega
// t [rad]; and the relative change of the state there.
struct CandidateDerivative {
  double value = 0.0, angle = 0.0, state = 0.0;
};

struct ContactDerivative {
  double stuck_fraction = 0.0, sliding_distance = 0.0;  // 1, [m]
};

// The derivative of `Measured` along one direction, a unit of the parameter. Times scale with the period.
struct MeasuredDerivative {
  const mechanics::LinearSystem* system = nullptr;
  double log_period = 0.0;                                   // dT/T
  std::vector<std::vector<CandidateDerivative>> candidates;  // of each trace
  Eigen::VectorXd drift;
  Eigen::MatrixXd gram, motion, motion_velocity;
  JointRows joints;
  std::vector<ContactDerivative> contacts;
  std::vector<double> bend_loss, loss;
  double structural_loss = 0.0, dissipated = 0.0;
  std::vector<double> natural_frequency, modal_damping;
};

// A derivative, or why there is none.
struct Derivative {
  double value = kNone;
  const char* why_none = "";
};

}  // namespace frahm::periodic
