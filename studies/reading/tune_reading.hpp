#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studies/reading/study_reading.hpp"

// Shared by the readers of [tune] and its tables.
namespace frahm::studies {

// The tuning while it is read.
struct TuneReading {
  const StudyContext& context;
  const TomlValue& root;
  Study& study;
  TuneChoice choice = {};
};

// The keys "start" and "global", and "tolerance".
void read_start(const TomlSection& section, TuneChoice& choice);
void read_tolerance(const TomlSection& section, TuneChoice& choice);

// The key "solver" of a tuning over a band, and whether its start suits it, once its designs are known.
tuning::SolverKind read_solver(const TomlSection& section, const TuneChoice& choice);
void check_map(const TuneReading& reading, const TomlSection& section);

// A real-valued quantity of the network, by its name at a key.
periodic::Quantity read_real_quantity(const TuneReading& reading, const TomlSection& section,
                                      const std::string& key);

// Unit of a quantity's limits: that of the key "unit", otherwise the quantity's own, which is SI.
UsualUnit read_quantity_unit(const TuneReading& reading, const TomlSection& section,
                             const periodic::Quantity& quantity);

// Unit of a parameter's numbers: that of the key "unit", which is noted with the parameter, otherwise the
// usual one.
UsualUnit read_parameter_unit(const TuneReading& reading, const TomlSection& section, std::size_t parameter);

// A parameter that is a number, by its name at a key. role: "a design parameter", for messages.
std::size_t read_number_parameter(const TuneReading& reading, const TomlSection& section,
                                  const std::string& key, const char* role);

// An array of numbers, at least one.
std::vector<double> read_numbers(const TomlSection& section, const std::string& key);

// A range from <= to in the given unit, converted to SI.
tuning::Band read_range(const TomlSection& section, double si_factor);

// An expression of the parameters in quotes, with the dimension that it has to have.
StudyValue read_formula(const TuneReading& reading, const TomlSection& section, const std::string& key,
                        std::optional<WantedDimension> wanted = std::nullopt);

// Whether the numbers of the network depend on a parameter.
bool network_depends_on(const Study& study, std::size_t parameter);

// The tables of a tuning, in this order, once its band is known.
void read_designs(TuneReading& reading);
void read_limits(TuneReading& reading);
void read_scenarios(TuneReading& reading);
void read_columns(TuneReading& reading);

// The samples of an [[axis]], each a scenario; after the designs and the scenarios.
void read_samples(TuneReading& reading, const std::filesystem::path& folder, DataFiles data);
// Refuses them.
void refuse_samples(const TuneReading& reading);
// Nor has it a quantile.
void refuse_quantile(const TomlSection& section);

}  // namespace frahm::studies
