#include "studies/reading/quantities/expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <numbers>
#include <system_error>

#include "studies/reading/text/spelling.hpp"

namespace frahm::studies {
namespace {

constexpr std::size_t deepest_nesting = 100;  // of parentheses, signs and powers: bounds the recursion

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

}  // namespace

// Recursive descent; each rule leaves the program that computes what it has read:
//   sum     = product { (+|-) product }
//   product = signed { (*|/) signed }
//   signed  = - signed | power
//   power   = operand [ ^ signed ]
//   operand = number | name | function ( sum [, sum] ) | ( sum )
class ExpressionParser {
 public:
  ExpressionParser(std::string_view text, std::span<const std::string> names) : text_(text), names_(names) {
    result_.text_ = text;
  }

  Expression parse() {
    sum();
    peek();
    if (at_ < text_.size()) fail_at_end_of_sum();
    finish();
    return std::move(result_);
  }

 private:
  using Operation = Expression::Operation;
  using Place = Expression::Place;

  struct Function {
    std::string_view name;
    Operation operation;
    int arguments;
  };
  static constexpr std::array<Function, 10> functions_{{{"sqrt", Operation::sqrt, 1},
                                                        {"exp", Operation::exp, 1},
                                                        {"log", Operation::log, 1},
                                                        {"sin", Operation::sin, 1},
                                                        {"cos", Operation::cos, 1},
                                                        {"tan", Operation::tan, 1},
                                                        {"atan", Operation::atan, 1},
                                                        {"abs", Operation::abs, 1},
                                                        {"min", Operation::minimum, 2},
                                                        {"max", Operation::maximum, 2}}};
  friend class Expression;

  [[noreturn]] static void fail(Rule rule, std::size_t at, const std::string& message) {
    throw ExpressionError(rule, message, at + 1);
  }

  char peek() {
    while (at_ < text_.size() && is_space(text_[at_])) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }

  void sum() {
    product();
    for (char c = peek(); c == '+' || c == '-'; c = peek()) {
      const std::size_t where = at_++;
      product();
      binary(c == '+' ? Operation::add : Operation::subtract, where);
    }
  }

  void product() {
    signed_operand();
    for (char c = peek(); c == '*' || c == '/'; c = peek()) {
      const std::size_t where = at_++;
      if (c == '*' && peek() == '*')
        fail(rules::wrong_expression, where, "a power is written with ^, not **");
      signed_operand();
      binary(c == '*' ? Operation::multiply : Operation::divide, where);
    }
  }

  void signed_operand() {
    if (++depth_ > deepest_nesting) fail(rules::wrong_expression, at_, "nested too deeply");
    if (peek() == '-') {
      const std::size_t where = at_++;
      signed_operand();
      unary(Operation::negate, where, {where, operands_.back().end});
    } else {
      power();
    }
    --depth_;
  }

  void power() {
    operand();
    if (peek() != '^') return;
    const std::size_t where = at_++;
    signed_operand();
    binary(Operation::power, where);
  }

  void operand() {
    const char c = peek();
    if (is_digit(c) || c == '.') return number();
    if (is_letter(c)) return name();
    if (c != '(')
      fail(rules::wrong_expression, at_, fmt::format("expected a number, a name or (, found {}", found()));
    const std::size_t open = at_++;
    sum();
    close(open);
    result_.places_.back() = operands_.back() = {open, at_};
  }

  void number() {
    double value = 0.0;
    const char* first = text_.data() + at_;
    const auto [end, error] = std::from_chars(first, text_.data() + text_.size(), value);
    if (error == std::errc::result_out_of_range)
      fail(rules::wrong_expression, at_, "this number is out of the range of double precision");
    if (error != std::errc{})
      fail(rules::wrong_expression, at_, fmt::format("expected a number, found {}", found()));
    const std::size_t where = at_;
    at_ += static_cast<std::size_t>(end - first);
    push({Operation::constant, 0, value}, {where, at_});
  }

  void name() {
    const std::size_t where = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]))) ++at_;
    const Place place{where, at_};
    const std::string_view word = text_.substr(where, at_ - where);
    const bool called = peek() == '(';
    const auto function =
        std::find_if(functions_.begin(), functions_.end(), [&](auto& f) { return f.name == word; });
    if (function != functions_.end()) {
      if (!called)
        fail(rules::wrong_expression, where, fmt::format("{0} is a function: write {0}(...)", word));
      return call(*function, where);
    }
    if (called) fail_unknown_function(word, where);
    if (word == "pi") return push({Operation::constant, 0, std::numbers::pi}, place);
    const auto parameter = place_among(names_, word);
    if (!parameter) fail(rules::unknown_name, where, none_called("parameter", word, names_));
    const auto index = static_cast<std::uint32_t>(*parameter);
    result_.reads_.push_back(index);
    push({Operation::parameter, index, 0.0}, place);
  }

  void call(const Function& function, std::size_t where) {
    const std::size_t open = at_++;
    int arguments = 1;
    for (sum(); peek() == ','; sum()) {
      ++at_;
      ++arguments;
    }
    if (arguments != function.arguments) {
      fail(rules::wrong_expression, where,
           fmt::format("{} takes {} argument{}, found {}", function.name, function.arguments,
                       function.arguments == 1 ? "" : "s", arguments));
    }
    close(open);
    if (function.arguments == 1) {
      unary(function.operation, where, {where, at_});
    } else {
      binary(function.operation, where);
      result_.places_.back() = operands_.back() = {where, at_};
    }
  }

  void close(std::size_t open) {
    if (peek() == '\0') fail(rules::wrong_expression, open, "this parenthesis is never closed");
    if (peek() != ')') fail_at_end_of_sum();
    ++at_;
  }

  // The character where an operator or the end was expected.
  [[noreturn]] void fail_at_end_of_sum() {
    const char c = peek();
    if (c == ')') fail(rules::wrong_expression, at_, "this parenthesis was never opened");
    if (c == ',')
      fail(rules::wrong_expression, at_,
           "a comma only separates the arguments of min and max (decimals have a point)");
    if (is_letter(c) || is_digit(c) || c == '(' || c == '.') {
      fail(rules::wrong_expression, at_,
           fmt::format("an operator is missing before {} (a product is written 2*k; "
                       "a unit {{ value = 2, unit = \"N/m\" }})",
                       found()));
    }
    fail(rules::wrong_expression, at_,
         fmt::format("{} has no meaning in an expression; use only + - * / ^ ( ), numbers and names",
                     found()));
  }

  [[noreturn]] void fail_unknown_function(std::string_view word, std::size_t where) const {
    if (word == "pi" || std::find(names_.begin(), names_.end(), word) != names_.end()) {
      fail(rules::wrong_expression, where,
           fmt::format("\"{0}\" is not a function; a product is written {0}*(...)", word));
    }
    std::vector<std::string> known;
    for (const Function& function : functions_) known.emplace_back(function.name);
    fail(rules::unknown_name, where, none_called("function", word, known));
  }

  // The word or character at the cursor, in quotes; a character of several bytes whole.
  std::string found() {
    if (peek() == '\0') return at_ < text_.size() ? "a control character" : "the end";
    std::size_t end = at_ + 1;
    if (is_letter(text_[at_]) || is_digit(text_[at_])) {
      while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]))) ++end;
    } else {
      while (end < text_.size() && (static_cast<unsigned char>(text_[end]) & 0xC0U) == 0x80U) ++end;
    }
    return fmt::format("\"{}\"", text_.substr(at_, end - at_));
  }

  // Emission. An operation on constants alone is done now: its operands are the last instructions.
  void emit(Expression::Instruction instruction, Place place) {
    result_.program_.push_back(instruction);
    result_.places_.push_back(place);
  }

  void push(Expression::Instruction instruction, Place place) {
    operands_.push_back(place);
    if (operands_.size() > Expression::most_operands)
      fail(rules::wrong_expression, place.first, "nested too deeply");
    emit(instruction, place);
  }

  void unary(Operation operation, std::size_t where, Place place) {
    operands_.back() = place;
    auto& last = result_.program_.back();
    if (last.operation != Operation::constant) return emit({operation, 0, 0.0}, place);
    last.constant = finite(Expression::apply(operation, last.constant), where);
    result_.places_.back() = place;
  }

  void binary(Operation operation, std::size_t where) {
    auto& program = result_.program_;
    const Place place{operands_[operands_.size() - 2].first, operands_.back().end};
    operands_.pop_back();
    operands_.back() = place;
    const auto& left = program[program.size() - 2];
    const auto& right = program.back();
    if (left.operation != Operation::constant || right.operation != Operation::constant)
      return emit({operation, 0, 0.0}, place);
    const double value = finite(Expression::apply(operation, left.constant, right.constant), where);
    program.pop_back();
    result_.places_.pop_back();
    program.back().constant = value;
    result_.places_.back() = place;
  }

  static double finite(double value, std::size_t where) {
    if (!std::isfinite(value))
      fail(rules::wrong_expression, where, "the result of this operation is not a finite number");
    return value;
  }

  void finish() {
    auto& reads = result_.reads_;
    std::sort(reads.begin(), reads.end());
    reads.erase(std::unique(reads.begin(), reads.end()), reads.end());
  }

  std::string_view text_;
  std::span<const std::string> names_;
  std::size_t at_ = 0;
  std::size_t depth_ = 0;
  std::vector<Place> operands_;  // those that wait for an operation
  Expression result_;
};

Expression::Expression(double value) : program_{{Operation::constant, 0, value}} {}

Expression Expression::parse(std::string_view text, std::span<const std::string> names) {
  return ExpressionParser(text, names).parse();
}

Expression Expression::joined(const Expression& a, const Expression& b, Operation operation) {
  Expression result = a;
  result.program_.insert(result.program_.end(), b.program_.begin(), b.program_.end());
  result.program_.push_back({operation, 0, 0.0});
  result.text_.clear();
  result.places_.clear();
  result.reads_.clear();
  std::ranges::set_union(a.reads_, b.reads_, std::back_inserter(result.reads_));
  if (!result.is_constant()) return result;
  return Expression(result.evaluate(std::span<const double>()));
}

std::optional<std::size_t> Expression::sole_parameter() const {
  if (program_.size() != 1 || program_[0].operation != Operation::parameter) return std::nullopt;
  return program_[0].parameter;
}

std::string Expression::canonical_text(std::span<const std::string> names) const {
  std::string text;
  for (const Instruction& step : program_) {
    if (!text.empty()) text += ' ';
    if (step.operation == Operation::constant) {
      text += fmt::format("{}", step.constant);
    } else if (step.operation == Operation::parameter) {
      text += names[step.parameter];
    } else {
      text += fmt::format("#{}", static_cast<int>(step.operation));
    }
  }
  return text;
}

const std::vector<std::string>& Expression::reserved_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all{"pi"};
    for (const auto& function : ExpressionParser::functions_) all.emplace_back(function.name);
    return all;
  }();
  return names;
}

}  // namespace frahm::studies
