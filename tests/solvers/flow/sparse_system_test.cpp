#include <catch2/catch.hpp>
#include <random>

#include "solvers/flow/flow.hpp"
#include "tests/known_answers/random_network.hpp"

// Large systems take their Taylor series from the equation of motion, small ones from tables. Both are the
// same flow.
namespace frahm::periodic::sparse_system_test {
namespace {

constexpr int kAny = Eigen::Dynamic;
using AnyFlow = Flow<kAny, kAny>;

constexpr double kSeries = 1e-12;  // of the largest coefficient of the same power
constexpr double kMoved = 1e-12;   // of the largest entry: e^3 of rounding in each long step
constexpr double kRough = 1e-2;    // the same in single precision, of a series that ends at 1e-3

struct LargeSystem {
  mechanics::LinearSystem system;
  AnyFlow flow;

  LargeSystem(int masses, int contacts, std::mt19937& random) {
    const RandomNetwork drawn = random_network(
        {.masses = masses, .contacts = contacts, .orders = {1, 2}, .largest_friction = 0.7}, random);
    const mechanics::Assembly assembly(drawn.network);
    assembly.set_values(drawn.values, system);
    assembly.set_forcing(drawn.values, system);
    flow.set_system(system);
    flow.set_forcing(system);
  }

  // The tables that a small system would have, from dense products.
  StepTables<kAny, kAny> tables(const Configuration<kAny, kAny>& configuration) const {
    const auto& eq = flow.equations();
    const Eigen::Index n = eq.masses();
    StepTables<kAny, kAny> result;
    const Eigen::MatrixXd left = -configuration.projector(eq) * eq.M_inverse;
    result.Aq = left * eq.K;
    result.Av = left * eq.C;
    result.As = left * eq.D;
    result.Af = left * eq.W;
    result.P = configuration.projector(eq);
    result.propagate_homogeneous(eq, configuration.spring);
    result.propagate_forcing(eq, configuration.spring, configuration.Au, configuration.internal_drive);
    REQUIRE(result.E.rows() == 2 * n + eq.internal_forces());
    return result;
  }
};

TEST_CASE("The Taylor series of a large system are those of the tables, whatever sticks") {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (const int masses : {8, 13}) {
    for (const int contacts : {1, 4, 7}) {
      LargeSystem large(masses, contacts, random);
      AnyFlow& flow = large.flow;
      REQUIRE(flow.equations().is_large());
      const Eigen::Index states = flow.equations().states();
      for (ContactMask stuck = 0; stuck < bit(contacts); stuck += 1 + (bit(contacts) > 20 ? 12 : 0)) {
        const std::size_t index = flow.mode_index(stuck, ~stuck, 0);
        const auto& mode = flow.mode(index);
        const SparseRows& held = flow.configuration(mode).held.force;  // taken row by row, at every set
        CHECK((held.diagonals.empty() && held.full.size() == 0));
        const StepTables<kAny, kAny> tables = large.tables(flow.configuration(mode));
        Instant<kAny, kAny> at;
        flow.instant_at(Eigen::VectorXd::NullaryExpr(states, [&] { return normal(random); }), 0.4, mode, at);
        Expansion<kAny, kAny> x;
        flow.expand(at, mode, x);
        const Eigen::VectorXd expected =
            tables.series_z * at.z + tables.series_u * at.u + tables.series_f * mode.friction;
        const Eigen::Map<const Eigen::MatrixXd> by_power(expected.data(), kTerms, states);
        INFO("masses " << masses << " contacts " << contacts << " stuck " << stuck);
        for (int k = 0; k < kTerms; ++k) {
          CHECK((x.z.row(k) - by_power.row(k)).cwiseAbs().maxCoeff() <
                kSeries * (1e-3 + by_power.row(k).cwiseAbs().maxCoeff()));
        }
      }
    }
  }
}

TEST_CASE("A tangent that is moved in long steps is that of single steps") {
  std::mt19937 random(6);
  LargeSystem large(11, 4, random);
  AnyFlow& flow = large.flow;
  const Eigen::Index states = flow.equations().states();
  for (const ContactMask stuck : {0, 1, 6, 15}) {
    const auto& mode = flow.mode(flow.mode_index(stuck, 0, 0));
    const StepTables<kAny, kAny> tables = large.tables(flow.configuration(mode));
    // At the start the path removes what the held contacts do not allow.
    const std::size_t index = flow.mode_index(stuck, 0, 0);
    const TangentPath path{.first_mode = index, .stretches = {{.mode = index, .steps = 13.25}}};
    Eigen::MatrixXd moved, rough, expected = Eigen::MatrixXd::Identity(states, states);
    flow.tangent_along(path, Precision::exact, moved);
    flow.tangent_along(path, Precision::rough, rough);
    expected.block(11, 11, 11, 11) = flow.configuration(mode).projector(flow.equations());
    for (int step = 0; step < 13; ++step) expected = (tables.E * expected).eval();
    tables.move_by_fraction(0.25, expected);
    INFO("stuck " << stuck);
    CHECK((moved - expected).cwiseAbs().maxCoeff() < kMoved * expected.cwiseAbs().maxCoeff());
    CHECK((rough - expected).cwiseAbs().maxCoeff() < kRough * expected.cwiseAbs().maxCoeff());
  }
}

}  // namespace
}  // namespace frahm::periodic::sparse_system_test
