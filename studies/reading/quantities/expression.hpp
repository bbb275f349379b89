#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "studies/reading/quantities/dual.hpp"
#include "studies/reading/text/rules.hpp"

namespace frahm::studies {

// The text is not an expression. column: of the offending character, from 1.
class ExpressionError : public std::runtime_error {
 public:
  ExpressionError(Rule rule, const std::string& message, std::size_t column)
      : std::runtime_error(message), rule_(rule), column_(column) {}
  Rule rule() const { return rule_; }
  std::size_t column() const { return column_; }

 private:
  Rule rule_;
  std::size_t column_;
};

// A formula of named parameters, such as 26.5104 + 0.4811*I: + - * / ^ ( ), pi, the functions sqrt exp log
// sin cos tan atan abs, and min, max of two arguments. As in mathematics -2^2 = -4 and 2^3^2 = 2^9.
//
// It is compiled once into a short program for a stack machine, with constants folded, and evaluated without
// allocation, on doubles or, for exact derivatives, on duals.
class Expression {
 public:
  explicit Expression(double constant);

  // names: of the parameters, in the order of the values given to evaluate(). Throws ExpressionError for a
  // text that is not an expression of these names, or whose constant part is not a finite number (1/0).
  static Expression parse(std::string_view text, std::span<const std::string> names);

  // parameters: SI values, one for each of the names given to parse().
  template <class Number>
  Number evaluate(std::span<const Number> parameters) const;

  // Both of the same names.
  friend Expression operator+(const Expression& a, const Expression& b) {
    return joined(a, b, Operation::add);
  }
  friend Expression operator*(const Expression& a, const Expression& b) {
    return joined(a, b, Operation::multiply);
  }
  friend Expression operator/(const Expression& a, const Expression& b) {
    return joined(a, b, Operation::divide);
  }

  bool is_constant() const { return reads_.empty(); }

  // Indices of the parameters read, ascending.
  const std::vector<std::size_t>& reads() const { return reads_; }

  // The parameter, if the expression is a parameter's name and nothing else.
  std::optional<std::size_t> sole_parameter() const;

  // The computed operations in postfix form: equal for all spellings that compute the same. names: those
  // given to parse().
  std::string canonical_text(std::span<const std::string> names) const;

  // Reserved names, which no parameter may have: pi and the functions.
  static const std::vector<std::string>& reserved_names();

 private:
  friend class ExpressionParser;
  friend class DimensionWalk;

  enum class Operation : std::uint8_t {
    constant,
    parameter,
    negate,
    add,
    subtract,
    multiply,
    divide,
    power,
    sqrt,
    exp,
    log,
    sin,
    cos,
    tan,
    atan,
    abs,
    minimum,
    maximum,
  };
  struct Instruction {
    Operation operation;
    std::uint32_t parameter;  // index, of Operation::parameter
    double constant;          // value, of Operation::constant
  };
  struct Place {
    std::size_t first = 0, end = 0;  // bytes of the text, from 0; `end` is after the last
  };
  static constexpr std::size_t most_operands = 32;  // that wait for an operation: the parser refuses more
  static constexpr std::size_t stack_size = most_operands + 2;  // with those of which two are joined

  Expression() = default;
  static Expression joined(const Expression& a, const Expression& b, Operation operation);

  template <class Number>
  static Number constant(double value);
  template <class Number>
  static Number apply(Operation operation, const Number& a);
  template <class Number>
  static Number apply(Operation operation, const Number& a, const Number& b);

  std::vector<Instruction> program_;
  std::vector<std::size_t> reads_;
  std::string text_;           // as parsed; empty of a constant and of joined expressions
  std::vector<Place> places_;  // of each instruction: the part of the text that it completes
};

template <>
inline double Expression::constant<double>(double value) {
  return value;
}

template <>
inline Dual Expression::constant<Dual>(double value) {
  return {value, 0.0};
}

template <class Number>
Number Expression::apply(Operation operation, const Number& a) {
  using std::abs, std::atan, std::cos, std::exp, std::log, std::sin, std::sqrt, std::tan;
  switch (operation) {
    case Operation::negate:
      return -a;
    case Operation::sqrt:
      return sqrt(a);
    case Operation::exp:
      return exp(a);
    case Operation::log:
      return log(a);
    case Operation::sin:
      return sin(a);
    case Operation::cos:
      return cos(a);
    case Operation::tan:
      return tan(a);
    case Operation::atan:
      return atan(a);
    default:
      return abs(a);
  }
}

template <class Number>
Number Expression::apply(Operation operation, const Number& a, const Number& b) {
  using std::pow;
  switch (operation) {
    case Operation::add:
      return a + b;
    case Operation::subtract:
      return a - b;
    case Operation::multiply:
      return a * b;
    case Operation::divide:
      return a / b;
    case Operation::power:
      return pow(a, b);
    case Operation::minimum:
      return minimum(a, b);
    default:
      return maximum(a, b);
  }
}

template <class Number>
Number Expression::evaluate(std::span<const Number> parameters) const {
  // Left uninitialised: every entry is written before it is read.
  std::array<Number, stack_size> stack;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  std::size_t size = 0;
  for (const Instruction& step : program_) {
    switch (step.operation) {
      case Operation::constant:
        stack[size++] = constant<Number>(step.constant);
        break;
      case Operation::parameter:
        stack[size++] = parameters[step.parameter];
        break;
      case Operation::add:
      case Operation::subtract:
      case Operation::multiply:
      case Operation::divide:
      case Operation::power:
      case Operation::minimum:
      case Operation::maximum:
        --size;
        stack[size - 1] = apply(step.operation, stack[size - 1], stack[size]);
        break;
      default:
        stack[size - 1] = apply(step.operation, stack[size - 1]);
        break;
    }
  }
  return stack[0];
}

}  // namespace frahm::studies
