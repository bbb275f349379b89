#pragma once

#include <Eigen/Dense>
#include <array>
#include <compare>
#include <map>
#include <utility>
#include <vector>

#include "solvers/mechanics/network.hpp"

// A second independent reference, fast enough for thousands of networks. It stamps its own equations from the
// network, element by element, and shares no code with the solvers. The harmonics of the forcing and a one
// are states too, so that in each state of the contacts and bends the motion is X(t + h) = exp(A h) X(t): its
// Taylor series is summed to rounding over fixed steps. Every end of a state is a root of a polynomial in the
// step (isolated_roots.hpp). The modes of contacts at
// rest are found by trying all.
namespace frahm::periodic {

class ExponentialIntegrator {
 public:
  ExponentialIntegrator(const mechanics::Network& network, const mechanics::NetworkValues& values);

  // At phase 0, from displacements [m], velocities [m/s] and internal forces [N] of Maxwell and Jenkins
  // elements in the order of the elements, then the displacements of joints [m].
  void start(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& s = {});
  void pass_period();

  Eigen::Index masses() const { return n_; }
  Eigen::Index internal_forces() const { return internal_; }
  Eigen::VectorXd state() const { return x_.head(2 * n_ + internal_); }  // q, v, s
  Eigen::VectorXd displacements() const { return x_.head(n_); }
  Eigen::VectorXd velocities() const { return x_.segment(n_, n_); }
  // (max - min) / 2 of the displacement of a mass since the start [m], stationary points solved; only where
  // `watches_extremes`.
  double amplitude(Eigen::Index mass) const { return 0.5 * (most_[mass] - least_[mass]); }
  bool watches_extremes = true;
  // Coulomb contacts that have stuck since this was last cleared, one bit each.
  unsigned stuck_throughout = ~0U;
  unsigned coulomb_contacts() const;
  long events() const { return events_; }

 private:
  enum class Mode : unsigned char { stuck, forward, backward };  // of a contact
  enum class Side : unsigned char { before, beyond, free };      // of a bend; free: a stop that would pull
  struct Contact {
    Eigen::VectorXd w;                       // of the masses
    Eigen::RowVectorXd speed, support_rate;  // u', and the support's part of u'', of the state
    double limit = 0.0, static_limit = 0.0;
    Eigen::Index internal = -1;  // of a Jenkins element: its place in the state
  };
  struct Bend {
    Eigen::VectorXd w;               // along its side
    Eigen::RowVectorXd past, force;  // u - D or u' - D, and the force beyond
    bool jumps = false;              // a stop with damping: it may only push
  };
  struct Modes {
    std::vector<Mode> contact;
    std::vector<Side> bend;
    auto operator<=>(const Modes&) const = default;
  };
  // The end of a mode. Each contact and bend has up to two.
  struct End {
    std::size_t index = 0, which = 0;  // of the contacts, then the bends
  };
  // The linear system in one state of all contacts and bends.
  struct Piece {
    Eigen::MatrixXd A;             // X' = A X
    Eigen::MatrixXd lambda, rate;  // rows: force of each contact that holds its velocity; u'' of each
    bool is_possible = true;       // the velocities held do not contradict each other
    std::vector<End> ends;
    Eigen::MatrixXd forms;  // a row for each end: a form of the state that is positive while the mode lasts
  };

  void stamp(const mechanics::Network& network, const mechanics::NetworkValues& values);
  void stamp_element(const mechanics::Element& element, double value, double second, double omega_h);
  void stamp_internal_force(const mechanics::Element& element, double k, double second,
                            Eigen::Index internal);
  void stamp_joints(const mechanics::Network& network, const mechanics::NetworkValues& values);
  void stamp_bend(const mechanics::Element& element, const mechanics::BendPlace& place,
                  const mechanics::BendValue& value);
  Eigen::VectorXd direction(const mechanics::Element& element) const;
  Eigen::RowVectorXd motion(const mechanics::Element& element, int derivative) const;
  Eigen::RowVectorXd harmonic(std::size_t node, int derivative) const;
  void set_step();
  Piece make_piece(const Modes& modes) const;
  const Piece& piece(const Modes& modes);
  void set_forcing_states();
  void add_ends(const Modes& modes, Piece& piece) const;
  std::pair<double, End> first_of_ends();
  void advance(double h);
  void expand(double h);
  void move(double part);
  void note_extremes(double end);
  void pass(const End& end);
  void pass_contact(std::size_t j, std::size_t which);
  void pass_bend(std::size_t b, std::size_t which);
  bool is_consistent(const std::vector<std::size_t>& at_rest, const Modes& modes);
  void choose(const std::vector<std::size_t>& at_rest);
  void bring_to_rest();
  std::vector<std::size_t> stuck_contacts() const;
  bool holds(std::size_t j) const { return contacts_[j].internal < 0; }

  Eigen::Index n_ = 0, internal_ = 0, size_ = 0;
  Eigen::Index first_joint_ = 0;  // in the state
  Eigen::MatrixXd joint_rates_;   // x' of the joints, of the state
  std::vector<int> orders_;
  std::vector<mechanics::Excitation> excitations_;
  std::vector<mechanics::ExcitationValue> excitation_values_;
  double omega_ = 0.0, step_ = 0.0, speed_scale_ = 1.0;
  int steps_ = 0;
  Eigen::MatrixXd M_, M_inverse_, force_,
      rates_;  // M q'' = force X, s' = rates X: without contacts and bends
  std::vector<Contact> contacts_;
  std::vector<Bend> bends_;
  std::map<Modes, Piece> pieces_;

  Eigen::VectorXd x_;        // q, v, s, cos and sin of each order, 1
  Eigen::VectorXd typical_;  // sizes of the state, of which rounding is a part
  Modes modes_;
  std::vector<std::array<int, 2>> zeros_;  // of each end: it starts at zero now and grows with this power
  const Piece* now_ = nullptr;
  Eigen::MatrixXd taylor_;  // column k: A^k X h^k / k!
  Eigen::MatrixXd guards_;  // column i: coefficients of the i-th end's polynomial over the step
  Eigen::Index terms_ = 0;
  Eigen::VectorXd most_, least_;
  long events_ = 0;
};

}  // namespace frahm::periodic
