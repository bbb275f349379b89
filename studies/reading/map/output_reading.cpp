#include "studies/reading/map/output_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solvers/mechanics/coordinates.hpp"
#include "studies/reading/map/branches_reading.hpp"
#include "studies/reading/map/profile_reading.hpp"
#include "studies/reading/study/assignment_reading.hpp"
#include "studies/reading/system/unfit_elements.hpp"
#include "studies/reading/text/name_pattern.hpp"
#include "studies/reading/text/spelling.hpp"

namespace frahm::studies {
namespace {

constexpr std::size_t most_bordered_elements = 127;  // values of a flag

void read_quantities(const TomlSection& section, OutputChoice& output) {
  const TomlValue* value = section.find("quantities");
  if (!value) return;
  if (value->as<std::string>()) {
    const std::string word = section.text("quantities");
    if (word != "standard" && word != "all") {
      section.fail(rules::wrong_type, "quantities",
                   "\"{0}\" is neither \"standard\" nor \"all\"; write names as an array: [\"{0}\"]", word);
    }
    output.quantities = word == "all" ? OutputChoice::Quantities::all : OutputChoice::Quantities::standard;
    return;
  }
  output.quantities = OutputChoice::Quantities::listed;
  output.names = read_quantity_names(section);
}

// The shares of the quantiles over the axis of samples.
void read_quantiles(const TomlSection& section, std::optional<SampleChoice>& samples) {
  const TomlValue* value = section.find("quantiles");
  if (!value) return;
  if (!samples)
    section.fail(rules::beyond_schema(rules::key_without_use), "quantiles",
                 "has no effect: no [[axis]] has samples");
  const auto* items = value->as<TomlArray>();
  if (!items || items->empty())
    section.fail(rules::wrong_type, "quantiles", "expected an array of shares such as [0.05, 0.5, 0.95]");
  constexpr double kLeast = 1e-6;  // rarer than any sample here can tell
  samples->quantiles.clear();
  for (const TomlValue& item : *items) {
    const double share = read_number(section.source(), section.where() + ": quantiles", item);
    if (!(share >= kLeast && share <= 1.0 - kLeast))
      throw section.source().error_at(rules::out_of_range, item.position,
                                      "{}: quantiles: {} must be between {} and 1 - {}; 0.5 is the median",
                                      section.where(), share, kLeast, kLeast);
    const bool rises =
        samples->quantiles.empty() || (share > samples->quantiles.back() &&
                                       quantile_name(share) != quantile_name(samples->quantiles.back()));
    if (!rises)
      throw section.source().error_at(rules::wrong_order, item.position,
                                      "{}: quantiles: {} is not above {}, the one before it", section.where(),
                                      share, samples->quantiles.back());
    samples->quantiles.push_back(share);
  }
}

void read_borders(const TomlSection& section, Study& study) {
  study.sweep()->borders = section.boolean("borders");
  if (!study.sweep()->borders) return;
  std::size_t contacts = 0;
  for (const mechanics::Element& element : study.network.elements) {
    if (!mechanics::has_own_contact(element)) continue;
    if (element.law != mechanics::ForceLaw::exact) {
      section.fail(rules::wrong_law, "borders",
                   "element \"{}\" follows a smooth law, under which nothing sticks, so there are no regimes "
                   "with borders",
                   element.name);
    }
    ++contacts;
  }
  if (contacts == 0)
    section.fail(rules::no_contact, "borders",
                 "borders lie between regimes of coulomb elements, but there is no coulomb element");
  if (contacts > most_bordered_elements)
    section.fail(rules::too_large, "borders",
                 "there are {} coulomb elements; at most {} can be distinguished", contacts,
                 most_bordered_elements);
}

// Whether each frequency along a dimension belongs to one value of its axis.
bool frequencies_differ(const Study& study, std::size_t dimension) {
  std::vector<double> parameters = study.parameters.nominal(), omega;
  for (std::size_t i = 0; i < study.map()->dimensions[dimension].size; ++i) {
    set_along(*study.sweep(), dimension, i, parameters);
    study.parameters.complete(std::span<double>(parameters));
    omega.push_back(study.values.omega.expression.evaluate(std::span<const double>(parameters)));
  }
  const auto& places = study.map()->axes[study.map()->dimensions[dimension].axes.front()].si_values;
  for (std::size_t i = 2; i < omega.size(); ++i) {
    const double before = (omega[i - 1] - omega[i - 2]) * (places[i - 1] - places[i - 2]);
    if (before * (omega[i] - omega[i - 1]) * (places[i] - places[i - 1]) <= 0.0) return false;
  }
  return true;
}

void read_resonances(const TomlSection& section, Study& study) {
  const TomlValue* value = section.find("resonances");
  if (!value) return;
  const auto* names = value->as<TomlArray>();
  if (!names) section.fail(rules::wrong_type, "resonances", "expected an array of masses such as [\"main\"]");
  study.sweep()->resonances = read_places(section, "resonances", *names, "mass or signal",
                                          mechanics::coordinate_names(study.network));
  const auto dimension = study.sweep()->frequency_dimension;
  if (!dimension || study.map()->dimensions[*dimension].axes.size() > 1 ||
      study.map()->dimensions[*dimension].size < 3) {
    section.fail(rules::unfit_axis, "resonances",
                 "a resonance is searched for along an axis of the excitation frequency that is not zipped "
                 "with another and has at least 3 points");
  }
  const auto& samples = study.map()->samples;
  if (samples && samples->dimension == *dimension)
    section.fail(
        rules::unfit_axis, "resonances",
        "a resonance is searched for along an axis of the excitation frequency, not along samples of it");
  if (!frequencies_differ(study, *dimension))
    section.fail(rules::unfit_axis, "resonances",
                 "the excitation frequency must rise, or fall, all along its axis");
}

// The number of a record on its axis, from 0.
std::size_t read_record_number(const StudyContext& context, const RecordAxis& records,
                               const std::string& where, const TomlValue& value) {
  const double number = read_number(context.source, where, value);
  if (number >= 0.0 && number < static_cast<double>(records.names.size()) && number == std::floor(number))
    return static_cast<std::size_t>(number);
  throw context.source.error_at(rules::out_of_range, value.position,
                                "{}: record: {} is out of range: must be a whole number from 0 to {}", where,
                                number, records.names.size() - 1);
}

}  // namespace

void read_stored(const TomlSection& section, MapChoice& map) {
  OutputChoice& output = map.output;
  read_quantiles(section, map.samples);
  read_quantities(section, output);
  output.precision = section.choice_as<Precision>("precision");
}

void read_histories(const StudyContext& context, const TomlSection& section, const char* key, Study& study) {
  const TomlValue* value = section.find(key);
  if (!value) return;
  const auto* points = value->as<TomlArray>();
  if (!points)
    section.fail(rules::wrong_type, key, "expected an array of points such as [{{ omega = 250, I = 6.36 }}]");
  const std::string where = fmt::format("[output]: {}", key);
  for (const TomlValue& point : *points) {
    const auto* entries = point.as<TomlTable>();
    if (!entries) {
      throw context.source.error_at(rules::wrong_type, point.position,
                                    "{}: a point is a table such as {{ omega = 250 }}, found {}", where,
                                    described(point));
    }
    KeptPoint kept;
    for (const TomlEntry& entry : *entries) {
      if (study.map()->records && entry.key == "record") {
        kept.record = read_record_number(context, *study.map()->records, where, entry.value);
      } else {
        kept.at.push_back(read_assignment(context, study, where, entry));
      }
    }
    study.map()->output.histories.push_back(std::move(kept));
  }
}

std::vector<OutputChoice::Name> read_quantity_names(const TomlSection& section) {
  const TomlValue& value = section.require("quantities");
  const auto* items = value.as<TomlArray>();
  if (!items || items->empty()) {
    const bool output = section.where() == "[output]";
    section.fail(rules::wrong_type, "quantities", "expected {}an array of names, found {}",
                 output ? "\"standard\", \"all\" or " : "", items ? "an empty array" : described(value));
  }
  std::vector<OutputChoice::Name> names;
  const std::string where = fmt::format("{}: quantities", section.where());
  for (const TomlValue& item : *items) {
    const auto* text = item.as<std::string>();
    const std::string name =
        text && is_pattern(*text) ? *text : read_identifier(section.source(), where, item);
    const bool twice = std::any_of(names.begin(), names.end(), [&](auto& n) { return n.text == name; });
    if (twice)
      throw section.source().error_at(rules::given_twice, item.position, "{}: \"{}\" appears twice", where,
                                      name);
    names.push_back({name, item.position});
  }
  return names;
}

void read_output(const StudyContext& context, const TomlValue& root, Study& study) {
  const TomlEntry* entry = find_entry(root, "output");
  if (!entry) return;
  const TomlSection section(context.source, entry->value, "[output]", "output", kind_name(study.kind()));
  read_stored(section, *study.sweep());
  study.sweep()->general_path = section.choice("path") == "general";
  read_borders(section, study);
  read_histories(context, section, "orbits", study);
  read_resonances(section, study);
  read_branches(context, section, study);
  if (const std::string one = needs_one_response(study); !one.empty()) refuse_several_responses(study, one);
}

namespace {

// A name stands for its peak (a mass) or its stroke (an element).
OutputChoice::Name read_headline(const TomlSection& section, const Study& study) {
  const std::string name = section.identifier("headline");
  const auto endings = {"_peak", "_stroke"};
  for (const std::string ending : endings) {
    if (periodic::find_quantity(name + ending, study.network))
      return {name + ending, section.require("headline").position};
  }
  std::vector<std::string> known;
  for (const periodic::Quantity& quantity : periodic::all_quantities(study.network)) {
    const std::string of = periodic::describe(quantity, study.network, study.dimensionless).name;
    for (const std::string_view ending : endings) {
      if (of.ends_with(ending)) known.push_back(of.substr(0, of.size() - ending.size()));
    }
  }
  section.fail(rules::unknown_name, "headline", "nothing with a peak or a stroke is called \"{}\"{}", name,
               suggestion(name, known));
}

}  // namespace

void read_report(const StudyContext& context, const TomlValue& root, Study& study) {
  const TomlEntry* entry = find_entry(root, "report");
  SweepChoice* sweep = study.sweep();
  if (!entry) {
    if (sweep) sweep->profile = read_profile(nullptr, study.network);
    return;
  }
  const TomlSection section(context.source, entry->value, "[report]", "report", kind_name(study.kind()));
  if (section.find("headline")) study.map()->headline = read_headline(section, study);
  if (section.find("quantities")) study.map()->report_quantities = read_quantity_names(section);
  if (sweep) sweep->profile = read_profile(&section, study.network);
}

}  // namespace frahm::studies
