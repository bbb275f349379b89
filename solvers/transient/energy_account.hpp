#pragma once

#include <Eigen/Core>
#include <vector>

#include "solvers/flow/linear_form.hpp"
#include "solvers/transient/motion.hpp"

namespace frahm::transient {

// The energies of a motion on the exact flow, step after step: what each element dissipates,
//   integral of c v^2 (damper, hysteretic), of s^2 / c (Maxwell), of F |v| (friction that slides),
//   of c v^2 or c (v - D) v beyond a place of the displacement or of the velocity (an element that bends),
// what the damping of the structure does,
// and the work of the excitation: of the outside forces on the masses, and of what drives each prescribed
// node. Six-point Gauss-Legendre between the events, as of a periodic orbit (quantities/integrals.hpp).
class EnergyAccount {
 public:
  using Flow = periodic::Flow<Eigen::Dynamic, Eigen::Dynamic>;
  using State = typename Flow::S::State;
  using Mode = periodic::Mode<Eigen::Dynamic, Eigen::Dynamic>;
  using Expansion = periodic::Expansion<Eigen::Dynamic, Eigen::Dynamic>;
  using Instant = periodic::Instant<Eigen::Dynamic, Eigen::Dynamic>;

  // Both must outlive the account.
  EnergyAccount(const mechanics::Assembly& assembly, const Flow& flow);

  // Sets masses, element laws and forcing; to be called after the flow has got them.
  void set_system(const mechanics::LinearSystem& system);

  // Kinetic energy of masses and inerters, potential energy of springs, those in Maxwell elements and beyond
  // places of the displacement too [J];
  // phase: omega t of the fundamental [rad].
  double energy_of(const State& z, double phase) const;

  void open(double energy) { initial_ = energy; }  // [J] at the start
  void put_in(double energy);  // [J] at an instant, by another system or the jump of a support

  // The first `length` of a step in this mode.
  void follow(const Mode& mode, const Expansion& step, double length);
  // Whether a whole step in this mode needs no expansion: the mode has met so many that its integrals are
  // tabulated. It then follows from its start.
  bool is_tabulated(const Mode& mode);
  void follow(const Mode& mode, const Instant& start);
  // What each element, and last the structure, will have dissipated at the end of that part of the step [J].
  std::vector<double> dissipated_within(const Mode& mode, const Expansion& step, double length);

  const std::vector<double>& dissipated() const { return total_.dissipated; }  // so far, likewise [J]
  EnergyBudget budget(double energy_now) const;

 private:
  using Form = periodic::LinearForm<Eigen::Dynamic, Eigen::Dynamic>;

  // A power, of the form x, and y where there is one.
  enum class Power {
    square,   // coefficient x^2
    sliding,  // coefficient |x|, while its contact slides
    product,  // coefficient x y
    recoil,   // -coefficient max(x, 0) y: a stop past its place that pushes no more gives up what it stored
  };
  struct Loss {
    std::size_t element = 0;  // the number of elements: of the structure
    double coefficient = 0.0;
    Power power = Power::square;
    Eigen::Index contact = -1;

    bool has_two_forms() const { return power == Power::product || power == Power::recoil; }
  };
  struct Energies {
    std::vector<double> dissipated;        // [J] of each element, and of the structure where it damps
    double input = 0.0, input_size = 0.0;  // integrals of the excitation's power and of its size [J]
  };

  // A form by its factors that are not zero, of state and oscillators one after the other.
  struct Factor {
    Eigen::Index column = 0;
    double value = 0.0;
  };
  // What one mode takes: of each loss its form or two, then force and velocity of each drive.
  struct Account {
    periodic::ContactMask stuck = 0, positive = 0, beyond = 0;
    std::vector<Loss> losses;
    std::vector<std::vector<Factor>> forms;
    std::vector<Eigen::Index> columns;  // that some form reads
    int whole_steps = 0;                // so far
    // The forms at the nodes of a whole step, kNodes rows each, from its start: of_z z + of_u u + constant.
    // Empty: not tabulated.
    Eigen::MatrixXd of_z, of_u;
    Eigen::VectorXd constant;

    void add(const Form& form);
  };

  Account& account_of(const Mode& mode);
  double energy_of_bends(const State& z, const typename Flow::S::Oscillators& u) const;
  void list_losses(Account& account) const;
  void add_bends(const Mode& mode, Account& account) const;
  void add_drives(const Mode& mode, Account& account) const;
  void find_columns(Account& account) const;
  void tabulate(const Mode& mode, Account& account);
  void turn_oscillators(const Mode& mode);
  void sample(const Account& account, const Expansion& step, double length);
  void integrate(const Account& account, const Mode& mode, double length, Energies& energies) const;

  const mechanics::Assembly& assembly_;
  const Flow& flow_;
  periodic::Forms<Eigen::Dynamic, Eigen::Dynamic> forms_;
  std::vector<mechanics::Incidence> mass_incidences_;  // the displacement of each mass by itself

  mechanics::LinearSystem system_;
  double forcing_ = 0.0;  // largest energy norm of the static response so far [sqrt(J)]

  Eigen::MatrixXd rates_;  // of the structure's damping
  std::vector<Account> accounts_;
  std::size_t current_ = 0;  // of them
  Eigen::MatrixXd
      turn_;  // the oscillators at the nodes of a whole step, kNodes rows each, by those at its start
  std::vector<double> at_columns_;  // workspace: each column at the nodes of a step
  Eigen::VectorXd at_nodes_;        // each form at the nodes of a step

  double initial_ = 0.0;  // [J]
  Energies total_;
};

}  // namespace frahm::transient
