#include "studies/provenance/fingerprint.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <initializer_list>
#include <numeric>
#include <set>
#include <string_view>

#include "solvers/mechanics/bends.hpp"
#include "studies/provenance/digest.hpp"
#include "studies/provenance/document_facts.hpp"
#include "studies/reading/keys/study_keys.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/text/toml_writing.hpp"

namespace frahm::studies {
namespace {

// Raised with every change of the solvers that changes a result by more than the last bits.
constexpr int solver_version = 11;

// The text that is hashed: a line for each item, every number in its shortest exact form.
class CanonicalText {
 public:
  template <typename... Args>
  void line(fmt::format_string<Args...> form, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), form, std::forward<Args>(args)...);
    text_ += '\n';
  }

  std::string hash() const { return digest(std::as_bytes(std::span(text_))); }

 private:
  std::string text_;
};

// Their order in a study changes nothing.
std::vector<std::size_t> in_order_of_names(const Parameters& parameters) {
  std::vector<std::size_t> order(parameters.list.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return parameters.list[i].name; });
  return order;
}

void add_parameters(const Study& study, CanonicalText& text) {
  const auto names = study.parameters.names();
  for (const std::size_t i : in_order_of_names(study.parameters)) {
    const auto& definition = study.parameters.list[i].definition;
    if (has_axis(study, i)) {
      text.line("parameter {} axis", names[i]);
    } else if (const auto* number = std::get_if<double>(&definition)) {
      text.line("parameter {} number {}", names[i], *number);
    } else if (const auto* expression = std::get_if<Expression>(&definition)) {
      text.line("parameter {} expression {}", names[i], expression->canonical_text(names));
    } else {
      const TableOf& table = std::get<TableOf>(definition);
      text.line("parameter {} table of {} x {} y {}", names[i], names[table.of],
                fmt::join(table.table.x, " "), fmt::join(table.table.y, " "));
    }
  }
}

// The text of a value: numbers in SI, expressions in one form, of a file nothing, as its content counts.
class FactText {
 public:
  explicit FactText(const Study& study) : study_(&study), names_(study.parameters.names()) {}

  std::string of(const Fact& fact) const { return of(fact.value, fact, fact.parameter); }

  // Whether it says what would be so without it.
  static bool is_default(const Fact& fact) {
    if (!fact.key || !fact.key->by_default) return false;
    const double otherwise = *fact.key->by_default;
    if (const auto* flag = fact.value.as<bool>()) return *flag == (otherwise != 0.0);
    if (const auto* word = fact.value.as<std::string>())
      return fact.key->form == KeyForm::choice &&
             *word == fact.key->words[static_cast<std::size_t>(otherwise)].word;
    return is_number(fact.value) && plain(fact.value) == otherwise;
  }

 private:
  // parameter: whose value a bare number is; "" for none.
  std::string of(const TomlValue& value, const Fact& fact, const std::string& parameter) const {
    if (is_number(value)) return number(plain(value), fact, parameter);
    if (value.as<std::string>()) return of_text(value, *fact.key);
    if (const auto* list = value.as<TomlArray>()) {
      std::string items;
      for (const TomlValue& each : *list) items += " " + of(each, fact, parameter);
      return fmt::format("[{} ]", items);
    }
    return value.as<TomlTable>() ? of_table(value, fact, parameter) : toml_in_line(value);
  }

  std::string of_table(const TomlValue& table, const Fact& fact, const std::string& parameter) const {
    const TomlEntry *number_of = find_entry(table, "value"), *unit_of = find_entry(table, "unit");
    const auto* unit = unit_of ? unit_of->value.as<std::string>() : nullptr;
    if (number_of && is_number(number_of->value) && unit) return in_si(plain(number_of->value), *unit);
    const bool is_settings = fact.key->form == KeyForm::list_of_settings;
    std::string entries;
    for (const TomlEntry& each : *table.as<TomlTable>())
      entries += fmt::format(" {} = {}", each.key, of(each.value, fact, is_settings ? each.key : parameter));
    return fmt::format("{{{} }}", entries);
  }

  // A bare number in SI, by the unit that its reader takes for it.
  std::string number(double value, const Fact& fact, const std::string& parameter) const {
    const std::string_view section = fact.key->section;
    const auto index = study_->parameters.find(parameter);
    const auto& band = study_->tune() ? study_->tune()->band : std::nullopt;
    if (fact.key->form == KeyForm::settings || fact.key->form == KeyForm::list_of_settings)
      return index ? in_unit_of_parameter(value, *index) : fmt::format("{}", value);
    if (section == "design.schedule" && index && band)
      return fmt::format("{}", value * usual_unit(*study_, *index).si_factor / band->unit.si_factor);
    if (section == "constraint.band" && fact.unit.empty() && band)
      return fmt::format("{}", value * band->unit.si_factor);
    if (index) return fmt::format("{}", value * usual_unit(*study_, *index).si_factor);
    if (fact.unit.empty()) return fmt::format("{}", value);
    // A column may give its number in the unit already.
    return section == "column" ? fmt::format("{} {}", value, fact.unit) : in_si(value, fact.unit);
  }

  // With all units in which it can be meant: that of the parameter where the study uses it, and where it is
  // defined.
  std::string in_unit_of_parameter(double value, std::size_t parameter) const {
    const auto& defined_in = study_->parameters.list[parameter].unit;
    return fmt::format("{} {} {}", value, usual_unit(*study_, parameter).text,
                       defined_in ? defined_in->text : "");
  }

  // Where 1/s, Hz and 1/min count cycles depends on what is expected, so that they differ from rad/s here.
  std::string in_si(double value, const std::string& text) const {
    const Unit unit = units_.parse(text);
    return fmt::format("{}{}", value * unit.scale, unit.counts_cycles() ? " cycles" : "");
  }

  std::string of_text(const TomlValue& text, const StudyKey& key) const {
    const auto is_of = [&](std::initializer_list<KeyForm> forms) {
      return std::ranges::find(forms, key.form) != forms.end() ||
             (key.has_other && std::ranges::find(forms, key.other) != forms.end());
    };
    if (is_of({KeyForm::file, KeyForm::files})) return "file";
    const bool may_be_factor = key.form == KeyForm::settings && key.inside == KeyForm::value;
    if (may_be_factor ||
        is_of({KeyForm::value, KeyForm::values, KeyForm::pairs, KeyForm::plain_value, KeyForm::expression}))
      return Expression::parse(*text.as<std::string>(), names_).canonical_text(names_);
    return toml_in_line(text);
  }

  static double plain(const TomlValue& number) {
    const auto* whole = number.as<std::int64_t>();
    return whole ? static_cast<double>(*whole) : *number.as<double>();
  }

  const Study* study_;
  std::vector<std::string> names_;
  UnitSystem units_;
};

// What a study says that is of one of these uses, by names, so that the order of its keys changes nothing;
// the order of its lists of tables counts where all that they say is physics. Parameters are left out.
void add_facts(const Facts& facts, const FactText& text_of, std::initializer_list<Use> uses,
               CanonicalText& text) {
  const auto counts = [&](Use use) { return std::ranges::find(uses, use) != uses.end(); };
  std::set<std::string> lines;
  for (const Fact& fact : facts.list) {
    if (counts(fact.key->use) && path_of(*fact.key) != "parameters" && !FactText::is_default(fact))
      lines.insert(fmt::format("{} = {}", fact.name, text_of.of(fact)));
  }
  for (const std::string& line : lines) text.line("{}", line);
  for (const Sequence& sequence : facts.sequences) {
    const auto rows = study_keys();
    const bool is_physics = std::ranges::none_of(rows, [&](const StudyKey& row) {
      return row.section == path_of(*sequence.key) && (row.use == Use::grid || row.use == Use::shown);
    });
    if (counts(is_physics ? Use::physics : Use::grid))
      text.line("{} {}", sequence.name, fmt::join(sequence.members, ", "));
  }
}

// The parts of a system that come from files.
void add_matrices(const Study& study, CanonicalText& text) {
  for (const mechanics::MatrixPart& part : study.network.matrices)
    text.line("matrices {} {} {} {} {}", part.name, fmt::join(part.nodes, " "), digest(part.mass),
              digest(part.stiffness), digest(part.damping));
}

void add_periods(const Study& study, CanonicalText& text) {
  for (const PeriodSeries& period : study.values.series) {
    if (!period.file.empty())
      text.line("period {} time {} values {}", period.first, digest(period.time), digest(period.samples));
  }
}

// The samples of records, wherever they come from.
void add_driving_records(const Study& study, CanonicalText& text) {
  if (!study.transient() && !(study.tune() && study.tune()->peaks)) return;
  for (const DrivingRecord& driving :
       study.transient() ? study.transient()->records : study.tune()->peaks->driving) {
    for (const transient::Record& record : driving.records)
      text.line("record {} of {} on axis {} time {} values {}{}", driving.excitation,
                static_cast<int>(record.of), driving.on_axis, digest(record.time), digest(record.values),
                record.jumps() ? " linear" : "");
  }
}

// The measurements of an identification, and the estimates that it takes over.
void add_measurements(const IdentifyChoice& choice, std::span<const std::string> names, CanonicalText& text) {
  for (const RecordChoice& record : choice.records) {
    text.line("record {}", record.name);
    for (const DataColumn& column : record.columns)
      text.line("column {} {}", column.role, fmt::join(column.values, " "));
    text.line("labels {}", fmt::join(record.labels, "\n"));
  }
  for (std::size_t i = 0; i < choice.fixed.size(); ++i)
    text.line("fixed {} {} {} degrees of freedom {}", names[choice.fixed[i].parameter], choice.fixed[i].value,
              fmt::join(choice.fixed_covariance[i], " "), choice.fixed[i].degrees_of_freedom);
}

// The samples over which a tuning is made.
void add_scenarios(const TuneChoice& tune, std::span<const std::string> names, CanonicalText& text) {
  for (const ScenarioChoice& scenario : tune.scenarios) {
    for (const Assignment& at : scenario.set) text.line("scenario {} {}", names[at.parameter], at.value);
    text.line("scenario ends");
  }
}

// The points of a sweep depend on all frequencies of their row.
void add_swept_frequencies(const SweepChoice& sweep, const Parameters& parameters, CanonicalText& text) {
  if (!sweep.sweeps_frequency()) return;
  for (const std::size_t a : sweep.dimensions[*sweep.frequency_dimension].axes) {
    const ParameterAxis& axis = sweep.axes[a];
    text.line("swept {} {}", parameters.list[axis.parameter].name, fmt::join(axis.si_values, " "));
  }
}

std::string physics_hash(const Study& study, const Facts& facts, const FactText& text_of,
                         std::span<const std::string> quantities) {
  CanonicalText text;
  text.line("solver {}", solver_version);
  add_parameters(study, text);
  add_facts(facts, text_of, {Use::physics}, text);
  add_matrices(study, text);
  add_periods(study, text);
  add_driving_records(study, text);
  if (study.tune()) add_scenarios(*study.tune(), study.parameters.names(), text);
  if (study.identify()) add_measurements(*study.identify(), study.parameters.names(), text);
  // The stairs of a run-up are refined until its samples stand.
  if (study.map() && study.transient() && study.transient()->sweep_to)
    text.line("samples {}", study.transient()->samples);
  if (study.sweep() && mechanics::may_have_several_responses(study.network))
    add_swept_frequencies(*study.sweep(), study.parameters, text);
  for (const std::string& quantity : quantities) text.line("quantity {}", quantity);
  return text.hash();
}

// The points of a map: values that are spaced, drawn or read from files.
void add_axes(const Study& study, const MapChoice& map, CanonicalText& text) {
  for (const GridDimension& dimension : map.dimensions) {
    text.line("dimension {} {}", dimension.name, dimension.size);
    if (dimension.axes.empty()) text.line("records {}", fmt::join(map.records->names, "\n"));
    for (const std::size_t a : dimension.axes) {
      const ParameterAxis& axis = map.axes[a];
      text.line("axis {} {}", study.parameters.list[axis.parameter].name, fmt::join(axis.si_values, " "));
    }
  }
}

std::string grid_hash(const Study& study, const Facts& facts, const FactText& text_of, Tiling tiling) {
  CanonicalText text;
  add_facts(facts, text_of, {Use::grid, Use::shown}, text);
  if (study.map()) add_axes(study, *study.map(), text);
  text.line("order {}", fmt::join(tiling.order, " "));
  text.line("tile {}", fmt::join(tiling.tile, " "));
  return text.hash();
}

}  // namespace

engine::Fingerprint fingerprint(const Study& study, Tiling tiling, std::span<const std::string> quantities) {
  const Facts facts = facts_of(document_of(study));
  const FactText text_of(study);
  return {.physics = physics_hash(study, facts, text_of, quantities),
          .grid = grid_hash(study, facts, text_of, tiling)};
}

engine::Fingerprint grown_fingerprint(const engine::Fingerprint& study, const std::string& identity) {
  CanonicalText text;
  text.line("grid {} grown from {}", study.grid, identity);
  return {.physics = study.physics, .grid = text.hash()};
}

engine::Fingerprint branch_fingerprint(const engine::Fingerprint& study, const std::string& course) {
  CanonicalText text;
  text.line("branch {}", course);
  return {.physics = study.physics, .grid = text.hash()};
}

std::string identity_of(std::span<const results::Text> provenance) {
  CanonicalText text;
  for (const auto& [name, value] : provenance) text.line("{} {} {}", name, value.size(), value);
  return text.hash();
}

}  // namespace frahm::studies
