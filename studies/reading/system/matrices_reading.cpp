#include "studies/reading/system/matrices_reading.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "studies/reading/data_files/matrix_file.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/system/network_limits.hpp"
#include "studies/reading/system/network_reading.hpp"

namespace frahm::studies {
namespace {

constexpr double kUnsymmetric = 1e-9;  // of the largest entry; below, it is the rounding of a program
constexpr double kIndefinite = 1e-6;   // of an eigenvalue of the matrix scaled by its diagonal, likewise

// Names of the degrees of freedom: masses of the network from now on.
std::vector<std::size_t> read_names(NetworkReading& reading, const TomlSection& section) {
  const auto* list = section.require("names").as<TomlArray>();
  if (!list) section.fail(rules::wrong_type, "names", "expected a list of names: names = [\"u1\", \"u2\"]");
  if (list->empty()) section.fail(rules::empty, "names", "is an empty list");
  std::vector<std::size_t> nodes;
  for (const TomlValue& each : *list) {
    const std::string where = fmt::format("{}: names", section.where());
    const std::string name = read_identifier(section.source(), where, each);
    for (const auto& taken : reading.names) {
      if (taken.name != name) continue;
      throw section.source().error_at(
          rules::name_taken, each.position,
          "{}: \"{}\" is already the name of {}; nodes and elements need different names", where, name,
          taken.owner);
    }
    reading.names.push_back({name, section.where()});
    nodes.push_back(reading.result.network.masses.size());
    reading.result.network.masses.push_back(name);
    reading.masses.push_back(each.position);
    reading.result.values.mass.push_back(
        {.quantity = Quantity::mass, .where = where, .position = each.position});
  }
  return nodes;
}

void check_size(const TomlSection& section, const std::string& key, const Eigen::MatrixXd& matrix,
                std::size_t names) {
  if (matrix.rows() != matrix.cols())
    section.fail(rules::wrong_matrix, key, "is {} x {}, not square", matrix.rows(), matrix.cols());
  if (static_cast<std::size_t>(matrix.rows()) != names)
    section.fail(rules::beyond_schema(rules::wrong_length), key, "is {} x {}, but {} name{} given",
                 matrix.rows(), matrix.cols(), names, names == 1 ? " is" : "s are");
}

void check_symmetric(const TomlSection& section, const std::string& key, const Eigen::MatrixXd& matrix) {
  Eigen::Index i = 0, j = 0;
  const double worst = (matrix - matrix.transpose()).cwiseAbs().maxCoeff(&i, &j);
  if (worst <= kUnsymmetric * matrix.cwiseAbs().maxCoeff()) return;
  section.fail(rules::wrong_matrix, key, "is not symmetric: entry ({}, {}) is {:.9g}, but ({}, {}) is {:.9g}",
               i + 1, j + 1, matrix(i, j), j + 1, i + 1, matrix(j, i));
}

// The least eigenvalue of the matrix scaled by its diagonal, d^-1/2 A d^-1/2, which no unit changes.
double least_eigenvalue(const Eigen::MatrixXd& matrix) {
  Eigen::VectorXd scale = matrix.diagonal().cwiseAbs().cwiseSqrt();
  const double largest = std::sqrt(matrix.cwiseAbs().maxCoeff());
  scale = (scale.array() > 0.0).select(scale, largest > 0.0 ? largest : 1.0).cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

void check_definite(const TomlSection& section, const std::string& key, const Eigen::MatrixXd& matrix) {
  const double least = least_eigenvalue(matrix);
  const bool is_mass = key == "mass";
  if (is_mass ? least > 1e-13 : least >= -kIndefinite) return;
  section.fail(rules::wrong_matrix, key,
               "is not positive {}: its smallest eigenvalue, scaled by its diagonal, is {:.3g}",
               is_mass ? "definite" : "semidefinite", least);
}

Eigen::MatrixXd read_one(const TomlSection& section, const std::string& key,
                         const std::filesystem::path& folder, std::size_t names) {
  const std::string file = section.text(key);
  Eigen::MatrixXd matrix;
  try {
    matrix = read_matrix_file(folder, file);
  } catch (const StudyError& error) {
    section.fail(error.rule(), key, "{}", error.what());
  }
  check_size(section, key, matrix, names);
  check_symmetric(section, key, matrix);
  matrix = 0.5 * (matrix + matrix.transpose()).eval();
  check_definite(section, key, matrix);
  return matrix;
}

}  // namespace

void read_matrices(NetworkReading& reading, const TomlValue& root, const std::filesystem::path& folder) {
  std::size_t number = 0;
  for (const TomlValue* table : read_tables(reading.context.source, root, "matrices")) {
    const TomlSection section(reading.context.source, *table,
                              label(*table, "matrices", "name", "matrices", ++number), "matrices");
    mechanics::MatrixPart part;
    part.name = section.identifier("name");
    take_name(reading, section, part.name, section.where());
    if (section.find("damping")) keep_name_of_damping(reading);
    part.nodes = read_names(reading, section);
    check_number_of_states(reading, section);
    part.mass = read_one(section, "mass", folder, part.nodes.size());
    part.stiffness = read_one(section, "stiffness", folder, part.nodes.size());
    if (section.find("damping")) part.damping = read_one(section, "damping", folder, part.nodes.size());
    reading.result.network.matrices.push_back(std::move(part));
  }
}

}  // namespace frahm::studies
