#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "studies/reading/expression_dimension.hpp"
#include "studies/reading/study.hpp"
#include "studies/reading/toml_section.hpp"
#include "studies/reading/units.hpp"

// The parts of reading a study, in the order in which parse_study() calls them. Each throws StudyError.
namespace frahm::studies {

// The dimension that the value of an expression has to have: that of a unit, and a sentence that says so.
struct WantedDimension {
  Unit unit;
  std::string sentence;  // "a stiffness (N/m) is expected"
};
WantedDimension wanted_by_key(Quantity quantity);
WantedDimension wanted_by_label(const Unit& unit);

// An expression of the study outside [parameters].
struct WrittenExpression {
  Expression expression;
  std::string where;
  Position position;
  std::optional<WantedDimension> wanted;  // nothing: any dimension will do
};

// Shared by all parts: the text, the unit system, whether units are allowed at all, and the expressions read
// so far.
struct StudyContext {
  const StudySource& source;
  const UnitSystem& units;
  bool dimensionless = false;
  std::vector<WrittenExpression>& written;
};

// [parameters]. Numbers stay in their own units until convert_parameters(), because the network determines
// their quantities. folder: of the tables.
Parameters read_parameters(const StudyContext& context, const TomlValue& root,
                           const std::filesystem::path& folder);
void convert_parameters(const StudyContext& context, Parameters& parameters);

struct NetworkOfStudy {
  mechanics::Network network;
  StudyValues values;
};

// [[mass]], [[matrices]], [[element]], [damping] and, if the kind of study has one, [excitation]. Sets the
// quantities of `parameters`. folder: of the matrices.
NetworkOfStudy read_network(const StudyContext& context, const TomlValue& root,
                            const std::filesystem::path& folder, Parameters& parameters, StudyKind kind);

// [decay], [transient] and [[initial]] into the study's choice, after the network, in the same way.
void read_motion(const StudyContext& context, const TomlValue& root, Study& study);

// [compare] into the choice of a sweep, once the network is there. Sets the quantity of a slope parameter.
void read_comparison(const StudyContext& context, const TomlValue& root, Study& study);
// Refuses a `show` of [compare] that does not fit what the study shows itself, once that is read.
void check_compared_show(const StudyContext& context, const TomlValue& root, const Study& study);

// [tune], [[design]], [[constraint]], [[scenario]] and [[column]] into the study's choice, once units are
// converted.
void read_tuning(const StudyContext& context, const TomlValue& root, Study& study);
// The same for a network under records.  folder: of their files.
void read_tuning_over_records(const StudyContext& context, const TomlValue& root,
                              const std::filesystem::path& folder, DataFiles data, Study& study);

// Refuses values that are invalid at a corner of the bounds, of the scenarios and of the band, and gives each
// crank the even orders that it needs there.
void check_tuning(Study& study);

// [identify] and its tables into the study's choice. Their expressions are read before units are converted,
// as those of the network; measurements and earlier estimates after. folder: of their files.
void read_identification(const StudyContext& context, const TomlValue& root, Study& study);
void read_measurements(const StudyContext& context, const TomlValue& root,
                       const std::filesystem::path& folder, DataFiles data, Study& study);

// Refuses values that are invalid in some record at the start of the fit, and gives each crank the even
// orders that it needs there. Other points within the bounds may be invalid: the fit avoids them.
void check_identification(Study& study);

// The corners of a box: true marks the upper end of a dimension. For many dimensions, only the lowest and the
// highest corner and those that differ from either in one dimension.
std::vector<std::vector<bool>> corners(std::size_t dimensions);

// Every mass must be held: by a chain of springs from ground or a node of prescribed motion.
// masses: their positions in the study.
void check_masses_are_held(const StudyContext& context, const NetworkOfStudy& system,
                           const std::vector<Position>& masses);
// The same where levers hold them, whose factors are settled.
void check_combinations_are_held(const Study& study);

// Gives each element `along` a combination its factors, once units are converted and all that may change is
// read. Refuses factors that change within the study, and masses that no spring holds through levers.
void set_directions(Study& study);

// Gives each bend of a table its side of the origin, once units are converted.
void set_characteristics(Study& study);

// What is wrong with the values of an element next to each other, at one point (SI values of all parameters,
// completed): of a table that does not rise or pass through the origin, of a static force below the force.
struct ElementProblem {
  Rule rule;
  const StudyValue* value = nullptr;  // at which it is reported
  std::string found, must;
};
std::optional<ElementProblem> element_problem(const Study& study, std::size_t element,
                                              std::span<const double> parameters);

// Refuses elements that bend.
void refuse_bends(const Study& study, const std::string& why);
// Refuses smooth laws in a study whose solver follows the exact ones.
void refuse_smooth_laws(const Study& study, std::string_view what_is_exact);
// Refuses smooth laws together with contacts that are followed exactly, or with elements that bend.
void refuse_mixed_laws(const Study& study);
// Refuses elements with which several responses may exist; where they depend on numbers, element_problem()
// does.
void refuse_several_responses(const Study& study, const std::string& what_needs_one);
// What of the study needs that there is one response, "" if nothing does.
std::string needs_one_response(const Study& study);

// [orbits] of a sweep or a tuning.
periodic::OrbitsWanted read_orbits_wanted(const StudyContext& context, const TomlValue& root,
                                          const Study& study);

// [[axis]], [[coordinate]], [output] and [report] into the map of a study. folder: of the axes' files.
// data: where earlier results are left, samples of their estimates all stand at the values of the study.
void read_axes(const StudyContext& context, const TomlValue& root, const std::filesystem::path& folder,
               DataFiles data, Study& study);
void read_coordinates(const StudyContext& context, const TomlValue& root, Study& study);
void read_output(const StudyContext& context, const TomlValue& root, Study& study);  // of a sweep
void read_motion_output(const StudyContext& context, const TomlValue& root, Study& study);
// The key `show`: which of several responses, by default the largest; a sweep needs exact laws and an axis of
// the frequency.
periodic::OrbitsWanted::Show read_show(const TomlSection& section);
void check_sweep(const TomlSection& section, const Study& study);
void read_branches(const StudyContext& context, const TomlSection& output, Study& study);
void read_report(const StudyContext& context, const TomlValue& root, Study& study);

// The keys `quantities` and `precision` of [output], and the points listed under a key, `orbits` or
// `histories`.
void read_recorded(const TomlSection& section, MapChoice& map);
void read_histories(const StudyContext& context, const TomlSection& section, const char* key, Study& study);
// The names in the array `quantities` of a section, and patterns of names (name_pattern.hpp), each once.
std::vector<OutputChoice::Name> read_quantity_names(const TomlSection& section);

// Every value must be finite and in its range on the whole grid and at the orbits listed. A value is checked
// at all points of the dimensions it depends on or, if these are too many, at their corners.
void check_grid(const Study& study);

// Gives each crank the even orders for its largest crank/rod on the grid and at the orbits listed.
void set_crank_orders(Study& study);
// Adds the orders needed at one more point (SI values of all parameters, completed).
void add_crank_orders_at(Study& study, std::span<const double> parameters);

// A number in the unit given next to it, as { value, unit } or as a bare number (no unit then).
struct NumberWithUnit {
  double value = 0.0;
  std::optional<Unit> unit;  // none in a dimensionless study
  Position unit_position;
};
NumberWithUnit read_number_with_unit(const StudyContext& context, const std::string& where,
                                     const TomlValue& value);

// A number parameter set to a value: an entry of a table such as { omega = 250, I = { value = 6, unit = "kg"
// } }, a bare number in its usual unit. why_not: the reason why a parameter cannot be set there, "" if it
// can; empty: all can.
using WhyNot = std::function<std::string(std::size_t parameter)>;
Assignment read_assignment(const StudyContext& context, const Study& study, const std::string& where,
                           const TomlEntry& entry, const WhyNot& why_not = {});

// The unit of a key; none in a dimensionless study, where only "1" is allowed.
std::optional<Unit> read_unit(const StudyContext& context, const std::string& where, const TomlValue& value);

// An expression of the parameters. It is noted in the context with the dimension that it has to have.
Expression read_expression(const StudyContext& context, const Parameters& parameters,
                           const std::string& where, const TomlValue& value,
                           std::optional<WantedDimension> wanted = std::nullopt);

// The dimension of a formula of lengths and ratios, while it is read. Numbers without a unit are ratios in
// it, but without a length they may be lengths: then nothing is known. Throws StudyError for mixed
// dimensions.
ExpressionDimension dimension_of_geometry(const StudyContext& context, const Parameters& parameters,
                                          const Expression& expression, const std::string& where,
                                          Position position);

// Refuses an expression in [parameters], or a noted one, that mixes dimensions or has the wrong one; once all
// units are known.
void check_dimensions(const StudyContext& context, const Parameters& parameters);

}  // namespace frahm::studies
