#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "studies/reading/quantities/expression.hpp"
#include "studies/reading/quantities/parameters.hpp"
#include "studies/reading/quantities/units.hpp"
#include "studies/reading/study/study_context.hpp"
#include "studies/reading/text/study_source.hpp"
#include "studies/reading/text/toml_reading.hpp"

// [parameters], and numbers with units and expressions wherever they stand.
namespace frahm::studies {

// [parameters]. Numbers stay in their own units until convert_parameters(), because the network determines
// their quantities. folder: of the tables.
Parameters read_parameters(const StudyContext& context, const TomlValue& root,
                           const std::filesystem::path& folder);
void convert_parameters(const StudyContext& context, Parameters& parameters);

// A number in the unit given beside it, as { value, unit } or as a bare number (no unit then).
struct NumberWithUnit {
  double value = 0.0;
  std::optional<Unit> unit;  // none in a dimensionless study
  Position unit_position;
};
NumberWithUnit read_number_with_unit(const StudyContext& context, const std::string& where,
                                     const TomlValue& value);

// The unit of a key; none in a dimensionless study, where only "1" is allowed.
std::optional<Unit> read_unit(const StudyContext& context, const std::string& where, const TomlValue& value);

// An expression of the parameters. It is noted in the context with the dimension that it has to have.
Expression read_expression(const StudyContext& context, const Parameters& parameters,
                           const std::string& where, const TomlValue& value,
                           std::optional<WantedDimension> wanted = std::nullopt);

}  // namespace frahm::studies
