#include "studies/reading/map/comparison_reading.hpp"

#include <algorithm>

#include "solvers/mechanics/bends.hpp"
#include "solvers/mechanics/element_table.hpp"
#include "solvers/mechanics/smooth_laws.hpp"
#include "studies/reading/keys/toml_section.hpp"
#include "studies/reading/map/orbits_reading.hpp"
#include "studies/reading/map/output_reading.hpp"
#include "studies/reading/system/network_reading.hpp"
#include "studies/reading/system/unfit_elements.hpp"
#include "studies/reading/text/spelling.hpp"

namespace frahm::studies {
namespace {

using mechanics::ExcitationKind;
using mechanics::ForceLaw;

// There is no exact law to compare these with.
void refuse_other_smooth_laws(const TomlSection& section, const Study& study) {
  const auto& elements = study.network.elements;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    if (!mechanics::has_smooth_law(elements[e]) || elements[e].law == ForceLaw::arctan) continue;
    section.fail(rules::wrong_law, "law", "element \"{}\" has a {}, which no other law has", elements[e].name,
                 smooth_key(study, e).key);
  }
}

void read_compared_law(NetworkReading& reading, const TomlSection& section, const Study& study,
                       Comparison& comparison) {
  const auto& elements = study.network.elements;
  const auto rubbing = std::find_if(elements.begin(), elements.end(), [](const auto& each) {
    return mechanics::kind_of(each).can_be_smoothed();
  });
  if (rubbing == elements.end())
    section.fail(rules::no_contact, "law", "the study has no coulomb element that could follow it");
  refuse_other_smooth_laws(section, study);
  const bool arctan = section.choice("law") == "arctan";
  comparison.law = arctan ? ForceLaw::arctan : ForceLaw::exact;
  if (arctan) {
    refuse_bends(study, "it cannot be combined with the compared law \"arctan\"");
    for (const mechanics::Element& each : elements) {
      const mechanics::ElementKind& kind = mechanics::kind_of(each);
      if (each.has_static_force)
        section.fail(rules::wrong_law, "law",
                     "element \"{}\" has a static_force, which is not available with the arctan law",
                     each.name);
      if (kind.law == nullptr || kind.can_be_smoothed()) continue;
      section.fail(rules::wrong_law, "law", "element \"{}\" is a {}, which has no arctan law", each.name,
                   kind.name);
    }
    comparison.slope = read_value(reading, section, "slope", Quantity::inverse_speed);
    return;
  }
  if (section.find("slope"))
    section.fail(rules::key_without_use, "slope", "only the law \"arctan\" has a slope");
  if (rubbing->law == ForceLaw::exact)
    section.fail(rules::wrong_law, "law",
                 "the study already follows the exact law; compare it with \"arctan\"");
}

void read_compared_profile(const TomlSection& section, const Study& study, Comparison& comparison) {
  if (section.find("slope"))
    section.fail(rules::key_without_use, "slope", "belongs to a compared law, not to a compared profile");
  comparison.taylor_order = static_cast<int>(section.integer("taylor_order"));
  const auto& excitations = study.network.excitations;
  const auto differs = [&](const mechanics::Excitation& each) {
    return each.kind == ExcitationKind::crank && each.taylor_order != comparison.taylor_order;
  };
  if (std::any_of(excitations.begin(), excitations.end(), differs)) return;
  const bool none = std::none_of(excitations.begin(), excitations.end(),
                                 [](const auto& each) { return each.kind == ExcitationKind::crank; });
  section.fail(rules::beyond_schema(rules::key_without_use), "taylor_order", "{}",
               none ? "the study has no motion of the profile \"crank\" to be cut"
                    : "the study's cranks are already cut at this order");
}

// A real-valued quantity of the study by its name.
periodic::Quantity read_quantity(const TomlSection& section, const OutputChoice::Name& name,
                                 const Study& study) {
  const auto fail = [&](Rule rule, const std::string& message) {
    throw section.source().error_at(rule, name.position, "{}: quantities: \"{}\"{}", section.where(),
                                    name.text, message);
  };
  const auto describe = [&](const periodic::Quantity& quantity) {
    return periodic::describe(quantity, study.network, study.dimensionless);
  };
  const auto quantity = periodic::find_quantity(name.text, study.network);
  if (!quantity) {
    std::vector<std::string> known;
    for (const auto& each : periodic::all_quantities(study.network)) known.push_back(describe(each).name);
    fail(rules::unknown_name, " is not a quantity of the study" + suggestion(name.text, known));
  }
  if (describe(*quantity).kind != periodic::QuantityKind::real)
    fail(rules::unfit_quantity,
         " is a count or a flag; a relative difference needs numbers that vary continuously");
  return *quantity;
}

TomlSection section_of(const StudyContext& context, const TomlEntry& entry) {
  return {context.source, entry.value, "[compare]", "compare"};
}

// "law", "taylor_order" or "show".
std::string subject_of(const TomlSection& section) {
  for (const char* key : {"law", "taylor_order"})
    if (section.find(key)) return key;
  return "show";
}

void read_compared_show(const TomlSection& section, const Study& study, Comparison& comparison) {
  if (section.find("slope"))
    section.fail(rules::key_without_use, "slope", "belongs to a compared law, not to another response");
  if (!mechanics::may_have_several_responses(study.network))
    section.fail(rules::beyond_schema(rules::key_without_use), "show", "{}", only_one_response());
  comparison.show = read_show(section);
}

}  // namespace

void read_comparison(const StudyContext& context, const TomlValue& root, Study& study) {
  const TomlEntry* entry = find_entry(root, "compare");
  if (!entry) return;
  const TomlSection section = section_of(context, *entry);
  const std::string subject = subject_of(section);
  Comparison comparison;
  NetworkReading reading(context, study.parameters);
  if (subject == "law") read_compared_law(reading, section, study, comparison);
  if (subject == "taylor_order") read_compared_profile(section, study, comparison);
  if (subject == "show") read_compared_show(section, study, comparison);
  if (section.find("quantities")) {
    for (const OutputChoice::Name& name : read_quantity_names(section))
      comparison.quantities.push_back(read_quantity(section, name, study));
  } else {
    comparison.quantities = {{periodic::Measure::peak, 0}};
  }
  study.sweep()->comparison = std::move(comparison);
}

void check_compared_show(const StudyContext& context, const TomlValue& root, const Study& study) {
  const auto& comparison = study.sweep()->comparison;
  if (!comparison || !comparison->show) return;
  const TomlSection section = section_of(context, *find_entry(root, "compare"));
  if (*comparison->show == study.sweep()->orbits.show)
    section.fail(rules::beyond_schema(rules::key_without_use), "show",
                 "the study already shows this response; choose another");
  if (periodic::OrbitsWanted::is_slow_sweep(*comparison->show)) check_slow_sweep(section, study);
}

}  // namespace frahm::studies
