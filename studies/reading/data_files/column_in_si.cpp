#include "studies/reading/data_files/column_in_si.hpp"

#include <fmt/format.h>

#include "studies/reading/study/parameter_reading.hpp"
#include "studies/reading/study/study_context.hpp"

namespace frahm::studies {
namespace {

// `low.csv:1: column 2 "x [mm]"`
std::string unit_place(const RawRecord& raw, const RawColumn& column) {
  return raw.has_lines ? fmt::format("{}:{}: {}", raw.file, raw.header, column.called)
                       : fmt::format("{}: {}", raw.file, column.called);
}

std::optional<Unit> unit_of_file(const StudyContext& context, const NamedFile& file, const RawRecord& raw,
                                 const RawColumn& column) {
  if (!column.unit) return std::nullopt;
  const auto fail = [&](Rule rule, std::string_view problem) {
    throw data_error(rule, file.section, file.position,
                     fmt::format("{}: {}", unit_place(raw, column), problem));
  };
  if (context.dimensionless) {
    if (*column.unit != "1")
      fail(rules::unit_in_dimensionless,
           fmt::format("the unit \"{}\" has no meaning in a dimensionless study", *column.unit));
    return std::nullopt;
  }
  try {
    return context.units.parse(*column.unit);
  } catch (const UnitError& error) {
    fail(error.rule(), error.what());
  }
  return std::nullopt;
}

bool is_same(const Unit& a, const Unit& b) {
  return a.scale == b.scale && a.exponents == b.exponents && a.radians == b.radians && a.foreign == b.foreign;
}

// Factor of a column to SI.
double factor_of(const StudyContext& context, const NamedFile& file, const RawRecord& raw,
                 const RawColumn& column, const GivenUnit& given_unit) {
  const auto in_file = unit_of_file(context, file, raw, column);
  if (!given_unit.unit) {
    try {
      return in_file ? si_factor(*in_file, column.role->quantity) : 1.0;
    } catch (const UnitError& error) {
      throw data_error(error.rule(), file.section, file.position,
                       fmt::format("{}: {}", unit_place(raw, column), error.what()));
    }
  }
  const std::string& section = file.section.where();
  const bool is_key = given_unit.place.empty();
  const std::string where = fmt::format("{}: {}", section, is_key ? "unit" : given_unit.place);
  const auto given = read_unit(context, is_key ? section : where, *given_unit.unit);
  const auto fail = [&](Rule rule, std::string_view problem) {
    throw context.source.error_at(rule, given_unit.unit->position, "{}: {}", where, problem);
  };
  if (given && in_file && !is_same(*given, *in_file))
    fail(rules::two_units, fmt::format("\"{}\", but the file gives \"{}\" in {}", given->text, in_file->text,
                                       unit_place(raw, column)));
  try {
    return given ? si_factor(*given, column.role->quantity) : 1.0;
  } catch (const UnitError& error) {
    fail(error.rule(), error.what());
  }
  return 1.0;
}

void check_values(const NamedFile& file, const RawRecord& raw, const RawColumn& column) {
  const auto& values = column.values;
  const auto fail = [&](Rule rule, std::size_t row, const std::string& problem) {
    throw data_error(rule, file.section, file.position,
                     fmt::format("{}: {}", raw.where(column, row), problem));
  };
  const Range range = column.role->range;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (range == Range::positive && !(values[i] > 0.0))
      fail(rules::wrong_row, i, fmt::format("{} must be > 0", values[i]));
    if (range == Range::not_negative && values[i] < 0.0)
      fail(rules::wrong_row, i, fmt::format("{} must be >= 0", values[i]));
    if (column.role->increases && i > 0 && values[i] <= values[i - 1])
      fail(rules::wrong_order, i,
           fmt::format("{} follows {}; {} must increase from row to row", values[i], values[i - 1],
                       column.role->name));
  }
}

}  // namespace

std::vector<double> in_si(const StudyContext& context, const NamedFile& file, const RawRecord& raw,
                          const RawColumn& column, const GivenUnit& given) {
  check_values(file, raw, column);
  const double factor = factor_of(context, file, raw, column, given);
  std::vector<double> values = column.values;
  for (double& value : values) value *= factor;
  return values;
}

}  // namespace frahm::studies
