#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/quantities/units.hpp"
#include "studies/reading/study/named_parameter.hpp"
#include "studies/reading/study/study.hpp"
#include "studies/reading/study/study_context.hpp"
#include "studies/reading/study/study_values.hpp"
#include "studies/reading/text/toml_reading.hpp"

// Shared by the readers of [tune] and its tables.
namespace frahm::studies {

// The tuning while it is read.
struct TuneReading {
  const StudyContext& context;
  const TomlValue& root;
  Study& study;
  TuneChoice choice = {};
};

// A real-valued quantity of the network, by its name at a key.
periodic::Quantity read_real_quantity(const TuneReading& reading, const TomlSection& section,
                                      const std::string& key);

// Unit of a quantity's limits: that of the key "unit", otherwise the quantity's own, which is SI.
UsualUnit read_quantity_unit(const TuneReading& reading, const TomlSection& section,
                             const periodic::Quantity& quantity);

// An array of numbers, at least one.
std::vector<double> read_numbers(const TomlSection& section, const std::string& key);

// A range from <= to in the given unit, converted to SI.
tuning::Band read_range(const TomlSection& section, double si_factor);

// An expression of the parameters in quotes, with the dimension that it has to have.
StudyValue read_formula(const TuneReading& reading, const TomlSection& section, const std::string& key,
                        std::optional<WantedDimension> wanted = std::nullopt);

// [tune], [[design]], [[constraint]], [[scenario]] and [[column]] into the study's choice, once units are
// converted.
void read_tuning(const StudyContext& context, const TomlValue& root, Study& study);

}  // namespace frahm::studies
