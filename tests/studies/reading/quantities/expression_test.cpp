#include "studies/reading/quantities/expression.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace expression_test {
namespace {

using frahm::studies::Dual;
using frahm::studies::Expression;
using frahm::studies::ExpressionError;

// A few roundings of double arithmetic.
constexpr double rounding = 1e-14;

const std::vector<std::string> names{"omega", "I", "x"};

double value_of(const std::string& text, double x = 0.0) {
  const std::vector<double> values{2.0, 3.0, x};
  return Expression::parse(text, names).evaluate(std::span<const double>(values));
}

double derivative_of(const std::string& text, double x) {
  const std::vector<Dual> values{{2.0, 0.0}, {3.0, 0.0}, {x, 1.0}};
  return Expression::parse(text, names).evaluate(std::span<const Dual>(values)).derivative;
}

struct Complaint {
  std::string message;
  std::size_t column = 0;
};

Complaint complaint_about(const std::string& text) {
  try {
    Expression::parse(text, names);
  } catch (const ExpressionError& error) {
    return {error.what(), error.column()};
  }
  return {"none", 0};
}

void check_complaint(const std::string& text, std::size_t column, const std::string& part) {
  const Complaint complaint = complaint_about(text);
  INFO(text << "  ->  " << complaint.column << ": " << complaint.message);
  CHECK(complaint.column == column);
  CHECK_THAT(complaint.message, Catch::Contains(part));
}

TEST_CASE("an expression follows the precedence of mathematics") {
  CHECK(value_of("1 + 2*3") == 7.0);
  CHECK(value_of("(1 + 2)*3") == 9.0);
  CHECK(value_of("10 - 4 - 3") == 3.0);
  CHECK(value_of("24/4/2") == 3.0);
  CHECK(value_of("2^3^2") == 512.0);
  CHECK(value_of("-2^2") == -4.0);
  CHECK(value_of("(-2)^2") == 4.0);
  CHECK(value_of("2^-1") == 0.5);
  CHECK(value_of("2*-3") == -6.0);
  CHECK(value_of("--2") == 2.0);
  CHECK(value_of("-x^2", 3.0) == -9.0);
  CHECK(value_of("2*x^2", 3.0) == 18.0);
}

TEST_CASE("an expression reads numbers, pi, names, blanks and lines") {
  CHECK(value_of("1.5e-3") == 1.5e-3);
  CHECK(value_of(".5") == 0.5);
  CHECK(value_of("2.") == 2.0);
  CHECK(value_of("pi") == std::numbers::pi);
  CHECK(value_of("26.5104 + 0.4811*I") == 26.5104 + 0.4811 * 3.0);
  CHECK(value_of(" omega\n * I\t") == 6.0);
  CHECK(value_of("min(omega, I)") == 2.0);
  CHECK(value_of("max(omega, I)") == 3.0);
  CHECK(value_of("abs(-I)") == 3.0);
}

TEST_CASE("an expression knows what it reads") {
  const auto expression = Expression::parse("x*omega + x", names);
  CHECK(expression.reads() == std::vector<std::size_t>{0, 2});
  CHECK_FALSE(expression.is_constant());
  CHECK(Expression::parse("2*pi", names).is_constant());
  CHECK(Expression::parse("(I)", names).sole_parameter() == std::size_t{1});
  CHECK_FALSE(Expression::parse("-I", names).sole_parameter());
}

TEST_CASE("every function has its value and its exact derivative") {
  struct Case {
    std::string text;
    std::function<double(double)> value, derivative;
  };
  const std::vector<Case> cases{
      {"x", [](double x) { return x; }, [](double) { return 1.0; }},
      {"-x", [](double x) { return -x; }, [](double) { return -1.0; }},
      {"x + 2*x", [](double x) { return 3 * x; }, [](double) { return 3.0; }},
      {"1 - x", [](double x) { return 1 - x; }, [](double) { return -1.0; }},
      {"x*x", [](double x) { return x * x; }, [](double x) { return 2 * x; }},
      {"1/x", [](double x) { return 1 / x; }, [](double x) { return -1 / (x * x); }},
      {"x/(1 + x)", [](double x) { return x / (1 + x); }, [](double x) { return 1 / ((1 + x) * (1 + x)); }},
      {"x^3", [](double x) { return x * x * x; }, [](double x) { return 3 * x * x; }},
      {"I^x", [](double x) { return std::pow(3, x); },
       [](double x) { return std::pow(3, x) * std::log(3.0); }},
      {"x^x", [](double x) { return std::pow(x, x); },
       [](double x) { return std::pow(x, x) * (std::log(x) + 1); }},
      {"sqrt(x)", [](double x) { return std::sqrt(x); }, [](double x) { return 0.5 / std::sqrt(x); }},
      {"exp(x)", [](double x) { return std::exp(x); }, [](double x) { return std::exp(x); }},
      {"log(x)", [](double x) { return std::log(x); }, [](double x) { return 1 / x; }},
      {"sin(x)", [](double x) { return std::sin(x); }, [](double x) { return std::cos(x); }},
      {"cos(x)", [](double x) { return std::cos(x); }, [](double x) { return -std::sin(x); }},
      {"tan(x)", [](double x) { return std::tan(x); }, [](double x) { return 1 / std::pow(std::cos(x), 2); }},
      {"atan(x)", [](double x) { return std::atan(x); }, [](double x) { return 1 / (1 + x * x); }},
      {"abs(x)", [](double x) { return x; }, [](double) { return 1.0; }},
      {"abs(-x)", [](double x) { return x; }, [](double) { return 1.0; }},
      {"min(x, 100)", [](double x) { return x; }, [](double) { return 1.0; }},
      {"min(x, -100)", [](double) { return -100.0; }, [](double) { return 0.0; }},
      {"max(x, 100)", [](double) { return 100.0; }, [](double) { return 0.0; }},
      {"max(0, x)", [](double x) { return x; }, [](double) { return 1.0; }},
      {"exp(-x^2)*sin(2*x)", [](double x) { return std::exp(-x * x) * std::sin(2 * x); },
       [](double x) { return std::exp(-x * x) * (2 * std::cos(2 * x) - 2 * x * std::sin(2 * x)); }},
  };
  for (const Case& c : cases) {
    for (const double x : {0.3, 1.0, 2.7}) {
      INFO(c.text << " at " << x);
      CHECK_THAT(value_of(c.text, x), Catch::WithinRel(c.value(x), rounding));
      const double expected = c.derivative(x);
      CHECK_THAT(derivative_of(c.text, x),
                 Catch::WithinAbs(expected, 10 * rounding * (1 + std::abs(expected))));
    }
  }
}

TEST_CASE("a derivative is finite where only the part that does not change is singular") {
  const std::vector<Dual> values{{0.0, 0.0}, {-3.0, 0.0}, {2.0, 1.0}};
  const auto at = [&](const char* text) {
    return Expression::parse(text, names).evaluate(std::span<const Dual>(values));
  };
  CHECK(at("sqrt(omega) + x").derivative == 1.0);
  CHECK(at("I^3*x").derivative == -27.0);
  CHECK(at("(x - 2)^2").derivative == 0.0);
  CHECK(at("(x - 5)^3").derivative == 27.0);
  CHECK(at("abs(x - 2)").derivative == 0.0);
}

TEST_CASE("minimum and maximum keep a value that does not exist") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const char* text : {"min(x, 1)", "min(1, x)", "max(x, 1)", "max(1, x)"}) {
    INFO(text);
    CHECK(std::isnan(value_of(text, nan)));
    CHECK(std::isnan(derivative_of(text, nan)) == false);  // the derivative of the NaN side, which is 1
  }
}

TEST_CASE("a wrong expression is told where and why") {
  check_complaint("", 1, "found the end");
  check_complaint("2*", 3, "found the end");
  check_complaint("2 * (x + 1", 5, "never closed");
  check_complaint("sqrt(x", 5, "never closed");
  check_complaint("x + 1)", 6, "never opened");
  check_complaint("omga + 1", 1, "no parameter is called \"omga\"; did you mean \"omega\"?");
  check_complaint("1 + q", 5, "known: omega, I, x");
  check_complaint("sinn(x)", 1, "no function is called \"sinn\"; did you mean \"sin\"?");
  check_complaint("2 + sin", 5, "sin is a function: write sin(...)");
  check_complaint("I(x + 1)", 1, "a product is written I*(...)");
  check_complaint("pi(2)", 1, "a product is written pi*(...)");
  check_complaint("2 x", 3, "an operator is missing before \"x\"");
  check_complaint("12.5 Hz", 6, "a unit { value = 2, unit = ");
  check_complaint("2(x)", 2, "an operator is missing before \"(\"");
  check_complaint("0,5*x", 2, "decimals have a point");
  check_complaint("x**2", 2, "written with ^");
  check_complaint("x & 1", 3, "\"&\" has no meaning");
  check_complaint("x = 1", 3, "\"=\" has no meaning");
  check_complaint("2*ζ", 3, "found \"ζ\"");
  check_complaint("min(x)", 1, "min takes 2 arguments, found 1");
  check_complaint("max(1, 2, 3)", 1, "max takes 2 arguments, found 3");
  check_complaint("sin(1, 2)", 1, "sin takes 1 argument, found 2");
  check_complaint("sin()", 5, "found \")\"");
  check_complaint("1 + 1/0", 6, "not a finite number");
  check_complaint("log(0 - 1)", 1, "not a finite number");
  check_complaint("1e400", 1, "out of the range");
  check_complaint(".", 1, "expected a number");
  check_complaint(std::string("1\0 + 2", 6), 2, "a control character");
}

TEST_CASE("an expression nested too deeply is refused, however it is nested") {
  const std::size_t depth = 100'000;
  CHECK_THAT(complaint_about(std::string(depth, '(')).message, Catch::Contains("too deeply"));
  CHECK_THAT(complaint_about(std::string(depth, '-') + "1").message, Catch::Contains("too deeply"));
  std::string powers = "x", sums;
  for (std::size_t i = 0; i < depth; ++i) powers += "^x";
  for (std::size_t i = 0; i < 60; ++i) sums += "x+(";
  CHECK_THAT(complaint_about(powers).message, Catch::Contains("too deeply"));
  CHECK_THAT(complaint_about(sums + "x" + std::string(60, ')')).message, Catch::Contains("too deeply"));
}

TEST_CASE("a long flat expression is as good as a short one") {
  std::string text = "x";
  for (int i = 0; i < 10'000; ++i) text += " + x";
  CHECK(value_of(text, 1.0) == 10'001.0);
}

}  // namespace
}  // namespace expression_test
