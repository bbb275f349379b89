#include "studies/reading/keys/key_groups.hpp"

namespace frahm::studies {
namespace {

constexpr KeyGroup all_groups[] = {
    {"", "mass|matrices", Together::at_least_one, {"kind", "sweep|decay|transient|tune"}},
    {"mass", "mass|inertia", Together::one},
    {"element", "between|along", Together::one},
    {"damping", "modal|rayleigh", Together::one},
    {"excitation", "force|motion|record", Together::at_least_one},
    {"excitation.force", "on|node", Together::one},
    {"excitation.motion", "amplitude|velocity|acceleration", Together::one, {"profile", "harmonic"}},
    {"excitation.record", "acceleration_of|velocity_of|displacement_of|force_on", Together::one},
    {"excitation.record", "interpolation|displacement_of", Together::not_without},
    {"axis", "from|values", Together::one, {"", "numbers"}},
    {"axis", "from|to|points", Together::all_or_none, {"", "numbers"}},
    {"axis", "values|spacing", Together::at_most_one, {"", "numbers"}},
    {"axis", "of|fixed_from", Together::at_least_one, {"", "samples"}},
    {"axis", "fixed_from|parameters", Together::all_or_none, {"", "samples"}},
    {"axis.of", "median|mean", Together::one, {"distribution", "lognormal"}},
    {"axis.of", "deviation|variation", Together::one, {"distribution", "normal|lognormal"}},
    {"axis.records", "corner_frequency|corner_damping", Together::all_or_none},
    {"compare", "law|taylor_order|show", Together::one},
    {"report", "height|profile", Together::not_without},
    {"transient", "sweep_to|sweep_rate", Together::all_or_none},
    {"initial", "displacement|velocity", Together::at_least_one},
    {"tune.noise", "force_on|acceleration_of", Together::one},
    {"tune", "global|start", Together::not_without},
    {"tune", "trade_off|band", Together::not_without},
    {"design", "rule|schedule", Together::not_without},
    {"constraint", "lower|upper", Together::at_least_one},
    {"identify", "mass|stiffness", Together::at_most_one, {"method", "free_decay"}},
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
