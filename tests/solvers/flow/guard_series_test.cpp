#include <catch2/catch.hpp>
#include <random>

#include "solvers/flow/flow.hpp"
#include "tests/known_answers/random_network.hpp"

// Systems with tables have the guards of their contacts as series of their own, so that the search for events
// need not expand the whole state. The plain way is by the state's expansion.
namespace frahm::periodic::guard_series_test {
namespace {

constexpr int kAny = Eigen::Dynamic;
constexpr double kSame = 1e-13;  // of the sum of the terms' sizes

// Three numbers of a record beside the harmonics, on the support and as a force on the first mass.
void add_record(mechanics::Network& network, mechanics::NetworkValues& values) {
  network.excitations.push_back({mechanics::ExcitationKind::recorded_motion, 0, 0});
  network.excitations.push_back({mechanics::ExcitationKind::recorded_force, 0, 0});
  values.excitation.push_back({1.0, 0.0});
  values.excitation.push_back({0.7, 0.0});
}

double size_of(const Expansion<kAny, kAny>& x, const Eigen::VectorXd& form, const Eigen::VectorXd& drive) {
  return (x.z.cwiseAbs() * form.cwiseAbs()).maxCoeff() + (x.u.cwiseAbs() * drive.cwiseAbs()).maxCoeff();
}

TEST_CASE("The series of a guard is that of the expanded state, whatever sticks and drives") {
  std::mt19937 random(31);
  std::normal_distribution<double> normal;
  for (int draw = 0; draw < 12; ++draw) {
    RandomNetwork drawn = random_network({.masses = 3 + draw % 4,
                                          .contacts = 3,
                                          .maxwell_elements = 1,
                                          .jenkins_elements = 1,
                                          .orders = {1, 3}},
                                         random);
    const bool has_record = draw % 2 == 1;
    if (has_record) add_record(drawn.network, drawn.values);
    const mechanics::Assembly assembly(drawn.network);
    mechanics::LinearSystem system;
    assembly.set_values(drawn.values, system);
    assembly.set_forcing(drawn.values, system);
    if (has_record) system.recorded_size = Eigen::VectorXd::LinSpaced(8, 1.0, 4.5);
    Flow<kAny, kAny> flow;
    flow.set_system(system);
    flow.set_forcing(system);
    if (has_record) flow.set_recorded(Eigen::VectorXd::LinSpaced(8, -0.9, 2.0), 0.3);
    const auto& eq = flow.equations();
    REQUIRE_FALSE(eq.is_large());
    const Eigen::Index contacts = eq.contacts();
    for (ContactMask stuck = 0; stuck < bit(contacts); ++stuck) {
      const auto& mode = flow.mode(flow.mode_index(stuck, 0b0101 & ~stuck, 0));
      Instant<kAny, kAny> at;
      flow.instant_at(Eigen::VectorXd::NullaryExpr(eq.states(), [&] { return normal(random); }), 0.4, mode,
                      at);
      Expansion<kAny, kAny> x;
      flow.expand(at, mode, x);
      for (Eigen::Index j = 0; j < contacts; ++j) {
        const bool sticks = contains(stuck, j);
        const Eigen::VectorXd own = sticks ? flow.configuration(mode).Lu.row(j) : eq.support_velocity.row(j);
        const Polynomial plain =
            sticks ? flow.stuck_force(x, mode, j) : Polynomial(x.velocity(eq.W.col(j)) + x.u * own);
        Eigen::VectorXd form = Eigen::VectorXd::Zero(eq.states());
        form.segment(eq.masses(), eq.masses()) = eq.W.col(j);
        if (sticks) form = flow.stuck_force_form(mode, j);
        INFO("network " << draw << ", stuck " << stuck << ", contact " << j);
        CHECK((flow.guard(at, mode, j) - plain).cwiseAbs().maxCoeff() < kSame * size_of(x, form, own));
      }
    }
  }
}

}  // namespace
}  // namespace frahm::periodic::guard_series_test
