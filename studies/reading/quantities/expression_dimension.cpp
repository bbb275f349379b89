#include "studies/reading/quantities/expression_dimension.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "studies/reading/quantities/units.hpp"

namespace frahm::studies {
namespace {

constexpr Exponents pure_number{0.0, 0.0, 0.0};

// Whether all numbers in a text are multiples of a half.
bool has_whole_numbers(std::string_view text) {
  const auto is_part_of_name = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; };
  const auto begins_number = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) || c == '.'; };
  for (const char* at = text.data(); at != text.data() + text.size();) {
    if (is_part_of_name(*at) || !begins_number(*at)) {
      ++at;
      continue;
    }
    double number = 0.0;
    at = std::from_chars(at, text.data() + text.size(), number).ptr;
    if (std::remainder(number, 0.5) != 0.0) return false;
  }
  return true;
}

}  // namespace

// The expression's program, run on dimensions.
class DimensionWalk {
 public:
  DimensionWalk(const Expression& expression, std::span<const ExpressionDimension> of_parameters,
                PlainFactor plain)
      : expression_(expression), of_parameters_(of_parameters), plain_(plain) {}

  ExpressionDimension result() {
    if (expression_.text_.empty()) return {};
    for (std::size_t i = 0; i < expression_.program_.size(); ++i)
      step(expression_.program_[i], expression_.places_[i]);
    return stack_.back().takes_any ? ExpressionDimension{} : stack_.back().dimension;
  }

 private:
  using Operation = Expression::Operation;
  using Place = Expression::Place;

  struct Operand {
    ExpressionDimension dimension;
    bool takes_any = false;        // a pure number with a number as factor, which may have a unit
    std::optional<double> number;  // of a constant
    Place place;
  };

  std::string_view text(const Operand& operand) const {
    const Place& place = operand.place;
    return std::string_view(expression_.text_).substr(place.first, place.end - place.first);
  }

  std::string statement(const Operand& operand) const {
    return fmt::format("\"{}\" is {}", text(operand), described(*operand.dimension));
  }

  [[noreturn]] static void fail(const Operand& at, const std::string& message) {
    throw ExpressionError(rules::wrong_dimension, message, at.place.first + 1);
  }

  void step(const Expression::Instruction& instruction, const Place& place) {
    switch (instruction.operation) {
      case Operation::constant:
        return push(constant(instruction.constant, place));
      case Operation::parameter:
        return push(parameter(of_parameters_[instruction.parameter], place));
      case Operation::negate:
      case Operation::abs:
        stack_.back().place = place;
        return;
      case Operation::sqrt:
        return push(to_power(pop(), 0.5, place));
      case Operation::exp:
      case Operation::log:
      case Operation::sin:
      case Operation::cos:
      case Operation::tan:
      case Operation::atan:
        return push(of_pure_number(pop(), place));
      default:
        break;
    }
    const Operand right = pop(), left = pop();
    switch (instruction.operation) {
      case Operation::multiply:
        return push(product(left, right, 1.0, place));
      case Operation::divide:
        return push(product(left, right, -1.0, place));
      case Operation::power:
        return push(power(left, right, place));
      default:
        return push(sum(left, right, instruction.operation, place));
    }
  }

  void push(const Operand& operand) { stack_.push_back(operand); }

  Operand pop() {
    Operand top = stack_.back();
    stack_.pop_back();
    return top;
  }

  Operand parameter(const ExpressionDimension& dimension, const Place& place) const {
    if (!dimension && plain_ == PlainFactor::pure_number) return {pure_number, true, {}, place};
    return {dimension, false, {}, place};
  }

  Operand constant(double value, const Place& place) const {
    Operand operand{pure_number, true, value, place};
    if (plain_ == PlainFactor::any_dimension && !has_whole_numbers(text(operand))) operand.dimension.reset();
    return operand;
  }

  Operand sum(const Operand& left, const Operand& right, Operation operation, const Place& place) const {
    if (left.takes_any && right.takes_any)
      return {left.dimension && right.dimension ? left.dimension : ExpressionDimension{}, true, {}, place};
    if (left.takes_any || !left.dimension) return {right.dimension, false, {}, place};
    if (right.takes_any || !right.dimension) return {left.dimension, false, {}, place};
    if (!same(*left.dimension, *right.dimension)) {
      const bool compared = operation == Operation::minimum || operation == Operation::maximum;
      fail(right, fmt::format("{}, but {}; they cannot be {}", statement(left), statement(right),
                              compared                           ? "compared"
                              : operation == Operation::subtract ? "subtracted"
                                                                 : "added"));
    }
    return {left.dimension, false, {}, place};
  }

  static Operand product(const Operand& left, const Operand& right, double sign, const Place& place) {
    if (!left.dimension || !right.dimension) return {{}, false, {}, place};
    Exponents exponents = *left.dimension;
    for (std::size_t i = 0; i < exponents.size(); ++i) exponents[i] += sign * (*right.dimension)[i];
    return {exponents, (left.takes_any || right.takes_any) && same(exponents, pure_number), {}, place};
  }

  static Operand to_power(const Operand& base, double exponent, const Place& place) {
    Operand result{base.dimension, base.takes_any, {}, place};
    if (result.dimension) {
      for (double& each : *result.dimension) each *= exponent;
    }
    return result;
  }

  Operand power(const Operand& base, const Operand& exponent, const Place& place) const {
    if (exponent.dimension && !same(*exponent.dimension, pure_number))
      fail(exponent, statement(exponent) + ", but an exponent is a pure number");
    if (exponent.number) return to_power(base, *exponent.number, place);
    if (base.dimension && same(*base.dimension, pure_number)) return {pure_number, base.takes_any, {}, place};
    return {{}, false, {}, place};
  }

  Operand of_pure_number(const Operand& argument, const Place& place) const {
    if (argument.dimension && !same(*argument.dimension, pure_number))
      fail(argument, fmt::format("{}, but {} takes a pure number", statement(argument), function_at(place)));
    return {pure_number, false, {}, place};
  }

  std::string_view function_at(const Place& place) const {
    const std::string_view call = std::string_view(expression_.text_).substr(place.first);
    return call.substr(0, call.find_first_of(" ("));
  }

  const Expression& expression_;
  std::span<const ExpressionDimension> of_parameters_;
  PlainFactor plain_;
  std::vector<Operand> stack_;
};

ExpressionDimension dimension_of(const Expression& expression,
                                 std::span<const ExpressionDimension> of_parameters, PlainFactor plain) {
  return DimensionWalk(expression, of_parameters, plain).result();
}

Exponents exponents_of(const Unit& unit) {
  return {static_cast<double>(unit.exponents[0]), static_cast<double>(unit.exponents[1]),
          static_cast<double>(unit.exponents[2])};
}

bool same(const Exponents& a, const Exponents& b) {
  constexpr double rounding_of_exponents = 1e-9;  // exponents are fractions with small denominators
  return std::ranges::equal(a, b, [](double x, double y) { return std::abs(x - y) < rounding_of_exponents; });
}

std::string described(const Exponents& exponents) {
  constexpr std::array<std::string_view, 3> symbols{"m", "kg", "s"};
  Unit unit;
  std::string powers;
  bool is_whole = true;
  for (std::size_t i = 0; i < exponents.size(); ++i) {
    unit.exponents[i] = static_cast<int>(std::lround(exponents[i]));
    is_whole = is_whole && std::abs(exponents[i] - unit.exponents[i]) < 1e-9;
    if (exponents[i] != 0.0) powers += fmt::format(" {}^{:.4g}", symbols[i], exponents[i]);
  }
  return is_whole ? dimension_with_unit(unit) : "a quantity in" + powers;
}

}  // namespace frahm::studies
