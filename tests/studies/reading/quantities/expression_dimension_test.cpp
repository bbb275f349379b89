#include "studies/reading/quantities/expression_dimension.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

namespace expression_dimension_test {
namespace {

using namespace frahm::studies;

// k [N/m], m [kg], F [N], w [rad/s], x [m], zeta [1], and n of no known dimension.
const std::vector<std::string> names{"k", "m", "F", "w", "x", "zeta", "n"};
const std::vector<ExpressionDimension> dimensions{
    Exponents{0, 1, -2}, Exponents{0, 1, 0}, Exponents{1, 1, -2},  Exponents{0, 0, -1},
    Exponents{1, 0, 0},  Exponents{0, 0, 0}, ExpressionDimension{}};

// "any" where the dimension is not known.
std::string dimension_in_words(const std::string& text) {
  const ExpressionDimension found = dimension_of(Expression::parse(text, names), dimensions);
  return found ? described(*found) : "any";
}

void check_refused(const std::string& text, std::size_t column, const std::string& message) {
  INFO(text);
  try {
    dimension_of(Expression::parse(text, names), dimensions);
    FAIL("it was not refused");
  } catch (const ExpressionError& error) {
    CHECK(error.rule() == rules::wrong_dimension);
    CHECK(error.column() == column);
    CHECK(error.what() == message);
  }
}

TEST_CASE("products, quotients and powers of expressions multiply, divide and raise dimensions") {
  CHECK(dimension_in_words("k*x") == "a force (N)");
  CHECK(dimension_in_words("F/x") == "a stiffness (N/m)");
  CHECK(dimension_in_words("m*w^2") == "a stiffness (N/m)");
  CHECK(dimension_in_words("sqrt(k/m)") == "an angular frequency (rad/s)");
  CHECK(dimension_in_words("2*zeta*sqrt(k*m)") == "a damping (N s/m)");
  CHECK(dimension_in_words("(k/m)^(1/2)*x") == "a speed (m/s)");
  CHECK(dimension_in_words("F^-1*k") == "a quantity in m-1");
  CHECK(dimension_in_words("m/w^2") == "a quantity in kg s2");
  CHECK(dimension_in_words("sqrt(m)") == "a quantity in kg^0.5");
  CHECK(dimension_in_words("k*x/F") == "a pure number");
  CHECK(dimension_in_words("-abs(F)") == "a force (N)");
  CHECK(dimension_in_words("sin(w/w)*F") == "a force (N)");
}

TEST_CASE("terms of different dimensions are refused, with both and the place of the second") {
  check_refused("m + F", 5, R"("m" is a mass (kg), but "F" is a force (N); they cannot be added)");
  check_refused("3*(k*x - m*w)", 10,
                R"("k*x" is a force (N), but "m*w" is a damping (N s/m); they cannot be subtracted)");
  check_refused("x*max(k, (m))", 10,
                "\"k\" is a stiffness (N/m), but \"(m)\" is a mass (kg); they cannot be compared");
  check_refused("F + zeta", 5, R"("F" is a force (N), but "zeta" is a pure number; they cannot be added)");
  CHECK(dimension_in_words("F - k*x + min(F, m*w^2*x)") == "a force (N)");
}

TEST_CASE("transcendental functions and exponents take pure numbers") {
  check_refused("2*exp( F/k )", 8, R"("F/k" is a length (m), but exp takes a pure number)");
  check_refused("log(m)", 5, R"("m" is a mass (kg), but log takes a pure number)");
  check_refused("sin(w)", 5, R"("w" is an angular frequency (rad/s), but sin takes a pure number)");
  check_refused("2^x", 3, R"("x" is a length (m), but an exponent is a pure number)");
  CHECK(dimension_in_words("F*exp(-k*x/F)*cos(2*pi*zeta)") == "a force (N)");
  CHECK(dimension_in_words("x^n") == "any");
}

TEST_CASE("a plain parameter may have any dimension, and takes that of what it is added to") {
  CHECK(dimension_in_words("n*F") == "any");
  CHECK(dimension_in_words("n*F + k") == "a stiffness (N/m)");
  CHECK(dimension_in_words("sqrt(n)") == "any");
  CHECK(dimension_in_words("exp(n)*F") == "a force (N)");
}

TEST_CASE("numbers in a fitted formula may have units that nobody wrote") {
  // As a term a number is of the other term's dimension.
  CHECK(dimension_in_words("12.82 + m") == "a mass (kg)");
  CHECK(dimension_in_words("max(0, F - 3)") == "a force (N)");
  // As a factor one that is not whole may have any.
  CHECK(dimension_in_words("26.5104 + 0.4811*m") == "any");
  CHECK(dimension_in_words("w/sqrt(7*k/102.66)") == "any");
  CHECK(dimension_in_words("10985.1/w^2 - 12.82") == "any");
  // Pure numbers times a number are as such a number.
  CHECK(dimension_in_words("100*(1 - zeta)") == "any");
  CHECK(dimension_in_words("100*zeta + F") == "a force (N)");
  CHECK(dimension_in_words("zeta") == "a pure number");
}

TEST_CASE("in a formula of geometry all numbers without a unit are pure numbers as factors") {
  const auto in_geometry = [](const std::string& text) {
    const auto found = dimension_of(Expression::parse(text, names), dimensions, PlainFactor::pure_number);
    return found ? described(*found) : "any";
  };
  CHECK(in_geometry("0.37*x") == "a length (m)");
  CHECK(in_geometry("n*x/sqrt(0.7)") == "a length (m)");
  CHECK(in_geometry("1.3 + n + x") == "a length (m)");
  CHECK(in_geometry("0.37*n") == "any");
}

TEST_CASE("whole numbers, halves and pi are pure numbers as factors") {
  CHECK(dimension_in_words("6*k") == "a stiffness (N/m)");
  CHECK(dimension_in_words("m*w^2/12 + 0.5*k - 4/3*pi*k") == "a stiffness (N/m)");
  check_refused("2*m + 3/2*F", 7,
                R"("2*m" is a mass (kg), but "3/2*F" is a force (N); they cannot be added)");
}

}  // namespace
}  // namespace expression_dimension_test
