#pragma once

#include <Eigen/Core>
#include <stdexcept>
#include <vector>

#include "solvers/laws/law.hpp"
#include "solvers/mechanics/bends.hpp"
#include "solvers/mechanics/network.hpp"

namespace frahm::mechanics {

// A value that breaks a rule of the mechanics; what() names the thing, its value and the rule.
class MechanicsError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// How an element acts: u = w^T q + p^T y + j^T x, with q the displacements of the masses, y those of the
// prescribed nodes and x those of the joints: the factors of its direction.
struct Incidence {
  Eigen::VectorXd w;    // size n
  Eigen::VectorXd p;    // size of Network::prescribed
  Eigen::VectorXd j{};  // size of Network::joints

  bool has_joint() const { return j.size() > 0 && !j.isZero(0.0); }
};
Incidence incidence(const Network& network, const Direction& u);
Incidence incidence(const Network& network, const Element& element);

// The force on all supports together: of each element its force times -s_e, s_e the sum of its factors there.
// With c^T w_e = -s_e of every element but inerters it is c^T (P - M q'' - M_support y'') less s_e times the
// inerters' forces, P the forces on the masses; so c = 1 where all elements are between two nodes. It adds up
// forces or torques, not both.
struct SupportForce {
  Eigen::VectorXd counted;  // 1 of a mass on which a force counts (a torque, where the ground takes those), 0
  Eigen::VectorXd c;        // NaN where the motion of the masses does not tell what the supports take
  Eigen::VectorXd excess;   // c^T w_e + s_e of each element, of an inerter; otherwise 0
  Eigen::VectorXd joint_counted, joint_c;  // the same for forces on joints
};

// The part of an element with a law in a contact. Elements of a law that merges, along the same direction,
// act as one contact, whose limits are the sums of theirs; each carries a share of its force, F_j / sum F
// while it slides and the same for the static limits at rest.
struct ContactShare {
  std::size_t contact = 0;  // index of the contact
  double orientation = 1;   // +1 if the element points as the contact does, -1 otherwise
};

// Force of an element by its coefficients: k u + c v + b v' + the force of a contact + s.
struct ElementCoefficients {
  double stiffness = 0.0;         // k [N/m]
  double damping = 0.0;           // c [N s/m]; of a hysteretic element eta k / omega_h
  double inertance = 0.0;         // b [kg]
  double friction = 0.0;          // limit of the contact's force [N]
  double static_friction = 0.0;   // the same at rest [N], >= friction
  Eigen::Index internal = -1;     // index of the internal force s among the system's, -1: none
  double internal_damping = 0.0;  // of the damper that s runs through [N s/m], 0: none
};

// How the joints follow the masses (joints.hpp): their displacements are
//   x = B q + B_support y + A P(t) + X s,
// P(t) the forces on them, and s the internal forces: those of the joints' damped directions are the last
// ones. Without rows where the network has no joints.
// Shapes for j joints: B j x n, B_support j x p, A j x j, X j x s, load_drive j x s.
struct Joints {
  Eigen::MatrixXd B, B_support, A, X;
  Eigen::MatrixXd load_drive;     // s' = k (D^T q' + p^T y' + load_drive^T P') - rate s
  Eigen::VectorXd constant_load;  // P(t) [N], in the form of f(t) below
  Eigen::MatrixXcd load;
  Eigen::MatrixXd recorded_load;
  Eigen::MatrixXd damped;  // the combinations of joints that s belong to, j x (their number)
  // Of a derivative alone, which leaves `damped` as it is: of k in k X and of rate, s x s.
  Eigen::MatrixXd stiffness_by, rate_by;

  bool any() const { return B.rows() > 0; }
};

// Equation of motion of a network of n masses, p prescribed nodes and m contacts:
//
//   M q'' + C q' + K q + sum_e d_e s_e = f(t) - sum_j w_j lambda_j,
//   s_e' = k_e (d_e^T q' + p_e^T y') - rate_e s_e              of each internal force: a Maxwell element's, a
//                                                              contact's whose law has one, or of joints
//   lambda_j in F_j Sgn(w_j^T q' + p_j^T y')                   of each contact of the law `coulomb`; what
//                                                              others do, their law says (solvers/laws)
//   y(t) = y_0 + V t + Re sum_k Y_k e^{i order_k omega t}; V only of nodes whose displacement no law asks for
//   f(t) = f_0 + Re sum_k f_k e^{i order_k omega t}, which includes what the prescribed nodes exert
// and to y and f what is recorded.
//
// Shapes: M, C, K n x n; M_support, C_support, K_support n x p; W n x m; W_support p x m; D n x s; D_support
// p x s.
struct LinearSystem {
  double omega = 0.0;  // [rad/s]
  // R: a basis of the directions in which no spring holds the masses, n x r with R^T M R = 1; without columns
  // where K is positive definite (free_directions.hpp).
  Eigen::MatrixXd free_directions;
  // What takes up velocities along R: dampers, contacts with friction, internal forces and tables of dampers,
  // a row w^T R each; k x r.
  Eigen::MatrixXd resisted;
  Eigen::MatrixXd mass;  // of the nodes and of matrices, without inerters, n x n [kg], of rotations [kg m2]
  Eigen::MatrixXd M, C, K;
  Eigen::MatrixXd M_support, C_support, K_support;  // blocks that couple masses to prescribed nodes
  // S of the damping of the structure as a whole, which C and C_support include; 0 x 0 where there is none:
  // forces S v [N] on v = (velocities of the masses, the ground's, which is 0, those of the prescribed
  // nodes), of which it dissipates v^T S v [W] (structural_damping.hpp).
  Eigen::MatrixXd structural_damping;
  Eigen::MatrixXd W, W_support;                   // directions of the contacts
  Eigen::VectorXd limit;                          // F_j [N] of each contact
  Eigen::VectorXd static_limit;                   // of each contact's force at rest, >= F_j [N]
  std::vector<const laws::Law*> law;              // of each contact
  std::vector<Eigen::Index> contact_internal;     // index of each contact's internal force, -1: none
  Eigen::MatrixXd D, D_support;                   // directions d_e, p_e of the internal forces
  Eigen::VectorXd internal_stiffness;             // k_e [N/m]
  Eigen::VectorXd internal_rate;                  // k_e / c_e of a Maxwell element, 0 without a damper [1/s]
  std::vector<ElementCoefficients> coefficients;  // of each element
  Bends bends;                                    // their forces add to those of K and C
  // No force of a contact or element ever falls where its velocity rises, and no bend depends on the
  // displacement: then the response is unique.
  bool monotone = true;
  std::vector<int> orders;         // > 0, ascending: of the excitation, and the reference order
  int reference_order = 1;         // the harmonic of which phases are taken
  bool odd_forcing = false;        // every component of the excitation has an odd order
  bool odd_response = false;       // and the response repeats with the opposite sign after half a period
  Eigen::VectorXd constant_force;  // f_0 [N], size n
  Eigen::MatrixXcd force;          // column k is f_k [N]
  Eigen::VectorXd constant_applied_force;  // the part of f_0 that acts on the masses from outside
  Eigen::MatrixXcd applied_force;          // the part of f_k that does
  Eigen::VectorXd constant_motion;         // y_0 [m], size p
  Eigen::MatrixXcd motion;                 // column k is Y_k [m]
  Eigen::VectorXd belt_velocity;           // V [m/s], size p
  // A recorded excitation has four numbers at each instant: a measured force [N] or displacement [m], and its
  // first three derivatives by time (recorded_columns.hpp). Four columns each: what they exert on the masses;
  // the part of it that acts from outside; the displacements of the prescribed nodes.
  Eigen::MatrixXd recorded_force, recorded_applied_force;  // n x 4r
  Eigen::MatrixXd recorded_motion;                         // p x 4r
  Eigen::VectorXd recorded_size;   // of each number, what it is counted in (transient::RecordCourse::sizes)
  double recorded_interval = 0.0;  // between all times of the records [s]; 0: none, or they differ
  SupportForce support_force;
  Eigen::RowVectorXd felt_inertia, felt_inertia_support;  // its parts by -q'' and by -y''
  Joints joints;

  Eigen::Index masses() const { return M.rows(); }
  Eigen::Index contacts() const { return limit.size(); }
  Eigen::Index internal_forces() const { return internal_stiffness.size(); }
};

// Whether masses may be held by no spring: then K is positive definite but for the free directions, in which
// it is zero.
enum class FreeMasses { refused, allowed };

// Combinations of joints, in columns of j rows, that dampers strain, and those that none does; groups that no
// element joins lie side by side: of group g the damped ones are first[g], ... first[g + 1] - 1.
struct JointDirections {
  Eigen::MatrixXd damped, undamped;
  std::vector<Eigen::Index> first{0};
};

// Builds LinearSystems of one network. Topology is worked out once; `set_values` and `set_forcing` only fill
// numbers in and do not allocate after the first call.
class Assembly {
 public:
  // Keeps a copy. Throws MechanicsError.
  explicit Assembly(const Network& network, FreeMasses free = FreeMasses::refused);

  // Element and mass values -> matrices, internal forces and contact limits. Hysteretic elements make them
  // depend on omega, see matrices_depend_on_frequency().
  // Throws MechanicsError where a value is out of range, M is not positive definite, or K is not: of free
  // masses that are allowed, beside the free directions.
  void set_values(const NetworkValues& values, LinearSystem& system) const;

  // The friction of contacts alone, where nothing else has changed since set_values.
  void set_friction(const NetworkValues& values, LinearSystem& system) const;

  // Excitation values and omega -> forcing; `system` must hold the matrices of the same values.
  void set_forcing(const NetworkValues& values, LinearSystem& system) const;

  const Network& network() const { return network_; }
  const std::vector<Incidence>& incidences() const { return incidences_; }  // of each element
  const std::vector<ContactShare>& shares() const { return shares_; }  // of each element that has a contact
  const std::vector<int>& orders() const { return orders_; }
  std::size_t contacts() const { return contact_laws_.size(); }
  std::size_t internal_forces() const { return internal_forces_; }
  const Bends& bends() const { return bends_; }  // their directions and laws
  bool matrices_depend_on_frequency() const { return depends_on_frequency_; }
  // Sums of Network::matrices, n x n each; 0 x 0 where there are none.
  const MatrixPart& matrices() const { return matrices_; }
  const JointDirections& joint_directions() const { return joint_directions_; }

 private:
  void place_in_contact(std::size_t element);
  void add_up_matrices();
  void clean_floating_matrices();
  void check_stiffness(LinearSystem& system) const;
  void find_resisted(LinearSystem& system) const;
  void place_orders();
  void weigh_support_force();
  void check_values(const NetworkValues& values) const;
  void weigh_laws(const NetworkValues& values, LinearSystem& system) const;
  void add_crank(const Excitation& excitation, const ExcitationValue& value, LinearSystem& system) const;

  Network network_;
  FreeMasses free_;
  std::vector<Incidence> incidences_;
  std::vector<ContactShare> shares_;
  std::vector<Eigen::Index> internal_;  // of each element: index of its internal force, -1: none
  std::vector<const laws::Law*> contact_laws_;
  std::vector<Eigen::Index> contact_internal_;
  std::vector<int> orders_;
  SupportForce support_force_;
  bool odd_forcing_ = true, depends_on_frequency_ = false;
  std::size_t internal_forces_ = 0;
  MatrixPart matrices_;
  Bends bends_;
  JointDirections joint_directions_;
};

}  // namespace frahm::mechanics
