#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/quantities/units.hpp"
#include "studies/reading/study/named_parameter.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_context.hpp"
#include "studies/reading/text/toml_reading.hpp"

// The parts of an [[axis]], whichever way its values are given.
namespace frahm::studies {

// Why a parameter of this name cannot run along an axis: there is none, it is computed, or it has an axis.
std::optional<Refusal> why_no_axis(const Study& study, const std::string& name);

// The parameter that the key `parameter` names.
std::size_t read_axis_parameter(const TomlSection& section, const Study& study);

// The key `unit`, of the values of a parameter.
void read_axis_unit(const StudyContext& context, const TomlSection& section, Parameter& parameter,
                    ParameterAxis& axis);

// The unit of an axis's values, nothing for none: SI. Throws UnitError for a unit of another dimension, and
// for none where the parameter is given in a unit that is not SI, which is easily overlooked.
void set_axis_unit(const std::optional<Unit>& unit, Parameter& parameter, ParameterAxis& axis);

// The values in SI.
void convert_axis(const TomlSection& section, ParameterAxis& axis);

// Adds an axis of the study, by its index, to the dimension of its zip, or as a new dimension.
void add_to_grid(const TomlSection& section, std::size_t axis, Study& study);

// [[axis]] and [[coordinate]] into the map of a study. folder: of the axes' files.
// data: where earlier results are left, samples of their estimates all stand at the values of the study.
void read_axes(const StudyContext& context, const TomlValue& root, const std::filesystem::path& folder,
               DataFiles data, Study& study);
void read_coordinates(const StudyContext& context, const TomlValue& root, Study& study);

}  // namespace frahm::studies
