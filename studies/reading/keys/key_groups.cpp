#include "studies/reading/keys/key_groups.hpp"

namespace frahm::studies {
namespace {

constexpr TooMany too_many(const char* text, std::optional<Rule> rule = std::nullopt) {
  return {{text, rule}};
}
constexpr Missing missing(const char* text, std::optional<Rule> rule = std::nullopt) {
  return {{text, rule}};
}

constexpr TooMany two_ways_of_an_axis = too_many(
    "cannot be combined with \"{}\": give either values, or from, to and points", rules::key_without_use);

constexpr KeyGroup all_groups[] = {
    {"", "mass|matrices", Together::at_least_one, KeyOwners{"kind", "sweep|decay|transient|tune"}},
    {"mass", "mass|inertia", Together::one,
     too_many("it already has a mass; what both moves in a line and turns needs two [[mass]], one for each"),
     missing("the key \"mass\" is missing (a mass, kg)", rules::missing_key_of_table)},
    {"element", "between|along", Together::one,
     too_many("the element is already between two nodes; give only one of the two"),
     missing("the key \"between\" is missing (or \"along\", for a combination of coordinates)")},
    {"damping", "modal|rayleigh", Together::one,
     too_many("the structure already has \"{}\" damping; give only one of the two"),
     missing(
         "expected either modal = 0.02, a ratio for all modes or a list of ratios, or rayleigh = [a, b]")},
    {"excitation", "force|motion|record", Together::at_least_one,
     missing("nothing excites the system: it needs an [[excitation.force]] or [[excitation.motion]]; a "
             "transient or a tuning may have an [[excitation.record]] instead",
             rules::missing_section)},
    {"excitation.force", "on|node", Together::one,
     too_many("the mass is named twice, by \"on\" and \"node\"", rules::given_twice),
     missing("the key \"on\" is missing (the mass it acts on)", rules::missing_key_of_table)},
    {"excitation.force", "amplitude|force", Together::one, KeyOwners{"profile", "harmonic"},
     too_many("the force is already given by its \"{}\""),
     missing("the key \"amplitude\" is missing (or \"force\", a list of corners)",
             rules::missing_key_of_table)},
    {"excitation.motion", "amplitude|displacement|velocity|acceleration", Together::one,
     KeyOwners{"profile", "harmonic"}, too_many("the motion is already given by its \"{}\""),
     missing("the key \"amplitude\" is missing (or \"displacement\", \"velocity\" or \"acceleration\")",
             rules::missing_key_of_table)},
    {"excitation.record", "acceleration_of|velocity_of|displacement_of|force_on", Together::one,
     too_many("it is already given as \"{}\"; a record drives only one"),
     missing("what it drives is missing: give acceleration_of, velocity_of or displacement_of of a support, "
             "or force_on a mass",
             rules::missing_key)},
    {"excitation.record", "interpolation|displacement_of", Together::not_without,
     missing("belongs to displacement_of; all other records are straight lines between samples")},
    {"axis", "values|from", Together::one, KeyOwners{"", "numbers"}, two_ways_of_an_axis,
     missing("its values are missing: give values = [...], or from, to and points", rules::missing_key)},
    {"axis", "values|to", Together::at_most_one, KeyOwners{"", "numbers"}, two_ways_of_an_axis},
    {"axis", "values|points", Together::at_most_one, KeyOwners{"", "numbers"}, two_ways_of_an_axis},
    {"axis", "values|spacing", Together::at_most_one, KeyOwners{"", "numbers"}, two_ways_of_an_axis},
    {"axis", "from|to|points", Together::all_or_none, KeyOwners{"", "numbers"}},
    {"axis", "of|fixed_from", Together::at_least_one, KeyOwners{"", "samples"},
     missing(
         "the uncertain parameters are missing: give tables [[axis.of]] with distributions, or fixed_from",
         rules::missing_key)},
    {"axis", "parameters|fixed_from", Together::not_without, KeyOwners{"", "samples"},
     missing("has no effect without fixed_from: it chooses among the estimates of a result")},
    {"axis", "fixed_from|parameters", Together::all_or_none, KeyOwners{"", "samples"}},
    {"axis.of", "median|mean", Together::one, KeyOwners{"distribution", "lognormal"}},
    {"axis.of", "deviation|variation", Together::one, KeyOwners{"distribution", "normal|lognormal"}},
    {"axis.records", "corner_frequency|corner_damping", Together::all_or_none},
    {"compare", "law|taylor_order|show", Together::one,
     too_many("\"{}\" is already compared; compare one thing at a time"),
     missing("needs either \"law\", another friction law, \"taylor_order\", another crank profile, or "
             "\"show\", another of several responses")},
    {"report", "height|profile", Together::not_without,
     missing("heights belong to the masses of `profile`, which is missing")},
    {"transient", "sweep_to|sweep_rate", Together::all_or_none,
     missing("the key \"{}\" is missing: a run-up or run-down needs both sweep_to and sweep_rate")},
    {"initial", "displacement|velocity", Together::at_least_one,
     missing("a displacement, a velocity or both are needed")},
    {"tune.noise", "force_on|acceleration_of", Together::one,
     too_many("the noise already has \"{}\"; it acts on one of the two"),
     missing("needs either \"force_on\", a mass, or \"acceleration_of\", a node of prescribed motion")},
    {"tune", "global|start", Together::not_without, missing("belongs to start = \"nlopt\"")},
    {"tune", "trade_off|band", Together::not_without,
     missing("needs the key \"band\": limits hold over a band of frequencies", rules::missing_key)},
    {"design", "rule|schedule", Together::not_without,
     missing("is compared with a schedule, but this [[design]] has none")},
    {"constraint", "lower|upper", Together::at_least_one, missing("needs \"lower\", \"upper\" or both")},
    {"identify", "mass|stiffness", Together::at_most_one, KeyOwners{"method", "free_decay"},
     too_many(
         "the mass is also given; a free decay determines one of the two from the other by its frequency")},
};

constexpr SectionForm all_forms[] = {
    {"axis", "records", "records"},
    {"axis", "file", "from", true},
    {"axis", "samples", "samples|of|fixed_from"},
    {"axis", "numbers", ""},
    {"tune", "records", "excitation.record"},
    {"tune", "band", ""},
};

}  // namespace

std::span<const KeyGroup> key_groups() {
  return all_groups;
}

std::span<const SectionForm> section_forms() {
  return all_forms;
}

}  // namespace frahm::studies
