#pragma once

#include <complex>

#include "solvers/quantities/measured.hpp"

// The quantities as functions of what was measured, and what their derivatives need of them. The table
// (quantity_table.cpp) gives the meaning of each.
namespace frahm::periodic::value {

double amplitude(const Measured&, const Asked&);
double peak(const Measured&, const Asked&);  // of any trace
double peak_phase(const Measured&, const Asked&);
double mean(const Measured&, const Asked&);
double rms(const Measured&, const Asked&);
double phase(const Measured&, const Asked&);  // of a mass or element
double harmonic(const Measured&, const Asked&);
double drift(const Measured&, const Asked&);
double mean_velocity(const Measured&, const Asked&);
double magnification(const Measured&, const Asked&);
double transmissibility(const Measured&, const Asked&);
double energy(const Measured&, const Asked&);
double energy_share(const Measured&, const Asked&);
double damping_energy(const Measured&, const Asked&);
double damping_energy_share(const Measured&, const Asked&);
double stops(const Measured&, const Asked&);
double reversals(const Measured&, const Asked&);
double stuck_fraction(const Measured&, const Asked&);
double regime(const Measured&, const Asked&);
double slipping(const Measured&, const Asked&);
double status(const Measured&, const Asked&);
double floquet_radius(const Measured&, const Asked&);
double coexisting(const Measured&, const Asked&);
double period_multiple(const Measured&, const Asked&);
double unsettled(const Measured&, const Asked&);
double continuum(const Measured&, const Asked&);
double energy_input(const Measured&, const Asked&);
double energy_balance(const Measured&, const Asked&);
bool is_balanced(const Measured&);
// Whether an energy that is missing in a period [J] is rounding: below 1e-9 of the energies that are put in
// and lost, and the rounding of the work, a part of energy^2: the larger energy norm of the orbit and of the
// static response [sqrt(J)].
bool is_balanced(double missing, double energies, double energy);
double force_transmissibility(const Measured&, const Asked&);
double residual(const Measured&, const Asked&);
double error_bound(const Measured&, const Asked&);
double newton_iterations(const Measured&, const Asked&);
double events(const Measured&, const Asked&);
double natural_frequency(const Measured&, const Asked&);
double modal_damping(const Measured&, const Asked&);

// Integral over a period of (w^T q + p^T y) times oscillator k [m s]; the same with a Gram matrix and motion
// of one's own.
double integral(const mechanics::Incidence& at, const Eigen::MatrixXd& gram, const Eigen::MatrixXd& motion,
                Eigen::Index oscillators, Eigen::Index k);
// X_n of w^T q + p^T y = Re X_n e^{i n omega t} + ..., n the reference order [m].
// What joints add to it, of any column of the Gram matrix.
double joint_integral(const mechanics::Incidence& at, const JointRows& joints, const Eigen::MatrixXd& gram,
                      Eigen::Index column);
// w^T v + p^T y' + j^T x' as a row of the Gram matrix.
Eigen::VectorXd velocity_row(const Measured& measured, const mechanics::Incidence& at,
                             const Eigen::MatrixXd& motion_velocity, const JointRows& joints);
std::complex<double> reference_component(const Measured& measured, const mechanics::Incidence& at);
// Whether the component of the asked trace is rounding of the motion as a whole: it may be as small as its
// closure error, and its phase is no one's then.
bool is_rounding(const Measured& measured, const Asked& asked, std::complex<double> component);
// Integral over a period of (w^T v + p^T y')^2 [m^2/s].
double square_of_velocity(const Measured& measured, const mechanics::Incidence& at);
// Fills in what the friction of each element takes out: its force times the distance its contact has slid.
void add_up_friction(Measured& measured);
// F of the velocities of the masses, the ground and the prescribed nodes [m/s], F y, (n + 1 + p) rows.
// motion_velocity: of the prescribed nodes, rows on the oscillators.
Eigen::MatrixXd velocity_rows(const Measured& measured, const Eigen::MatrixXd& motion_velocity);
// What the damping of the structure dissipates in a period [J], by the whole Gram matrix.
double structural_loss(const Measured& measured);
// Adds what the parts of an element have to that of the first, and leaves them zero.
void tell_together(const mechanics::Network& network, std::vector<double>& of_elements);
// Fills in what each element dissipates, and all together; from integrals, what friction takes out, and the
// structure's loss.
void add_up_losses(Measured& measured);
// If less than this is dissipated no element has a share [J]: where nothing moves, dampers dissipate the
// square of a rounding.
double least_dissipation(const Measured& measured);

}  // namespace frahm::periodic::value
