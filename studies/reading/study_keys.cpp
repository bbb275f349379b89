#include "studies/reading/study_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "studies/reading/element_keys.hpp"
#include "studies/reading/study_words.hpp"

namespace frahm::studies {
namespace {

// The forms of a section that have a key, by the key that decides it.
constexpr KeyOwners of(const char* decider, const char* forms) {
  return {decider, forms};
}

constexpr StudyKey all_keys[] = {
    {"", "study", KeyForm::table, "what kind of study it is"},
    {"", "parameters", KeyForm::names,
     "numbers with names: value, { value, unit }, an expression of others, or { table = \"file.csv\", of = "
     "\"other\" }"},
    {"", "mass", KeyForm::tables, "a mass, or a moment of inertia that turns"},
    {"", "matrices", KeyForm::tables, "a part of the system given by its matrices"},
    {"", "element", KeyForm::tables, "a spring, damper, inerter, friction or another element"},
    {"", "damping", KeyForm::table, "of the structure as a whole, beside dampers"},
    {"", "excitation", KeyForm::table, "what drives the system, and how fast",
     of("kind", "sweep|transient|tune|identify")},
    {"", "axis", KeyForm::tables, "a parameter that varies over the map; the outermost axis first",
     of("kind", "sweep|transient|tune")},
    {"", "coordinate", KeyForm::tables, "a derived coordinate beside an axis", of("kind", "sweep|transient")},
    {"", "output", KeyForm::table, "what is recorded of each point; of what is no map the signals",
     of("kind", "sweep|transient|tune|decay")},
    {"", "orbits", KeyForm::table, "the search, where a system has several responses",
     of("kind", "sweep|tune")},
    {"", "compare", KeyForm::table, "the same map under another law or profile", of("kind", "sweep")},
    {"", "report", KeyForm::table, "what the page of frahm report shows", of("kind", "sweep|transient")},
    {"", "decay", KeyForm::table, "free vibration from initial values", of("kind", "decay")},
    {"", "transient", KeyForm::table, "forced motion from initial values", of("kind", "transient")},
    {"", "initial", KeyForm::tables, "initial values of a mass; 0 where none are given",
     of("kind", "decay|transient|identify")},
    {"", "tune", KeyForm::table, "what is to be as small as possible", of("kind", "tune")},
    {"", "design", KeyForm::tables, "a parameter that a tuning may change", of("kind", "tune")},
    {"", "constraint", KeyForm::tables, "a limit that an optimum must hold", of("kind", "tune")},
    {"", "scenario", KeyForm::tables, "other values of parameters, for which an optimum must be good too",
     of("kind", "tune")},
    {"", "column", KeyForm::tables, "a number that is told beside the optimum, or limited",
     of("kind", "tune")},
    {"", "identify", KeyForm::table, "how a model is found from measurements", of("kind", "identify")},
    {"study", "schema", KeyForm::integer, "version of this form of study file: 1"},
    {"study", "kind", KeyForm::choice, "what is computed", words::kinds},
    {"study", "title", KeyForm::text, "stands in the result and on its page"},
    {"study", "units", KeyForm::choice, "of its values", words::units},
    {"mass", "name", KeyForm::text, "by which elements, excitations and quantities call it"},
    {"mass", "mass", KeyForm::value, "mass [kg], >= 0"},
    {"mass", "inertia", KeyForm::value, "moment of inertia [kg m2]; its displacement is an angle [rad]"},
    {"matrices", "name", KeyForm::text, "of the part"},
    {"matrices", "names", KeyForm::texts, "of its degrees of freedom, in the order of the rows"},
    {"matrices", "mass", KeyForm::text, "file of its mass matrix: .mtx, .csv or file.h5:/path"},
    {"matrices", "stiffness", KeyForm::text, "file of its stiffness matrix: .mtx, .csv or file.h5:/path"},
    {"matrices", "damping", KeyForm::text, "file of its damping matrix: .mtx, .csv or file.h5:/path"},
    {"element", "name", KeyForm::text, "by which quantities call it"},
    {"element", "type", KeyForm::element_type, "kind of element"},
    {"element", "between", KeyForm::texts,
     "the two nodes between which it acts: masses, supports or \"ground\""},
    {"element", "along", KeyForm::names,
     "its displacement as a combination: { mass = 1, other = \"-r\", ground = -1 }"},
    {"element", "stiffness", KeyForm::value, "stiffness [N/m], of what turns [N m/rad]"},
    {"element", "damping", KeyForm::value, "viscous damping [N s/m], of what turns [N m s/rad]"},
    {"element", "inertance", KeyForm::value, "force per relative acceleration [kg], of what turns [kg m2]"},
    {"element", "force", KeyForm::value, "friction force while sliding [N], of what turns [N m]"},
    {"element", "static_force", KeyForm::value, "largest friction force at rest [N], at least `force`"},
    {"element", "loss_factor", KeyForm::value,
     "of hysteretic damping [1]: the loss stiffness over the stiffness"},
    {"element", "law", KeyForm::choice, "of a coulomb element", words::friction_laws},
    {"element", "slope", KeyForm::value, "of the arctan law [s/m]: F (2/pi) arctan(slope v)"},
    {"element", "cubic", KeyForm::value, "of a spring [N/m3]: adds cubic u^3"},
    {"element", "table", KeyForm::any, "a characteristic given by points: a list of pairs, or a CSV file"},
    {"element", "clearance", KeyForm::value, "of a gap [m]: how far it moves before it touches"},
    {"element", "tension", KeyForm::boolean, "of a gap: it acts when pulled rather than when pressed"},
    {"element", "stiffnesses", KeyForm::values, "of an iwan element: of each of its sliders [N/m]"},
    {"element", "forces", KeyForm::values, "of an iwan element: at which each of its sliders gives way [N]"},
    {"element", "distribution", KeyForm::choice, "of an iwan element: how its sliders are spread",
     words::slider_distributions},
    {"element", "elements", KeyForm::integer, "of an iwan element: number of sliders"},
    {"element", "chi", KeyForm::number, "of an iwan element: exponent of the power distribution"},
    {"damping", "modal", KeyForm::any,
     "ratio of all modes, or a list in ascending frequency, the last one of all higher modes too"},
    {"damping", "rayleigh", KeyForm::values, "[a, b]: C = a M + b K, in 1/s and s"},
    {"excitation", "frequency", KeyForm::value,
     "fundamental angular frequency [rad/s]; rpm and Hz count turns"},
    {"excitation", "reference_order", KeyForm::integer,
     "the order of which phases are taken; default: the lowest"},
    {"excitation", "force", KeyForm::tables, "a harmonic force on a mass"},
    {"excitation", "motion", KeyForm::tables, "a harmonic motion of a support"},
    {"excitation", "record", KeyForm::tables, "a measured force or motion of a support"},
    {"excitation.force", "on", KeyForm::text, "the mass it acts on"},
    {"excitation.force", "node", KeyForm::text, "the same as on"},
    {"excitation.force", "amplitude", KeyForm::value,
     "[N], on what turns [N m]: amplitude cos(order omega t + phase)"},
    {"excitation.force", "order", KeyForm::integer, "multiple of the frequency, default 1; 0 is a constant"},
    {"excitation.force", "phase", KeyForm::value, "[rad], default 0"},
    {"excitation.force", "profile", KeyForm::choice, "default harmonic", words::harmonic},
    {"excitation.motion", "node", KeyForm::text, "name of the support, a node without mass"},
    {"excitation.motion", "profile", KeyForm::choice, "of its motion, default harmonic", words::profiles},
    {"excitation.motion", "amplitude", KeyForm::value, "of its displacement [m]", of("profile", "harmonic")},
    {"excitation.motion", "velocity", KeyForm::value, "amplitude of its velocity [m/s]; with order 0 a belt",
     of("profile", "harmonic")},
    {"excitation.motion", "acceleration", KeyForm::value, "amplitude of its acceleration [m/s2]",
     of("profile", "harmonic")},
    {"excitation.motion", "order", KeyForm::integer, "multiple of the frequency, default 1",
     of("profile", "harmonic")},
    {"excitation.motion", "phase", KeyForm::value, "[rad], default 0"},
    {"excitation.motion", "crank", KeyForm::value, "radius of a crank [m]", of("profile", "crank")},
    {"excitation.motion", "rod", KeyForm::value, "length of a crank's rod [m], longer than the crank",
     of("profile", "crank")},
    {"excitation.motion", "taylor_order", KeyForm::integer,
     "1, 2 or 4: the crank's motion cut there; 0: exact", of("profile", "crank")},
    {"excitation.record", "acceleration_of", KeyForm::text, "the support whose motion was measured so"},
    {"excitation.record", "velocity_of", KeyForm::text, "the support whose motion was measured so"},
    {"excitation.record", "displacement_of", KeyForm::text, "the support whose motion was measured so"},
    {"excitation.record", "force_on", KeyForm::text, "the mass on which the measured force acts"},
    {"excitation.record", "file", KeyForm::text, "CSV or HDF5, from the folder of the study"},
    {"excitation.record", "time", KeyForm::any, "column of the time, by heading or number; default 1"},
    {"excitation.record", "column", KeyForm::any, "column of the values; default 2"},
    {"excitation.record", "unit", KeyForm::text,
     "of the values, where the file does not tell; g of accelerations is gravity"},
    {"excitation.record", "scale", KeyForm::value, "multiplies the values, default 1"},
    {"excitation.record", "from", KeyForm::value, "start of a window in the record's own time [s]"},
    {"excitation.record", "to", KeyForm::value, "end of that window [s]"},
    {"axis", "parameter", KeyForm::text, "the one that varies", of("", "numbers")},
    {"axis", "unit", KeyForm::text, "of from, to and values", of("", "numbers")},
    {"axis", "from", KeyForm::any, "first value; or a CSV file of samples", of("", "numbers|file")},
    {"axis", "to", KeyForm::number, "last value", of("", "numbers")},
    {"axis", "points", KeyForm::integer, "number of values, both ends included", of("", "numbers")},
    {"axis", "spacing", KeyForm::choice, "of the steps from one value to the next", words::spacings,
     of("", "numbers")},
    {"axis", "values", KeyForm::any, "a list of values in place of from, to and points", of("", "numbers")},
    {"axis", "zip", KeyForm::text, "axes of the same zip advance together", of("", "numbers|samples|file")},
    {"axis", "samples", KeyForm::integer, "number of samples of uncertain parameters", of("", "samples")},
    {"axis", "sequence", KeyForm::choice, "how samples are drawn", words::sequences, of("", "samples")},
    {"axis", "seed", KeyForm::integer, "of the samples", of("", "samples")},
    {"axis", "of", KeyForm::tables, "a parameter that is uncertain, with its distribution",
     of("", "samples")},
    {"axis", "fixed_from", KeyForm::any, "result of an identification, whose estimates are sampled",
     of("", "samples")},
    {"axis", "parameters", KeyForm::texts, "of its estimates, those to sample", of("", "samples")},
    {"axis", "records", KeyForm::any, "files of records, or { generate = ... }", of("", "records")},
    {"axis.of", "parameter", KeyForm::text, "the uncertain parameter"},
    {"axis.of", "unit", KeyForm::text, "of its distribution's numbers"},
    {"axis.of", "distribution", KeyForm::choice, "of its values", words::distributions},
    {"axis.of", "mean", KeyForm::number, "mean of a normal or lognormal distribution",
     of("distribution", "normal|lognormal")},
    {"axis.of", "median", KeyForm::number, "of a lognormal distribution", of("distribution", "lognormal")},
    {"axis.of", "mode", KeyForm::number, "likeliest value of a triangular one",
     of("distribution", "triangular")},
    {"axis.of", "deviation", KeyForm::number, "standard deviation", of("distribution", "normal|lognormal")},
    {"axis.of", "variation", KeyForm::number, "standard deviation over the mean",
     of("distribution", "normal|lognormal")},
    {"axis.of", "lower", KeyForm::number, "least value; cuts a normal one off"},
    {"axis.of", "upper", KeyForm::number, "largest value; cuts a normal one off"},
    {"axis.records", "generate", KeyForm::choice, "random records of this kind", words::generators},
    {"axis.records", "count", KeyForm::integer, "number of records"},
    {"axis.records", "seed", KeyForm::integer, "of the random numbers"},
    {"axis.records", "duration", KeyForm::value, "of each record [s]"},
    {"axis.records", "rate", KeyForm::value, "samples a second"},
    {"axis.records", "intensity", KeyForm::value, "two-sided spectral density S0"},
    {"axis.records", "ground_frequency", KeyForm::value, "of the soil [rad/s]",
     of("generate", "kanai_tajimi")},
    {"axis.records", "ground_damping", KeyForm::value, "ratio of the soil", of("generate", "kanai_tajimi")},
    {"axis.records", "corner_frequency", KeyForm::value, "below which the ground's motion is bounded [rad/s]",
     of("generate", "kanai_tajimi")},
    {"axis.records", "corner_damping", KeyForm::value, "ratio at the corner", of("generate", "kanai_tajimi")},
    {"axis.records", "envelope", KeyForm::table, "how the strength of the record rises and falls",
     of("generate", "kanai_tajimi")},
    {"axis.records.envelope", "shape", KeyForm::choice, "of the envelope", words::envelopes},
    {"axis.records.envelope", "rise", KeyForm::value, "until when it rises [s]"},
    {"axis.records.envelope", "level_end", KeyForm::value, "until when it is level [s]"},
    {"axis.records.envelope", "decay", KeyForm::value, "rate at which it decays [1/s]",
     of("shape", "jennings")},
    {"coordinate", "name", KeyForm::text, "of the coordinate"},
    {"coordinate", "value", KeyForm::value, "expression of the parameters of one axis"},
    {"coordinate", "unit", KeyForm::text, "of that value; not converted"},
    {"coordinate", "long_name", KeyForm::text, "for axes of figures"},
    {"output", "quantities", KeyForm::any,
     "\"standard\", \"all\", or names and patterns such as \"floor*_peak\"", of("kind", "sweep|transient")},
    {"output", "precision", KeyForm::choice, "digits that are kept", words::precisions,
     of("kind", "sweep|transient")},
    {"output", "path", KeyForm::choice, "how orbits are found", words::paths, of("kind", "sweep")},
    {"output", "borders", KeyForm::boolean, "solve where regimes change between points", of("kind", "sweep")},
    {"output", "branches", KeyForm::any, "true, or { along, at }: follow branches through folds",
     of("kind", "sweep")},
    {"output", "orbits", KeyForm::any, "points whose time histories are recorded", of("kind", "sweep")},
    {"output", "resonances", KeyForm::texts, "masses whose resonances along the frequency axis are solved",
     of("kind", "sweep")},
    {"output", "quantiles", KeyForm::values, "of samples, such as [0.05, 0.5, 0.95]",
     of("kind", "sweep|transient")},
    {"output", "histories", KeyForm::any, "of maps of motions: points whose histories are kept",
     of("kind", "transient")},
    {"output", "signal", KeyForm::tables, "a combination of coordinates that is reported as a mass is"},
    {"output.branches", "along", KeyForm::text,
     "the axis along which branches are followed; default: the innermost"},
    {"output.branches", "at", KeyForm::any, "of some rows alone: a list of { parameter = value }"},
    {"output.signal", "name", KeyForm::text, "of the signal"},
    {"output.signal", "along", KeyForm::names, "{ mass = factor, ... }"},
    {"orbits", "starts", KeyForm::integer, "searches from so many states at each point"},
    {"orbits", "most_multiple", KeyForm::integer, "longest period, in periods of the excitation"},
    {"orbits", "show", KeyForm::choice, "which response a map tells", words::responses},
    {"compare", "law", KeyForm::choice, "the other law of friction", words::compared_laws},
    {"compare", "slope", KeyForm::value, "of the arctan law [s/m]"},
    {"compare", "taylor_order", KeyForm::integer, "of every crank"},
    {"compare", "show", KeyForm::choice, "the other of several responses", words::responses},
    {"compare", "quantities", KeyForm::texts, "what is compared; default: peak of the first mass"},
    {"report", "quantities", KeyForm::any, "recorded ones to show"},
    {"report", "headline", KeyForm::text, "mass or element of the first table and picture"},
    {"report", "profile", KeyForm::any, "masses over the height, the lowest first", of("kind", "sweep")},
    {"report", "height", KeyForm::any, "of those masses [m]", of("kind", "sweep")},
    {"decay", "duration", KeyForm::value, "[s]; default: until rest"},
    {"decay", "samples", KeyForm::integer, "of the history; default none"},
    {"decay", "reference_frequency", KeyForm::value,
     "of loss factors [rad/s]; default: the lowest natural one"},
    {"transient", "duration", KeyForm::value, "[s]"},
    {"transient", "samples", KeyForm::integer, "of the history; default 1001"},
    {"transient", "sweep_to", KeyForm::value, "frequency at the end of a run-up [rad/s]"},
    {"transient", "sweep_rate", KeyForm::value, "of the frequency [rad/s2]"},
    {"initial", "node", KeyForm::text, "the mass"},
    {"initial", "displacement", KeyForm::value, "[m] at the start"},
    {"initial", "velocity", KeyForm::value, "[m/s] at the start"},
    {"tune", "objective", KeyForm::choice, "what is to be small", words::objectives},
    {"tune", "quantity", KeyForm::text, "what is made small, such as main_peak"},
    {"tune", "band", KeyForm::table, "frequencies over which it counts", of("", "band")},
    {"tune", "solver", KeyForm::choice, "of the optimisation", words::solvers},
    {"tune", "start", KeyForm::any, "where the search begins", words::starts_of_tunings},
    {"tune", "global", KeyForm::choice, "a search over the whole box first", words::global_searches,
     of("", "band")},
    {"tune", "tolerance", KeyForm::number, "of the optimum, relative"},
    {"tune", "weight", KeyForm::value, "multiplies the quantity, an expression of the band's parameter",
     of("", "band")},
    {"tune", "dominate", KeyForm::choice, "the schedule must be nowhere worse than the best constant",
     words::dominated, of("", "band")},
    {"tune", "trade_off", KeyForm::table, "limits of a second quantity, one optimum each", of("", "band")},
    {"tune", "noise", KeyForm::table, "of objective = \"variance\"", of("", "band")},
    {"tune", "quantile", KeyForm::number, "of samples: which quantile is made small"},
    {"tune", "records", KeyForm::any, "the records of a tuning over records", of("", "records")},
    {"tune", "duration", KeyForm::value, "of the motion under records [s]", of("", "records")},
    {"tune.band", "parameter", KeyForm::text, "on which the excitation frequency depends"},
    {"tune.band", "from", KeyForm::number, "lowest value"},
    {"tune.band", "to", KeyForm::number, "highest value"},
    {"tune.band", "unit", KeyForm::text, "of both"},
    {"tune.trade_off", "quantity", KeyForm::text, "the second quantity"},
    {"tune.trade_off", "values", KeyForm::values, "its limits"},
    {"tune.trade_off", "unit", KeyForm::text, "of the limits"},
    {"tune.noise", "force_on", KeyForm::text, "the mass under the random force"},
    {"tune.noise", "acceleration_of", KeyForm::text, "the support under the random acceleration"},
    {"tune.noise", "intensity", KeyForm::number, "two-sided spectral density S0"},
    {"design", "parameter", KeyForm::text, "the one that may change"},
    {"design", "lower", KeyForm::number, "its lower bound"},
    {"design", "upper", KeyForm::number, "its upper bound"},
    {"design", "unit", KeyForm::text, "of the bounds"},
    {"design", "schedule", KeyForm::table, "it is a function of the band's parameter"},
    {"design", "rule", KeyForm::value, "an expression it is known to follow, to compare with"},
    {"design.schedule", "knots", KeyForm::any, "number of its knots, or where they are"},
    {"design.schedule", "max_slope", KeyForm::number, "bound of its slope"},
    {"design.schedule", "jumps", KeyForm::integer, "1: it may leap once"},
    {"constraint", "quantity", KeyForm::text, "which is limited"},
    {"constraint", "lower", KeyForm::number, "its lower limit"},
    {"constraint", "upper", KeyForm::number, "its upper limit"},
    {"constraint", "unit", KeyForm::text, "of the limits"},
    {"constraint", "band", KeyForm::table, "where the limit holds; default: the band of [tune]"},
    {"constraint.band", "from", KeyForm::number, "lowest value"},
    {"constraint.band", "to", KeyForm::number, "highest value"},
    {"scenario", "name", KeyForm::text, "of the scenario"},
    {"scenario", "set", KeyForm::names, "{ parameter = value }"},
    {"column", "name", KeyForm::text, "of the column"},
    {"column", "value", KeyForm::value, "an expression of design parameters"},
    {"column", "unit", KeyForm::text, "of the value"},
    {"column", "lower", KeyForm::number, "its lower limit"},
    {"column", "upper", KeyForm::number, "its upper limit"},
    {"identify", "method", KeyForm::choice, "how estimates are found", words::methods},
    {"identify", "start", KeyForm::choice, "where a grey box starts", words::starts_of_fits,
     of("method", "grey_box")},
    {"identify", "fixed_from", KeyForm::any,
     "results of earlier identifications whose estimates are taken over", of("method", "grey_box")},
    {"identify", "curve", KeyForm::choice, "what excited a response curve", words::curves,
     of("method", "half_power|resonance_magnification|forced_resonance")},
    {"identify", "cycles", KeyForm::integer, "of a logarithmic decrement", of("method", "log_decrement")},
    {"identify", "sensor_offset", KeyForm::boolean, "the sensor's zero is estimated too",
     of("method", "free_decay")},
    {"identify", "mass", KeyForm::value, "known mass [kg]", of("method", "free_decay|forced_resonance")},
    {"identify", "stiffness", KeyForm::value, "known stiffness [N/m]",
     of("method", "free_decay|forced_resonance")},
    {"identify", "reference_frequency", KeyForm::value, "of hysteretic elements [rad/s]",
     of("method", "grey_box")},
    {"identify", "record", KeyForm::tables, "a measurement"},
    {"identify", "parameter", KeyForm::tables, "a parameter to estimate"},
    {"identify.record", "name", KeyForm::text, "of the record"},
    {"identify.record", "file", KeyForm::text, "CSV or HDF5, from the folder of the study"},
    {"identify.record", "columns", KeyForm::names, "quantity = column, by number or heading"},
    {"identify.record", "units", KeyForm::names, "quantity = unit, where the file does not tell"},
    {"identify.record", "set", KeyForm::names, "{ parameter = value } of this record",
     of("method", "grey_box")},
    {"identify.record", "motion", KeyForm::choice, "of a grey box: what the record is", words::motions,
     of("method", "grey_box")},
    {"identify.record", "added_mass", KeyForm::value, "[kg] that was added", of("method", "added_mass")},
    {"identify.record", "static_displacement", KeyForm::value, "under the static force [m]",
     of("method", "resonance_magnification")},
    {"identify.parameter", "parameter", KeyForm::text, "the one to estimate"},
    {"identify.parameter", "lower", KeyForm::number, "its lower bound", of("method", "grey_box")},
    {"identify.parameter", "upper", KeyForm::number, "its upper bound", of("method", "grey_box")},
    {"identify.parameter", "unit", KeyForm::text, "of the bounds"},
    {"identify.parameter", "each_record", KeyForm::boolean, "it has a value of its own in every record",
     of("method", "grey_box")},
    {"identify.parameter", "estimate", KeyForm::text, "of a formula: the estimate that it takes"},
    {"{ value, unit }", "value", KeyForm::number, "the number"},
    {"{ value, unit }", "unit", KeyForm::text,
     "its unit, as UDUNITS writes it: \"kN/m\", \"rpm\", \"degree\""},
    {"{ table, of }", "table", KeyForm::text,
     "CSV file of two columns, between whose rows a parameter is interpolated"},
    {"{ table, of }", "of", KeyForm::text, "the parameter that its first column has values of"},
};

bool is_one_of(std::string_view word, std::string_view words) {
  const std::vector<std::string> all = separated(words);
  return std::ranges::find(all, word) != all.end();
}

}  // namespace

std::span<const StudyKey> study_keys() {
  return all_keys;
}

std::vector<std::string> separated(std::string_view forms) {
  std::vector<std::string> all;
  std::istringstream text{std::string(forms)};
  for (std::string form; std::getline(text, form, '|');) all.push_back(form);
  return all;
}

bool has(const StudyKey& key, std::string_view form) {
  return form.empty() || *key.owners.of == '\0' || is_one_of(form, key.owners.of);
}

const StudyKey& study_key(std::string_view section, std::string_view key) {
  const auto* const row = std::ranges::find_if(
      all_keys, [&](const StudyKey& each) { return each.section == section && each.key == key; });
  if (row == std::end(all_keys))
    throw std::logic_error(fmt::format("study_keys has no key \"{}\" of \"{}\"", key, section));
  return *row;
}

std::vector<std::string> keys_of(std::string_view section, std::string_view form) {
  std::vector<std::string> keys;
  for (const StudyKey& each : all_keys) {
    if (each.section == section && has(each, form)) keys.emplace_back(each.key);
  }
  return keys;
}

std::vector<std::string> words_of(const StudyKey& key, std::string_view form) {
  if (key.form == KeyForm::element_type) return element_types();
  std::vector<std::string> words;
  for (const StudyWord& each : key.words) {
    if (form.empty() || *each.of == '\0' || is_one_of(form, each.of)) words.emplace_back(each.word);
  }
  return words;
}

std::string written_section(const std::string& path) {
  if (path.starts_with('{')) return path;
  const std::size_t dot = path.rfind('.');
  const std::string parent = dot == std::string::npos ? "" : path.substr(0, dot);
  const std::string key = dot == std::string::npos ? path : path.substr(dot + 1);
  const auto* const row = std::ranges::find_if(
      all_keys, [&](const StudyKey& each) { return each.section == parent && each.key == key; });
  const bool is_list = row != std::end(all_keys) && row->form == KeyForm::tables;
  return is_list ? "[[" + path + "]]" : "[" + path + "]";
}

}  // namespace frahm::studies
