#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <limits>
#include <span>
#include <sstream>

#include "results/hdf5.hpp"
#include "solvers/algebra/solve.hpp"
#include "solvers/mechanics/modes.hpp"
#include "solvers/response/periodic_response.hpp"
#include "studies/map/map_plan.hpp"
#include "studies/reading/parse_study.hpp"
#include "studies/reading/study/study.hpp"
#include "tests/studies/temporary_folder.hpp"
#include "tests/study_path.hpp"

namespace matrices_study_test {
namespace {

using namespace frahm::studies;
using namespace frahm::mechanics;
using frahm::periodic::Path;
using frahm::periodic::PeriodicResponse;
using frahm::periodic::Quantity;

constexpr double kSameOrbit = 1e-11;  // relative to the value, of a mean to the peak
constexpr double kRounding = 1e-12;

NetworkValues values_of(const Study& study) {
  NetworkValues values;
  std::vector<double> parameters = study.parameters.nominal();
  evaluate(study.values, study.parameters, parameters, values);
  return values;
}

LinearSystem system_of(const Study& study) {
  LinearSystem system;
  Assembly(study.network).set_values(values_of(study), system);
  return system;
}

std::vector<double> quantities_of(const Study& study, const std::vector<std::string>& names, Path path) {
  std::vector<Quantity> quantities;
  for (const std::string& name : names) {
    const auto found = frahm::periodic::find_quantity(name, study.network);
    INFO(name);
    REQUIRE(found);
    quantities.push_back(*found);
  }
  PeriodicResponse response(study.network, quantities, path);
  const NetworkValues values = values_of(study);
  std::vector<double> out(quantities.size());
  frahm::periodic::ResponseSummary summary;
  response.solve_row({&values, 1}, {&summary, 1}, out);
  return out;
}

std::string exact(double value) {
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  text << value;
  return text.str();
}

// As most programs write a full matrix.
void write_market(const std::filesystem::path& path, const Eigen::MatrixXd& matrix) {
  std::ofstream file(path);
  file << "%%MatrixMarket matrix array real general\n% a comment\n"
       << matrix.rows() << " " << matrix.cols() << "\n";
  for (Eigen::Index j = 0; j < matrix.cols(); ++j)
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) file << exact(matrix(i, j)) << "\n";
}

// The lower triangle of a sparse one.
void write_sparse_market(const std::filesystem::path& path, const Eigen::MatrixXd& matrix) {
  std::ostringstream entries;
  int count = 0;
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
    for (Eigen::Index i = j; i < matrix.rows(); ++i) {
      if (matrix(i, j) == 0.0) continue;
      entries << i + 1 << " " << j + 1 << " " << exact(matrix(i, j)) << "\n";
      ++count;
    }
  }
  std::ofstream(path) << "%%MatrixMarket matrix coordinate real symmetric\n"
                      << matrix.rows() << " " << matrix.cols() << " " << count << "\n"
                      << entries.str();
}

void write_csv(const std::filesystem::path& path, const Eigen::MatrixXd& matrix) {
  std::ofstream file(path);
  file << "# N s/m\n";
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) file << (j == 0 ? "" : ", ") << exact(matrix(i, j));
    file << "\n";
  }
}

// Three storeys with dampers and an absorber on top; friction in two of them. The first three are given by
// elements or by their matrices.
const std::string heading = "[study]\nschema = 1\nkind = \"sweep\"\n[parameters]\nF = 0.3\nr = 1.7\n";
const std::string storeys = R"(
[[mass]]
repeat = { i = [1, 3] }
name = "u{i}"
mass = "1 + 0.3*{i}"
[[element]]
name = "k1"
type = "spring"
between = ["ground", "u1"]
stiffness = 25
[[element]]
repeat = { i = [2, 3] }
name = "k{i}"
type = "spring"
between = ["u{i-1}", "u{i}"]
stiffness = "20 + {i}"
[[element]]
name = "c1"
type = "damper"
between = ["ground", "u1"]
damping = 0.4
[[element]]
name = "c3"
type = "damper"
between = ["u1", "u3"]
damping = 0.2
[[element]]
name = "b2"
type = "inerter"
between = ["u1", "u2"]
inertance = 0.5
)";
const std::string driven = R"(
[excitation]
frequency = "r"
[[excitation.force]]
on = "u3"
amplitude = 1
[[axis]]
parameter = "r"
values = [1.0, 2.0]
)";
const std::string rest = R"(
[[mass]]
name = "absorber"
mass = 0.2
[[element]]
name = "ka"
type = "spring"
between = ["u3", "absorber"]
stiffness = 0.6
[[element]]
name = "f1"
type = "coulomb"
between = ["ground", "u1"]
force = "F"
[[element]]
name = "f2"
type = "coulomb"
between = ["u2", "u3"]
force = "0.5*F"
)" + driven;
const std::string matrices =
    "[[matrices]]\nname = \"building\"\nnames = [\"u1\", \"u2\", \"u3\"]\nmass = \"M.mtx\"\n"
    "stiffness = \"K.mtx\"\ndamping = \"C.csv\"\n";

// The matrices of the storeys, in the files that the study names.
void export_storeys(const TemporaryFolder& folder) {
  const LinearSystem system = system_of(parse_study(heading + storeys + driven, "storeys.toml"));
  write_market(folder / "M.mtx", system.M);
  write_sparse_market(folder / "K.mtx", system.K);
  write_csv(folder / "C.csv", system.C);
}

TEST_CASE(
    "a network and its exported matrices have the same orbit, with friction and masses attached by name") {
  const TemporaryFolder folder;
  export_storeys(folder);
  for (const std::string friction : {"F = 0.05", "F = 0.3", "F = 1.2"}) {
    for (const Path path : {Path::fastest, Path::general}) {
      const auto with_friction = [&](std::string text) {
        return text.replace(text.find("F = 0.3"), 7, friction);
      };
      const Study network = parse_study(with_friction(heading + storeys + rest), folder / "network.toml");
      const Study imported = parse_study(with_friction(heading + matrices + rest), folder / "imported.toml");
      CHECK(imported.network.masses == std::vector<std::string>{"absorber", "u1", "u2", "u3"});
      std::vector<std::string> names{"f1_energy",         "f2_energy",           "f1_stroke",
                                     "f2_stuck_fraction", "floquet_radius",      "force_transmissibility",
                                     "energy_input",      "natural_frequency_3", "modal_damping_2"};
      for (const std::string mass : {"u1", "u2", "u3", "absorber"}) {
        for (const std::string what :
             {"_peak", "_rms", "_velocity_peak", "_acceleration_peak", "_peak_phase"})
          names.push_back(mass + what);
      }
      const auto a = quantities_of(network, names, path), b = quantities_of(imported, names, path);
      for (std::size_t i = 0; i < names.size(); ++i) {
        INFO(friction << ": " << names[i] << " " << a[i] << " " << b[i]);
        CHECK(std::abs(a[i] - b[i]) <= kSameOrbit * std::max(std::abs(a[i]), 1e-3));
      }
      const auto losses = quantities_of(network, {"c1_energy", "c3_energy", "energy_input"}, path);
      const auto own = quantities_of(imported, {"damping_energy", "energy_balance"}, path);
      CHECK(std::abs(losses[0] + losses[1] - own[0]) <= kSameOrbit * losses[2]);
      CHECK(own[1] < kRounding);
    }
  }
}

TEST_CASE("matrices are read from HDF5 too") {
  const TemporaryFolder folder;
  export_storeys(folder);
  const LinearSystem system = system_of(parse_study(heading + storeys + driven, "storeys.toml"));
  {
    auto file = frahm::results::hdf5::File::create(folder / "model.h5");
    auto group = file.root().create_group("reduced");
    for (const auto& [name, matrix] : {std::pair{"M", system.M}, std::pair{"K", system.K}}) {
      auto dataset = group.create_dataset(name, {.type = frahm::results::Type::float64, .shape = {3, 3}});
      const std::vector<std::uint64_t> start{0, 0}, count{3, 3};
      dataset.write(start, count, std::as_bytes(std::span(matrix.data(), 9)));
    }
  }
  std::string text = matrices;
  text.replace(text.find("M.mtx"), 5, "model.h5:/reduced/M");
  text.replace(text.find("K.mtx"), 5, "model.h5:reduced/K");
  const Study from_market = parse_study(heading + matrices + driven, folder / "a.toml");
  const Study from_hdf5 = parse_study(heading + text + driven, folder / "b.toml");
  CHECK(from_hdf5.network.matrices[0].mass == from_market.network.matrices[0].mass);
  CHECK(from_hdf5.network.matrices[0].stiffness == from_market.network.matrices[0].stiffness);
}

TEST_CASE("another number in a matrix file is another study, the same number in another form is not") {
  const TemporaryFolder folder;
  export_storeys(folder);
  const auto physics = [&] {
    return plan_map(parse_study(heading + matrices + rest, folder / "a.toml"), {}).fingerprint.physics;
  };
  const std::string before = physics();
  const LinearSystem system = system_of(parse_study(heading + storeys + driven, "storeys.toml"));
  write_market(folder / "K.mtx", system.K);
  CHECK(physics() == before);
  Eigen::MatrixXd K = system.K;
  K(0, 0) *= 1.0 + 1e-15;
  write_market(folder / "K.mtx", K);
  CHECK(physics() != before);
}

TEST_CASE(
    "a lever on a part that its matrices hold is accepted, and with a smooth law one on a part that floats "
    "is not") {
  const TemporaryFolder folder;
  export_storeys(folder);
  const std::string lever =
      "[[element]]\nname = \"lever\"\ntype = \"damper\"\nalong = { ground = -1, u1 = 2, u2 = -1 }\ndamping = "
      "1\n";
  CHECK_NOTHROW(parse_study(heading + matrices + lever + driven, folder / "a.toml"));
  const Eigen::Index n = system_of(parse_study(heading + storeys + driven, "storeys.toml")).K.rows();
  Eigen::MatrixXd floats = Eigen::MatrixXd::Identity(n, n) - Eigen::MatrixXd::Constant(n, n, 1.0 / double(n));
  write_market(folder / "K.mtx", floats);
  CHECK_NOTHROW(parse_study(heading + matrices + lever + driven, folder / "a.toml"));
  const std::string rub =
      "[[element]]\nname = \"rub\"\ntype = \"coulomb\"\nbetween = [\"u1\", \"u2\"]\nforce = 1\nlaw = "
      "\"arctan\"\nslope = "
      "1e3\n";
  CHECK_THROWS_AS(parse_study(heading + matrices + lever + rub + driven, folder / "a.toml"), StudyError);
}

TEST_CASE("the imported mast has the natural frequencies of a cantilever and its compliance") {
  const Study study = read_study(FRAHM_SOURCE_DIR "/studies/structures/imported_model.toml");
  const LinearSystem system = system_of(study);
  std::vector<double> frequency, damping;
  frahm::periodic::modes_of(system, frequency, damping);
  // omega_i = (beta_i L)^2 sqrt(EI / (m L^4)), cos(beta L) cosh(beta L) = -1 (R. D. Blevins, Formulas for
  // Natural Frequency and Mode Shape, 1979, table 8-1); twelve elements are a little stiffer.
  const double EI = 168e3, m = 15.0, L = 3.0;
  const double beta_L[] = {1.8751040687119611, 4.6940911329741746, 7.8547574382376126};
  const double too_stiff[] = {1e-6, 1e-4, 6e-4};
  for (std::size_t i = 0; i < 3; ++i) {
    const double exact = beta_L[i] * beta_L[i] * std::sqrt(EI / m) / (L * L);
    INFO("mode " << i + 1 << ": " << frequency[i] / exact - 1.0);
    CHECK(frequency[i] > exact);
    CHECK(frequency[i] < exact * (1.0 + too_stiff[i]));
  }
  CHECK(std::abs(damping[0] - 0.01) < kRounding);
  CHECK(std::abs(damping[11] - 0.02) < kRounding);
  // A load P at the tip moves it by P L^3 / (3 EI), exactly so in beam elements.
  const Eigen::VectorXd tip = Eigen::VectorXd::Unit(12, 11);
  CHECK(frahm::algebra::solve_positive(system.K, tip)[11] == Approx(L * L * L / (3.0 * EI)).epsilon(1e-10));
}

}  // namespace
}  // namespace matrices_study_test
