#include "studies/reading/study_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "solvers/flow/sizes.hpp"
#include "studies/reading/axis_reading.hpp"
#include "studies/reading/element_keys.hpp"
#include "studies/reading/study_words.hpp"

namespace frahm::studies {
namespace {

// The forms of a section that have a key, by the key that decides it.
constexpr KeyOwners of(const char* decider, const char* forms) {
  return {decider, forms};
}

constexpr Limits from(double least, double most = std::numeric_limits<double>::infinity()) {
  return {.least = least, .most = most};
}
constexpr Limits between(double least, double most) {
  return {.least = least, .most = most, .above = true, .below = true};
}
constexpr Limits from_or(double least, double most, double another) {
  return {.least = least, .most = most, .or_another = true, .another = another};
}

constexpr Needed needed{.always = true};
constexpr Needed needed_of(const char* decider, const char* forms) {
  return {.of = {decider, forms}};
}

constexpr const char* formulas =
    "half_power|resonance_magnification|log_decrement|free_decay|forced_resonance|energy_balance|"
    "hysteresis_loop|added_mass";

constexpr double most_contacts = periodic::kMostContacts;
constexpr double highest_order = 1000;  // events are searched on samples of the highest one over a period
constexpr double most_records = 1'000'000;
constexpr double most_samples = 10'000'000;  // of a history: some hundred megabytes
constexpr double longest_multiple = 64;      // the motions are followed for 324 periods and more
constexpr double largest_tolerance = 0.1;    // of the certificate: above it nothing is certified
constexpr double least_quantile = 1e-6;      // rarer than any sample here can tell

constexpr StudyKey all_keys[] = {
    {"", "study", KeyForm::table, "what kind of study it is", needed},
    {"", "parameters", KeyForm::settings,
     "numbers with names: value, { value, unit }, an expression of others, or { table = \"file.csv\", of = "
     "\"other\" }",
     Inside{KeyForm::parameter}, Length{0}},
    {"", "mass", KeyForm::tables, "a mass, or a moment of inertia that turns"},
    {"", "matrices", KeyForm::tables, "a part of the system given by its matrices"},
    {"", "element", KeyForm::tables, "a spring, damper, inerter, friction or another element"},
    {"", "damping", KeyForm::table, "of the structure as a whole, beside dampers"},
    {"", "excitation", KeyForm::table, "what drives the system, and how fast",
     of("kind", "sweep|transient|tune|identify"), needed_of("kind", "sweep|transient|tune")},
    {"", "axis", KeyForm::tables, "a parameter that varies over the map; the outermost axis first",
     of("kind", "sweep|transient|tune"), needed_of("kind", "sweep")},
    {"", "coordinate", KeyForm::tables, "a derived coordinate beside an axis", of("kind", "sweep|transient")},
    {"", "output", KeyForm::table, "what is recorded of each point; of what is no map the signals",
     of("kind", "sweep|transient|tune|decay")},
    {"", "orbits", KeyForm::table, "the search, where a system has several responses",
     of("kind", "sweep|tune")},
    {"", "compare", KeyForm::table, "the same map under another law or profile", of("kind", "sweep")},
    {"", "report", KeyForm::table, "what the page of frahm report shows", of("kind", "sweep|transient")},
    {"", "decay", KeyForm::table, "free vibration from initial values", of("kind", "decay")},
    {"", "transient", KeyForm::table, "forced motion from initial values", of("kind", "transient"),
     needed_of("kind", "transient")},
    {"", "initial", KeyForm::tables, "initial values of a mass; 0 where none are given",
     of("kind", "decay|transient|identify"), needed_of("kind", "decay")},
    {"", "tune", KeyForm::table, "what is to be as small as possible", of("kind", "tune"),
     needed_of("kind", "tune")},
    {"", "design", KeyForm::tables, "a parameter that a tuning may change", of("kind", "tune"),
     needed_of("kind", "tune")},
    {"", "constraint", KeyForm::tables, "a limit that an optimum must hold", of("kind", "tune")},
    {"", "scenario", KeyForm::tables, "other values of parameters, for which an optimum must be good too",
     of("kind", "tune")},
    {"", "column", KeyForm::tables, "a number that is told beside the optimum, or limited",
     of("kind", "tune")},
    {"", "identify", KeyForm::table, "how a model is found from measurements", of("kind", "identify"),
     needed_of("kind", "identify")},
    {"study", "schema", KeyForm::integer, "version of this form of study file: 1", needed, from(1, 1)},
    {"study", "kind", KeyForm::choice, "what is computed", words::kinds, needed},
    {"study", "title", KeyForm::text, "stands in the result and on its page"},
    {"study", "units", KeyForm::choice, "of its values", words::units},
    {"mass", "name", KeyForm::name, "by which elements, excitations and quantities call it", needed},
    {"mass", "mass", KeyForm::value, "mass [kg], >= 0", not_negative},
    {"mass", "inertia", KeyForm::value, "moment of inertia [kg m2]; its displacement is an angle [rad]",
     not_negative},
    {"matrices", "name", KeyForm::name, "of the part", needed},
    {"matrices", "names", KeyForm::names, "of its degrees of freedom, in the order of the rows", needed},
    {"matrices", "mass", KeyForm::text, "file of its mass matrix: .mtx, .csv or file.h5:/path", needed},
    {"matrices", "stiffness", KeyForm::text, "file of its stiffness matrix: .mtx, .csv or file.h5:/path",
     needed},
    {"matrices", "damping", KeyForm::text, "file of its damping matrix: .mtx, .csv or file.h5:/path"},
    {"element", "name", KeyForm::name, "by which quantities call it", needed},
    {"element", "type", KeyForm::element_type, "kind of element", needed},
    {"element", "between", KeyForm::names,
     "the two nodes between which it acts: masses, supports or \"ground\"", Length{2, 2}},
    {"element", "along", KeyForm::settings,
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
    {"element", "table", KeyForm::pairs, "a characteristic given by points: [[-1, -5], [1, 5]]", Length{2}},
    {"element", "clearance", KeyForm::value, "of a gap [m]: how far it moves before it touches",
     Or{KeyForm::values}, Length{2, 2}, not_negative},
    {"element", "tension", KeyForm::boolean, "of a gap: it acts when pulled rather than when pressed"},
    {"element", "stiffnesses", KeyForm::values, "of an iwan element: of each of its sliders [N/m]"},
    {"element", "forces", KeyForm::values, "of an iwan element: at which each of its sliders gives way [N]"},
    {"element", "distribution", KeyForm::choice, "of an iwan element: how its sliders are spread",
     words::slider_distributions},
    {"element", "elements", KeyForm::integer, "of an iwan element: number of sliders",
     from(1, most_contacts)},
    {"element", "chi", KeyForm::number, "of an iwan element: exponent of the power distribution",
     Limits{.least = -1.0, .most = 100.0, .above = true}},
    {"damping", "modal", KeyForm::value,
     "ratio of all modes, or a list in ascending frequency, the last one of all higher modes too",
     Or{KeyForm::values}, not_negative},
    {"damping", "rayleigh", KeyForm::values, "[a, b]: C = a M + b K, in 1/s and s", Length{2, 2},
     not_negative},
    {"excitation", "frequency", KeyForm::value,
     "fundamental angular frequency [rad/s]; rpm and Hz count turns", needed_of("kind", "sweep"), positive},
    {"excitation", "reference_order", KeyForm::integer,
     "the order of which phases are taken; default: the lowest", from(1, highest_order)},
    {"excitation", "force", KeyForm::tables, "a harmonic force on a mass"},
    {"excitation", "motion", KeyForm::tables, "a harmonic motion of a support"},
    {"excitation", "record", KeyForm::tables, "a measured force or motion of a support",
     of("kind", "transient|tune")},
    {"excitation.force", "on", KeyForm::name, "the mass it acts on"},
    {"excitation.force", "node", KeyForm::name, "the same as on"},
    {"excitation.force", "amplitude", KeyForm::value,
     "[N], on what turns [N m]: amplitude cos(order omega t + phase)", needed},
    {"excitation.force", "order", KeyForm::integer, "multiple of the frequency, default 1; 0 is a constant",
     from(0, highest_order)},
    {"excitation.force", "phase", KeyForm::value, "[rad], default 0"},
    {"excitation.force", "profile", KeyForm::choice, "default harmonic", words::harmonic},
    {"excitation.motion", "node", KeyForm::name, "name of the support, a node without mass", needed},
    {"excitation.motion", "profile", KeyForm::choice, "of its motion, default harmonic", words::profiles},
    {"excitation.motion", "amplitude", KeyForm::value, "of its displacement [m]", of("profile", "harmonic")},
    {"excitation.motion", "velocity", KeyForm::value, "amplitude of its velocity [m/s]; with order 0 a belt",
     of("profile", "harmonic")},
    {"excitation.motion", "acceleration", KeyForm::value, "amplitude of its acceleration [m/s2]",
     of("profile", "harmonic")},
    {"excitation.motion", "order", KeyForm::integer, "multiple of the frequency, default 1",
     of("profile", "harmonic"), from(0, highest_order)},
    {"excitation.motion", "phase", KeyForm::value, "[rad], default 0"},
    {"excitation.motion", "crank", KeyForm::value, "radius of a crank [m]", of("profile", "crank"), needed,
     not_negative},
    {"excitation.motion", "rod", KeyForm::value, "length of a crank's rod [m], longer than the crank",
     of("profile", "crank"), needed, positive},
    {"excitation.motion", "taylor_order", KeyForm::integer,
     "1, 2 or 4: the crank's motion cut there; left out: exact", of("profile", "crank"), from_or(1, 2, 4)},
    {"excitation.record", "acceleration_of", KeyForm::name, "the support whose motion was measured so"},
    {"excitation.record", "velocity_of", KeyForm::name, "the support whose motion was measured so"},
    {"excitation.record", "displacement_of", KeyForm::name, "the support whose motion was measured so"},
    {"excitation.record", "force_on", KeyForm::name, "the mass on which the measured force acts"},
    {"excitation.record", "file", KeyForm::text, "CSV or HDF5, from the folder of the study"},
    {"excitation.record", "time", KeyForm::column, "column of the time, by heading or number; default 1",
     from(1)},
    {"excitation.record", "column", KeyForm::column, "column of the values; default 2", from(1)},
    {"excitation.record", "unit", KeyForm::text,
     "of the values, where the file does not tell; g of accelerations is gravity"},
    {"excitation.record", "interpolation", KeyForm::choice, "between samples of a displacement",
     words::interpolations},
    {"excitation.record", "scale", KeyForm::value, "multiplies the values, default 1"},
    {"excitation.record", "from", KeyForm::plain_value, "start of a window in the record's own time [s]"},
    {"excitation.record", "to", KeyForm::plain_value, "end of that window [s]"},
    {"axis", "parameter", KeyForm::name, "the one that varies", of("", "numbers"), needed},
    {"axis", "unit", KeyForm::text, "of from, to and values", of("", "numbers")},
    {"axis", "from", KeyForm::number, "first value; or a CSV file of samples", of("", "numbers|file"),
     Or{KeyForm::text}},
    {"axis", "to", KeyForm::number, "last value", of("", "numbers")},
    {"axis", "points", KeyForm::integer,
     "number of values, \"from\" and \"to\" included; one alone is values = [...]", of("", "numbers"),
     from(2, most_axis_points)},
    {"axis", "spacing", KeyForm::choice, "of the steps from one value to the next", words::spacings,
     of("", "numbers")},
    {"axis", "values", KeyForm::numbers, "a list of values in place of from, to and points",
     of("", "numbers")},
    {"axis", "zip", KeyForm::name, "axes of the same zip advance together", of("", "numbers|samples|file")},
    {"axis", "samples", KeyForm::integer, "number of samples of uncertain parameters", of("", "samples"),
     needed, from(2, most_axis_points)},
    {"axis", "sequence", KeyForm::choice, "how samples are drawn", words::sequences, of("", "samples")},
    {"axis", "seed", KeyForm::integer, "of the samples", of("", "samples"), not_negative},
    {"axis", "of", KeyForm::tables, "a parameter that is uncertain, with its distribution",
     of("", "samples")},
    {"axis", "fixed_from", KeyForm::text, "result of an identification, whose estimates are sampled",
     of("", "samples")},
    {"axis", "parameters", KeyForm::names, "of its estimates, those to sample", of("", "samples")},
    {"axis", "records", KeyForm::texts, "files of records, or { generate = ... }", of("", "records"),
     Or{KeyForm::table}},
    {"axis.of", "parameter", KeyForm::name, "the uncertain parameter", needed},
    {"axis.of", "unit", KeyForm::text, "of its distribution's numbers"},
    {"axis.of", "distribution", KeyForm::choice, "of its values", words::distributions, needed},
    {"axis.of", "mean", KeyForm::number, "mean of a normal or lognormal distribution",
     of("distribution", "normal|lognormal"), needed_of("distribution", "normal")},
    {"axis.of", "median", KeyForm::number, "of a lognormal distribution", of("distribution", "lognormal"),
     positive},
    {"axis.of", "mode", KeyForm::number, "likeliest value of a triangular one",
     of("distribution", "triangular"), needed},
    {"axis.of", "deviation", KeyForm::number, "standard deviation", of("distribution", "normal|lognormal"),
     positive},
    {"axis.of", "variation", KeyForm::number, "standard deviation over the mean",
     of("distribution", "normal|lognormal"), positive},
    {"axis.of", "lower", KeyForm::number, "least value; cuts a normal one off",
     needed_of("distribution", "uniform|triangular")},
    {"axis.of", "upper", KeyForm::number, "largest value; cuts a normal one off",
     needed_of("distribution", "uniform|triangular")},
    {"axis.records", "generate", KeyForm::choice, "random records of this kind", words::generators, needed},
    {"axis.records", "count", KeyForm::integer, "number of records", needed, from(1, most_records)},
    {"axis.records", "seed", KeyForm::integer, "of the random numbers", not_negative},
    {"axis.records", "duration", KeyForm::plain_value, "of each record [s]", needed, positive},
    {"axis.records", "rate", KeyForm::number, "samples a second", needed, positive},
    {"axis.records", "intensity", KeyForm::number, "two-sided spectral density S0", needed, positive},
    {"axis.records", "ground_frequency", KeyForm::plain_value, "of the soil [rad/s]",
     of("generate", "kanai_tajimi"), needed, positive},
    {"axis.records", "ground_damping", KeyForm::number, "ratio of the soil", of("generate", "kanai_tajimi"),
     needed, positive},
    {"axis.records", "corner_frequency", KeyForm::plain_value,
     "below which the ground's motion is bounded [rad/s]", of("generate", "kanai_tajimi"), positive},
    {"axis.records", "corner_damping", KeyForm::number, "ratio at the corner", of("generate", "kanai_tajimi"),
     positive},
    {"axis.records", "envelope", KeyForm::table, "how the strength of the record rises and falls",
     of("generate", "kanai_tajimi")},
    {"axis.records.envelope", "shape", KeyForm::choice, "of the envelope", words::envelopes, needed},
    {"axis.records.envelope", "rise", KeyForm::plain_value, "until when it rises [s]", needed, positive},
    {"axis.records.envelope", "level_end", KeyForm::plain_value, "until when it is level [s]", needed,
     positive},
    {"axis.records.envelope", "decay", KeyForm::plain_value, "rate at which it decays [1/s]",
     of("shape", "jennings"), needed, positive},
    {"coordinate", "name", KeyForm::name, "of the coordinate", needed},
    {"coordinate", "value", KeyForm::text, "expression of the parameters of one axis", needed},
    {"coordinate", "unit", KeyForm::text, "of that value; not converted"},
    {"coordinate", "long_name", KeyForm::text, "for axes of figures"},
    {"output", "quantities", KeyForm::choice,
     "\"standard\", \"all\", or names and patterns such as \"floor*_peak\"", of("kind", "sweep|transient"),
     words::sets_of_quantities, Or{KeyForm::patterns}},
    {"output", "precision", KeyForm::choice, "digits that are kept", words::precisions,
     of("kind", "sweep|transient")},
    {"output", "path", KeyForm::choice, "how orbits are found", words::paths, of("kind", "sweep")},
    {"output", "borders", KeyForm::boolean, "solve where regimes change between points", of("kind", "sweep")},
    {"output", "branches", KeyForm::boolean, "true, or { along, at }: follow branches through folds",
     of("kind", "sweep"), Or{KeyForm::table}},
    {"output", "orbits", KeyForm::list_of_settings, "points whose time histories are recorded",
     of("kind", "sweep"), Inside{KeyForm::plain_value}, Length{0}},
    {"output", "resonances", KeyForm::names, "masses whose resonances along the frequency axis are solved",
     of("kind", "sweep"), Length{0}},
    {"output", "quantiles", KeyForm::numbers, "of samples, such as [0.05, 0.5, 0.95]",
     of("kind", "sweep|transient"), from(least_quantile, 1.0 - least_quantile)},
    {"output", "histories", KeyForm::list_of_settings, "of maps of motions: points whose histories are kept",
     of("kind", "transient"), Inside{KeyForm::plain_value}, Length{0}},
    {"output", "signal", KeyForm::tables, "a combination of coordinates that is reported as a mass is",
     needed_of("kind", "decay|tune")},
    {"output.branches", "along", KeyForm::name,
     "the axis along which branches are followed; default: the innermost"},
    {"output.branches", "at", KeyForm::list_of_settings,
     "of some rows alone: a list of { parameter = value }", Inside{KeyForm::plain_value}},
    {"output.signal", "name", KeyForm::name, "of the signal", needed},
    {"output.signal", "along", KeyForm::settings, "{ mass = factor, ... }", needed},
    {"orbits", "starts", KeyForm::integer, "searches from so many states at each point", from(1, 10'000)},
    {"orbits", "most_multiple", KeyForm::integer, "longest period, in periods of the excitation",
     from(1, longest_multiple)},
    {"orbits", "show", KeyForm::choice, "which response a map tells", words::responses, of("kind", "sweep")},
    {"compare", "law", KeyForm::choice, "the other law of friction", words::compared_laws},
    {"compare", "slope", KeyForm::value, "of the arctan law [s/m]", positive, of("law", "arctan"),
     needed_of("law", "arctan")},
    {"compare", "taylor_order", KeyForm::integer, "of every crank", from_or(1, 2, 4)},
    {"compare", "show", KeyForm::choice, "the other of several responses", words::responses},
    {"compare", "quantities", KeyForm::patterns, "what is compared; default: peak of the first mass"},
    {"report", "quantities", KeyForm::patterns, "recorded ones to show"},
    {"report", "headline", KeyForm::name, "mass or element of the first table and picture"},
    {"report", "profile", KeyForm::text, "masses over the height, the lowest first", of("kind", "sweep"),
     Or{KeyForm::names}, Length{2}},
    {"report", "height", KeyForm::number, "of those masses [m]", of("kind", "sweep"), Or{KeyForm::numbers},
     Length{2}},
    {"decay", "duration", KeyForm::value, "[s]; default: until rest", positive},
    {"decay", "samples", KeyForm::integer, "of the history; default none", from_or(2, most_samples, 0)},
    {"decay", "reference_frequency", KeyForm::value,
     "of loss factors [rad/s]; default: the lowest natural one", positive},
    {"transient", "duration", KeyForm::value, "[s]", positive},
    {"transient", "samples", KeyForm::integer, "of the history; default 1001", from(2, most_samples)},
    {"transient", "sweep_to", KeyForm::value, "frequency at the end of a run-up [rad/s]", positive},
    {"transient", "sweep_rate", KeyForm::value, "of the frequency [rad/s2]", positive},
    {"initial", "node", KeyForm::name, "the mass", needed},
    {"initial", "displacement", KeyForm::value, "[m] at the start"},
    {"initial", "velocity", KeyForm::value, "[m/s] at the start"},
    {"tune", "objective", KeyForm::choice, "what is to be small", words::objectives, needed},
    {"tune", "quantity", KeyForm::name, "what is made small, such as main_peak", needed},
    {"tune", "band", KeyForm::table, "frequencies over which it counts", of("", "band")},
    {"tune", "solver", KeyForm::choice, "of the optimisation", words::solvers},
    {"tune", "start", KeyForm::choice, "where the search begins", words::starts_of_tunings,
     Or{KeyForm::integer}, from(1, 100'000)},
    {"tune", "global", KeyForm::choice, "a search over the whole box first", words::global_searches,
     of("", "band")},
    {"tune", "tolerance", KeyForm::number, "of the optimum, relative", between(0.0, largest_tolerance)},
    {"tune", "weight", KeyForm::text, "multiplies the quantity, an expression of the band's parameter",
     of("", "band")},
    {"tune", "dominate", KeyForm::choice, "the schedule must be nowhere worse than the best constant",
     words::dominated, of("", "band")},
    {"tune", "trade_off", KeyForm::table, "limits of a second quantity, one optimum each", of("", "band")},
    {"tune", "noise", KeyForm::table, "of objective = \"variance\"", of("", "band"),
     needed_of("objective", "variance")},
    {"tune", "quantile", KeyForm::number, "of samples: which quantile is made small", between(0.0, 1.0)},
    {"tune", "records", KeyForm::texts, "the records of a tuning over records", of("", "records"),
     Or{KeyForm::table, "axis.records"}},
    {"tune", "duration", KeyForm::number, "of the motion under records [s]", of("", "records"), positive},
    {"tune.band", "parameter", KeyForm::name, "on which the excitation frequency depends", needed},
    {"tune.band", "from", KeyForm::number, "lowest value", needed},
    {"tune.band", "to", KeyForm::number, "highest value", needed},
    {"tune.band", "unit", KeyForm::text, "of both"},
    {"tune.trade_off", "quantity", KeyForm::name, "the second quantity", needed},
    {"tune.trade_off", "values", KeyForm::numbers, "its limits", needed},
    {"tune.trade_off", "unit", KeyForm::text, "of the limits"},
    {"tune.noise", "force_on", KeyForm::name, "the mass under the random force"},
    {"tune.noise", "acceleration_of", KeyForm::name, "the support under the random acceleration"},
    {"tune.noise", "intensity", KeyForm::number, "two-sided spectral density S0", positive},
    {"design", "parameter", KeyForm::name, "the one that may change", needed},
    {"design", "lower", KeyForm::number, "its lower bound", needed},
    {"design", "upper", KeyForm::number, "its upper bound", needed},
    {"design", "unit", KeyForm::text, "of the bounds"},
    {"design", "schedule", KeyForm::table, "it is a function of the band's parameter"},
    {"design", "rule", KeyForm::text, "an expression it is known to follow, to compare with"},
    {"design.schedule", "knots", KeyForm::integer, "number of its knots, or where they are",
     Or{KeyForm::numbers}, Length{2}, needed, from(2, 10'000)},
    {"design.schedule", "max_slope", KeyForm::number, "bound of its slope", positive},
    {"design.schedule", "jumps", KeyForm::integer, "1: it may leap once", from(0, 1)},
    {"constraint", "quantity", KeyForm::name, "which is limited", needed},
    {"constraint", "lower", KeyForm::number, "its lower limit"},
    {"constraint", "upper", KeyForm::number, "its upper limit"},
    {"constraint", "unit", KeyForm::text, "of the limits"},
    {"constraint", "band", KeyForm::table, "where the limit holds; default: the band of [tune]"},
    {"constraint.band", "from", KeyForm::number, "lowest value", needed},
    {"constraint.band", "to", KeyForm::number, "highest value", needed},
    {"constraint.band", "unit", KeyForm::text, "of both; default: that of the band of [tune]"},
    {"scenario", "name", KeyForm::name, "of the scenario", needed},
    {"scenario", "set", KeyForm::settings, "{ parameter = value }", Inside{KeyForm::plain_value}, Length{0},
     needed},
    {"column", "name", KeyForm::name, "of the column", needed},
    {"column", "value", KeyForm::text, "an expression of design parameters", needed},
    {"column", "unit", KeyForm::text, "of the value"},
    {"column", "lower", KeyForm::number, "its lower limit"},
    {"column", "upper", KeyForm::number, "its upper limit"},
    {"identify", "method", KeyForm::choice, "how estimates are found", words::methods, needed},
    {"identify", "start", KeyForm::choice, "where a grey box starts", words::starts_of_fits,
     of("method", "grey_box")},
    {"identify", "fixed_from", KeyForm::text,
     "results of earlier identifications whose estimates are taken over", of("method", "grey_box"),
     Or{KeyForm::texts}},
    {"identify", "curve", KeyForm::choice, "what excited a response curve", words::curves,
     of("method", "half_power|resonance_magnification|forced_resonance")},
    {"identify", "cycles", KeyForm::integer, "of a logarithmic decrement", of("method", "log_decrement"),
     from(1, 1'000'000)},
    {"identify", "sensor_offset", KeyForm::boolean, "the sensor's zero is estimated too",
     of("method", "free_decay")},
    {"identify", "mass", KeyForm::value, "known mass [kg]", of("method", "free_decay|forced_resonance"),
     positive},
    {"identify", "stiffness", KeyForm::value, "known stiffness [N/m]",
     of("method", "free_decay|forced_resonance"), positive},
    {"identify", "reference_frequency", KeyForm::value, "of hysteretic elements [rad/s]",
     of("method", "grey_box"), positive},
    {"identify", "record", KeyForm::tables, "a measurement", needed},
    {"identify", "parameter", KeyForm::tables, "a parameter to estimate", needed_of("method", "grey_box")},
    {"identify.record", "name", KeyForm::name, "of the record"},
    {"identify.record", "file", KeyForm::text, "CSV or HDF5, from the folder of the study", needed},
    {"identify.record", "columns", KeyForm::settings, "quantity = column, by number or heading",
     Inside{KeyForm::column}, from(1)},
    {"identify.record", "units", KeyForm::settings, "quantity = unit, where the file does not tell",
     Inside{KeyForm::text}, Length{0}},
    {"identify.record", "set", KeyForm::settings, "{ parameter = value } of this record",
     of("method", "grey_box"), Inside{KeyForm::plain_value}, Length{0}},
    {"identify.record", "motion", KeyForm::choice, "of a grey box: what the record is", words::motions,
     of("method", "grey_box")},
    {"identify.record", "interpolation", KeyForm::choice,
     "between samples of a support's measured displacement", words::interpolations, of("method", "grey_box")},
    {"identify.record", "added_mass", KeyForm::value, "[kg] that was added", of("method", "added_mass"),
     not_negative},
    {"identify.record", "static_displacement", KeyForm::value, "under the static force [m]",
     of("method", "resonance_magnification"), positive},
    {"identify.parameter", "parameter", KeyForm::name, "the one to estimate", needed},
    {"identify.parameter", "lower", KeyForm::number, "its lower bound", of("method", "grey_box")},
    {"identify.parameter", "upper", KeyForm::number, "its upper bound", of("method", "grey_box")},
    {"identify.parameter", "unit", KeyForm::text, "of the bounds"},
    {"identify.parameter", "each_record", KeyForm::boolean, "it has a value of its own in every record",
     of("method", "grey_box")},
    {"identify.parameter", "estimate", KeyForm::name, "of a formula: the estimate that it takes",
     of("method", formulas), needed},
    {"{ value, unit }", "value", KeyForm::number, "the number", needed},
    {"{ value, unit }", "unit", KeyForm::text,
     "its unit, as UDUNITS writes it: \"kN/m\", \"rpm\", \"degree\""},
    {"{ table, of }", "table", KeyForm::text,
     "CSV file of two columns, between whose rows a parameter is interpolated", needed},
    {"{ table, of }", "of", KeyForm::name, "the parameter that its first column has values of", needed},
};

}  // namespace

std::span<const StudyKey> study_keys() {
  return all_keys;
}

bool has_by(const KeyOwners& owners, std::string_view decider, std::string_view form) {
  return *owners.of != '\0' && owners.decider == decider && is_one_of(form, owners.of);
}

std::vector<std::string> separated(std::string_view forms) {
  std::vector<std::string> all;
  std::istringstream text{std::string(forms)};
  for (std::string form; std::getline(text, form, '|');) all.push_back(form);
  return all;
}

bool is_one_of(std::string_view word, std::string_view words) {
  const std::vector<std::string> all = separated(words);
  return std::ranges::find(all, word) != all.end();
}

bool Limits::hold(double number) const {
  if (or_another && number == another) return true;
  return (above ? number > least : number >= least) && (below ? number < most : number <= most);
}

std::string Limits::told(std::string_view kind) const {
  if (least == most) return fmt::format("only {}", least);
  const bool has_end = most < std::numeric_limits<double>::infinity();
  const std::string range = !has_end         ? fmt::format("{} {}", above ? ">" : ">=", least)
                            : above || below ? fmt::format("{} {} and {} {}", above ? "above" : "at least",
                                                           least, below ? "below" : "at most", most)
                                             : fmt::format("from {} to {}", least, most);
  return fmt::format("{}{}{}", kind, range, or_another ? fmt::format(", or {}", another) : "");
}

bool has(const StudyKey& key, std::string_view form) {
  return form.empty() || *key.owners.of == '\0' || is_one_of(form, key.owners.of);
}

bool needs(const StudyKey& key, std::string_view form) {
  if (key.need.always) return *key.owners.of == '\0' || (!form.empty() && has(key, form));
  return *key.need.of.of != '\0' && is_one_of(form, key.need.of.of);
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
