#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "studies/reading/text/study_source.hpp"

namespace frahm::studies {

// How an element of a study bends (solvers/laws/bend.hpp): at stops, or at the points of a table; or the
// curve of its friction, which is smooth. Its values are in StudyValues::points: of stops a clearance each;
// of a table or a curve the place and the force of each point, by turns. A table bends at all points but the
// first and the last, as its ends go on with their slope.
struct StudyCharacteristic {
  enum class Kind { none, stops, table, curve };
  Kind kind = Kind::none;
  bool of_velocity = false;          // a table of forces over velocities
  std::size_t first = 0, count = 0;  // of its values
  std::vector<double> sides{};       // of each bend: +1 right of the origin, -1 left of it or at it
  std::string where;                 // for messages: `element "stop": clearance`
  Position position;                 // of that key

  bool bends() const { return kind == Kind::stops || kind == Kind::table; }
};

// The numbers of a table at one point of a map. Number: double, or one with a derivative.
template <class Number>
class TableOfForces {
 public:
  // values: the place and the force of each point, by turns.  sides: of its bends.
  TableOfForces(std::span<const Number> values, std::span<const double> sides)
      : values_(values), sides_(sides) {}

  std::size_t points() const { return values_.size() / 2; }
  const Number& place(std::size_t point) const { return values_[2 * point]; }
  const Number& force(std::size_t point) const { return values_[2 * point + 1]; }

  // Between a point and the next one.
  Number slope(std::size_t point) const {
    return (force(point + 1) - force(point)) / (place(point + 1) - place(point));
  }
  // The point before the piece through the origin.
  std::size_t central() const {
    std::size_t left = 0;
    while (left < sides_.size() && sides_[left] < 0.0) ++left;
    return left;
  }
  // N_i + slope (0 - u_i), i = central()
  Number force_at_origin() const {
    const std::size_t i = central();
    return force(i) - slope(i) * place(i);
  }
  // Along the side of bend b: its place, and by how much the slope changes there.
  Number bend_place(std::size_t b) const { return sides_[b] > 0.0 ? place(b + 1) : -place(b + 1); }
  Number bend_change(std::size_t b) const {
    return sides_[b] > 0.0 ? slope(b + 1) - slope(b) : slope(b) - slope(b + 1);
  }

 private:
  std::span<const Number> values_;
  std::span<const double> sides_;
};

}  // namespace frahm::studies
