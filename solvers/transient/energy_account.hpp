#pragma once

#include <Eigen/Core>
#include <vector>

#include "solvers/flow/linear_form.hpp"
#include "solvers/quantities/step_rows.hpp"
#include "solvers/transient/motion.hpp"

namespace frahm::transient {

// Which energies of a motion are kept: those of each element, or only what the balance needs.
enum class EnergyDetail { none, total, each };

// The energies of a motion on the exact flow, step after step: what each element dissipates,
//   integral of c v^2 (damper, hysteretic), of s^2 / c (Maxwell), of F |v| (friction that slides),
//   of c v^2 or c (v - D) v beyond a place of the displacement or of the velocity (an element that bends),
// what the damping of the structure does,
// and the work of the excitation: of the outside forces on the masses, and of what drives each prescribed
// node. Six-point Gauss-Legendre between the events, as of a periodic orbit (quantities/integrals.hpp).
// Over a whole step of one mode these sums are quadratic forms of state and forcing at its start, y:
//   sum over the steps of y^T Q y = sum over the entries of Q and of the matrix sum y y^T,
// so that the totals cost little where the energies of each element are not asked for.
class EnergyAccount {
 public:
  using Flow = periodic::Flow<Eigen::Dynamic, Eigen::Dynamic>;
  using State = typename Flow::S::State;
  using Mode = periodic::Mode<Eigen::Dynamic, Eigen::Dynamic>;
  using Expansion = periodic::Expansion<Eigen::Dynamic, Eigen::Dynamic>;
  using Instant = periodic::Instant<Eigen::Dynamic, Eigen::Dynamic>;

  // Both must outlive the account.
  EnergyAccount(const mechanics::Assembly& assembly, const Flow& flow,
                EnergyDetail detail = EnergyDetail::each);

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
  // A whole step in this mode, where its totals follow from its start. False: it is left to its expansion.
  bool follow_whole(const Mode& mode, const Instant& start, const Instant& end);
  // What each element, and last the structure, will have dissipated at the end of that part of the step [J].
  std::vector<double> dissipated_within(const Mode& mode, const Expansion& step, double length);

  const std::vector<double>& dissipated() const { return total_.dissipated; }  // so far, likewise [J]
  // Where only totals are kept, `dissipated` is one number, the sum, and the balance is referred to a part of
  // the energies: it is never less than that of the account of each element, but for rounding.
  EnergyBudget budget(double energy_now);

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
    double orientation = 1.0;  // of the form to its contact

    bool has_two_forms() const { return power == Power::product || power == Power::recoil; }
  };
  struct Energies {
    std::vector<double> dissipated;        // [J] of each element, and of the structure where it damps
    double of_whole_steps = 0.0;           // [J] of all elements together
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
    // For a whole step: input and loss are y^T Q y. Empty: not tabulated.
    Eigen::MatrixXd input, loss;
    std::vector<Eigen::Index> sliding;  // contacts whose loss is that of a speed which keeps its sign
    Eigen::MatrixXd starts;             // y of whole steps not yet summed up, a column each
    Eigen::Index pending = 0;           // of these columns

    void add(const Form& form);
  };

  Account& account_of(const Mode& mode);
  double energy_of_bends(const State& z, const typename Flow::S::Oscillators& u) const;
  void list_losses(Account& account) const;
  void add_bends(const Mode& mode, Account& account) const;
  void add_drives(const Mode& mode, Account& account) const;
  void find_columns(Account& account) const;
  void tabulate(const Mode& mode, Account& account);
  void add_whole_losses(const Mode& mode, const Eigen::MatrixXd& rows, Account& account) const;
  Eigen::MatrixXd rows_at_nodes(const Mode& mode, const Account& account);
  bool keeps_signs(const Account& account, const Mode& mode, const Instant& start, const Instant& end) const;
  void sum_up(Account& account);
  void sum_up_all();
  void sample(const Account& account, const Expansion& step, double length);
  void integrate(const Account& account, const Mode& mode, double length, Energies& energies) const;

  const mechanics::Assembly& assembly_;
  const Flow& flow_;
  EnergyDetail detail_;
  periodic::Forms<Eigen::Dynamic, Eigen::Dynamic> forms_;
  std::vector<mechanics::Incidence> mass_incidences_;  // the displacement of each mass by itself

  mechanics::LinearSystem system_;
  double forcing_ = 0.0;  // largest energy norm of the static response so far [sqrt(J)]

  Eigen::MatrixXd rates_;  // of the structure's damping
  std::vector<Account> accounts_;
  std::size_t current_ = 0;  // of them
  periodic::StepRows<Eigen::Dynamic, Eigen::Dynamic> step_rows_;
  std::vector<double> at_columns_;  // workspace: each column at the nodes of a step
  Eigen::VectorXd at_nodes_;        // each form at the nodes of a step

  double initial_ = 0.0;  // [J]
  Energies total_;
};

}  // namespace frahm::transient
