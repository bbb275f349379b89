#include "studies/reading/keys/study_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <stdexcept>

#include "solvers/flow/sizes.hpp"
#include "solvers/orbits/orbits_wanted.hpp"
#include "studies/reading/keys/element_keys.hpp"
#include "studies/reading/keys/study_words.hpp"

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

// The methods of identification but the last, the grey box: "half_power|resonance_magnification|...".
constexpr auto formulas = [] {
  std::array<char, 256> text{};
  char* end = text.data();
  for (const StudyWord& method : std::span(words::methods).first(std::size(words::methods) - 1)) {
    if (end != text.data()) *end++ = '|';
    end = std::ranges::copy(std::string_view(method.word), end).out;
  }
  return text;
}();

constexpr double most_contacts = periodic::kMostContacts;
constexpr double highest_order = 1000;  // events are searched on samples of the highest one over a period
constexpr double most_orders = 200;     // of an excitation, as in excitation_reading.cpp
constexpr double orders_of_corners =
    40;  // of corners with a period: 2e-5 of a triangle's amplitude are left out
constexpr double most_axis_points = 1'000'000;
constexpr double most_records = 1'000'000;
constexpr double most_samples = 10'000'000;      // of a history: some hundred megabytes
constexpr double samples_of_a_transient = 1001;  // smooth to the eye over dozens of periods
constexpr double longest_multiple = 64;          // the motions are followed for 324 periods and more
constexpr double largest_tolerance = 0.1;        // of the certificate: above it nothing is certified
constexpr double least_quantile = 1e-6;          // rarer than any sample here can tell

constexpr StudyKey all_keys[] = {
    {"", "study", KeyForm::table, Use::nowhere, "what kind of study it is", needed},
    {"", "parameters", KeyForm::settings, Use::physics,
     "numbers with names: value, { value, unit }, an expression of others, or { table = \"file.csv\", of = "
     "\"other\" }",
     Inside{KeyForm::parameter}, Length{0}},
    {"", "mass", KeyForm::tables, Use::nowhere, "a mass, or a moment of inertia that turns"},
    {"", "matrices", KeyForm::tables, Use::nowhere, "a part of the system given by its matrices"},
    {"", "element", KeyForm::tables, Use::nowhere, "a spring, damper, inerter, friction or another element"},
    {"", "damping", KeyForm::table, Use::nowhere,
     "damping of the structure as a whole, in addition to dampers"},
    {"", "excitation", KeyForm::table, Use::nowhere, "what drives the system, and how fast",
     of("kind", "sweep|transient|tune|identify"), needed_of("kind", "sweep|transient|tune")},
    {"", "axis", KeyForm::tables, Use::nowhere,
     "a parameter that varies over the map; the outermost axis first", of("kind", "sweep|transient|tune"),
     needed_of("kind", "sweep")},
    {"", "coordinate", KeyForm::tables, Use::nowhere, "a derived coordinate along an axis",
     of("kind", "sweep|transient")},
    {"", "output", KeyForm::table, Use::nowhere,
     "what is recorded at each point; for a study that is not a map, the signals",
     of("kind", "sweep|transient|tune|decay")},
    {"", "orbits", KeyForm::table, Use::nowhere, "the search for responses where a system has several",
     of("kind", "sweep|tune")},
    {"", "compare", KeyForm::table, Use::nowhere, "the same map under another law or profile",
     of("kind", "sweep")},
    {"", "report", KeyForm::table, Use::nowhere, "what the page of frahm report shows",
     of("kind", "sweep|transient")},
    {"", "decay", KeyForm::table, Use::nowhere, "free vibration from initial values", of("kind", "decay")},
    {"", "transient", KeyForm::table, Use::nowhere, "forced motion from initial values",
     of("kind", "transient"), needed_of("kind", "transient")},
    {"", "initial", KeyForm::tables, Use::nowhere, "initial values of a mass; 0 where none are given",
     of("kind", "decay|transient|identify"), needed_of("kind", "decay")},
    {"", "tune", KeyForm::table, Use::nowhere, "what is made as small as possible", of("kind", "tune"),
     needed_of("kind", "tune")},
    {"", "design", KeyForm::tables, Use::nowhere, "a parameter that a tuning may change", of("kind", "tune"),
     needed_of("kind", "tune")},
    {"", "constraint", KeyForm::tables, Use::nowhere, "a limit that an optimum must keep",
     of("kind", "tune")},
    {"", "scenario", KeyForm::tables, Use::nowhere,
     "other values of parameters for which the optimum must also be good", of("kind", "tune")},
    {"", "column", KeyForm::tables, Use::nowhere, "a number that is reported with the optimum, or limited",
     of("kind", "tune")},
    {"", "identify", KeyForm::table, Use::nowhere, "how a model is found from measurements",
     of("kind", "identify"), needed_of("kind", "identify")},
    {"study", "schema", KeyForm::integer, Use::nowhere, "version of the format of study files: 1", needed,
     from(1, 1)},
    {"study", "kind", KeyForm::choice, Use::physics, "what is computed", words::kinds, needed},
    {"study", "title", KeyForm::text, Use::label, "title of the result and of its page"},
    {"study", "units", KeyForm::choice, Use::physics, "units of its values", words::units, Default{0}},
    {"mass", "name", KeyForm::name, Use::physics,
     "name by which elements, excitations and quantities refer to it", needed},
    {"mass", "mass", KeyForm::value, Use::physics,
     "mass [kg], >= 0; 0 where an inerter moves with it, or of a joint of springs and dampers", not_negative},
    {"mass", "inertia", KeyForm::value, Use::physics,
     "moment of inertia [kg m2], 0 as of a mass; its displacement is an angle [rad]", not_negative},
    {"matrices", "name", KeyForm::name, Use::physics, "name of the part", needed},
    {"matrices", "names", KeyForm::names, Use::physics,
     "names of its degrees of freedom, in the order of the rows", needed},
    {"matrices", "mass", KeyForm::file, Use::physics, "file of its mass matrix: .mtx, .csv or file.h5:/path",
     needed},
    {"matrices", "stiffness", KeyForm::file, Use::physics,
     "file of its stiffness matrix: .mtx, .csv or file.h5:/path", needed},
    {"matrices", "damping", KeyForm::file, Use::physics,
     "file of its damping matrix: .mtx, .csv or file.h5:/path"},
    {"element", "name", KeyForm::name, Use::physics, "name by which quantities refer to it", needed},
    {"element", "type", KeyForm::element_type, Use::physics, "kind of element", needed},
    {"element", "between", KeyForm::names, Use::physics,
     "the two nodes between which it acts: masses, supports or \"ground\"", Length{2, 2}},
    {"element", "along", KeyForm::settings, Use::physics,
     "its displacement as a combination: { mass = 1, other = \"-r\", ground = -1 }"},
    {"element", "stiffness", KeyForm::value, Use::physics, "stiffness [N/m], for a rotation [N m/rad]"},
    {"element", "damping", KeyForm::value, Use::physics,
     "viscous damping [N s/m], for a rotation [N m s/rad]"},
    {"element", "inertance", KeyForm::value, Use::physics,
     "force per relative acceleration [kg], for a rotation [kg m2]"},
    {"element", "force", KeyForm::value, Use::physics,
     "friction force while sliding [N], for a rotation [N m]"},
    {"element", "static_force", KeyForm::value, Use::physics,
     "largest friction force at rest [N], at least `force`"},
    {"element", "loss_factor", KeyForm::value, Use::physics,
     "loss factor of hysteretic damping [1]: the loss stiffness over the stiffness"},
    {"element", "law", KeyForm::choice, Use::physics, "friction law of a coulomb element",
     words::friction_laws, Default{0}},
    {"element", "slope", KeyForm::value, Use::physics,
     "slope of the arctan law [s/m]: F (2/pi) arctan(slope v)"},
    {"element", "cubic", KeyForm::value, Use::physics, "cubic stiffness of a spring [N/m3]: adds cubic u^3"},
    {"element", "table", KeyForm::pairs, Use::physics, "a characteristic given by points: [[-1, -5], [1, 5]]",
     Length{2}},
    {"element", "clearance", KeyForm::value, Use::physics,
     "clearance of a gap [m]: how far u goes from 0 to either side before it touches; a list is [lower, "
     "upper], inf means no stop",
     Or{KeyForm::values}, Length{2, 2}, not_negative},
    {"element", "tension", KeyForm::boolean, Use::physics,
     "whether a gap may pull. true: in contact it may also pull, until u is back at the clearance; false: "
     "contact ends where it would pull, which only damping makes it do",
     Default{0}},
    {"element", "stiffnesses", KeyForm::values, Use::physics,
     "stiffness of each slider of an iwan element [N/m]"},
    {"element", "forces", KeyForm::values, Use::physics,
     "force at which each slider of an iwan element gives way [N]"},
    {"element", "distribution", KeyForm::choice, Use::physics,
     "how the sliders of an iwan element are distributed", words::slider_distributions},
    {"element", "elements", KeyForm::integer, Use::physics, "number of sliders of an iwan element",
     from(1, most_contacts)},
    {"element", "chi", KeyForm::number, Use::physics, "exponent of the power distribution of an iwan element",
     Limits{.least = -1.0, .most = 100.0, .above = true}},
    {"damping", "modal", KeyForm::value, Use::physics,
     "ratio of all modes, or a list in ascending frequency whose last ratio also holds for all higher modes",
     Or{KeyForm::values}, not_negative},
    {"damping", "rayleigh", KeyForm::values, Use::physics, "[a, b]: C = a M + b K, in 1/s and s",
     Length{2, 2}, not_negative},
    {"excitation", "frequency", KeyForm::value, Use::physics,
     "fundamental angular frequency [rad/s]; rpm and Hz count revolutions", needed_of("kind", "sweep"),
     positive},
    {"excitation", "reference_order", KeyForm::integer, Use::physics,
     "the order for which phases are given; default: the lowest", from(1, highest_order)},
    {"excitation", "force", KeyForm::tables, Use::nowhere, "a harmonic force on a mass"},
    {"excitation", "motion", KeyForm::tables, Use::nowhere, "a harmonic motion of a support"},
    {"excitation", "record", KeyForm::tables, Use::nowhere, "a measured force or motion of a support",
     of("kind", "transient|tune")},
    {"excitation.force", "on", KeyForm::name, Use::physics, "the mass it acts on"},
    {"excitation.force", "node", KeyForm::name, Use::physics, "the same as `on`"},
    {"excitation.force", "amplitude", KeyForm::value, Use::physics,
     "[N], for a rotation [N m]: amplitude cos(order omega t + phase)", of("profile", "harmonic")},
    {"excitation.force", "force", KeyForm::plain_pairs, Use::physics,
     "corners [[t, force], ...], [s] and [N], straight lines between them: in a transient a course whose "
     "last "
     "value holds, in other studies one period",
     of("profile", "harmonic"), Length{2}},
    {"excitation.force", "scale", KeyForm::value, Use::physics,
     "multiplies the values of corners or of a file, default 1", of("profile", "harmonic|file")},
    {"excitation.force", "orders", KeyForm::integer, Use::physics,
     "the highest order of the Fourier series of a period, of corners or from a file",
     of("profile", "harmonic|file"), from(1, most_orders), Default{orders_of_corners}},
    {"excitation.force", "file", KeyForm::file, Use::physics,
     "CSV or HDF5 file of one period, relative to the folder of the study; its last row closes the period",
     of("profile", "file"), needed},
    {"excitation.force", "time", KeyForm::column, Use::physics,
     "column of the time, by heading or number; default 1", of("profile", "file"), from(1)},
    {"excitation.force", "column", KeyForm::column, Use::physics, "column of the values; default 2",
     of("profile", "file"), from(1)},
    {"excitation.force", "unit", KeyForm::text, Use::physics,
     "unit of the values, if the file does not give it; g of accelerations is gravity",
     of("profile", "file")},
    {"excitation.force", "order", KeyForm::integer, Use::physics,
     "multiple of the frequency; 0 is a constant", of("profile", "harmonic"), from(0, highest_order),
     Default{1}},
    {"excitation.force", "phase", KeyForm::value, Use::physics, "[rad], default 0"},
    {"excitation.force", "profile", KeyForm::choice, Use::physics, "shape of its course",
     words::force_profiles, Default{0}},
    {"excitation.motion", "node", KeyForm::name, Use::physics, "name of the support, a node without mass",
     needed},
    {"excitation.motion", "profile", KeyForm::choice, Use::physics, "kind of motion", words::profiles,
     Default{0}},
    {"excitation.motion", "amplitude", KeyForm::value, Use::physics, "amplitude of its displacement [m]",
     of("profile", "harmonic")},
    {"excitation.motion", "displacement", KeyForm::plain_pairs, Use::physics,
     "corners [[t, displacement], ...], [s] and [m], straight lines between them: in a transient a course "
     "whose last value holds, in other studies one period",
     of("profile", "harmonic"), Length{2}},
    {"excitation.motion", "velocity", KeyForm::value, Use::physics,
     "amplitude of its velocity [m/s]; with order 0, a belt; or its corners [[t, velocity], ...]",
     of("profile", "harmonic"), Or{KeyForm::plain_pairs}, Length{2}},
    {"excitation.motion", "acceleration", KeyForm::value, Use::physics,
     "amplitude of its acceleration [m/s2]; or its corners [[t, acceleration], ...]",
     of("profile", "harmonic"), Or{KeyForm::plain_pairs}, Length{2}},
    {"excitation.motion", "scale", KeyForm::value, Use::physics,
     "multiplies the values of corners or of a file, default 1", of("profile", "harmonic|file")},
    {"excitation.motion", "orders", KeyForm::integer, Use::physics,
     "the highest order of the Fourier series of a period, of corners or from a file",
     of("profile", "harmonic|file"), from(1, most_orders), Default{orders_of_corners}},
    {"excitation.motion", "file", KeyForm::file, Use::physics,
     "CSV or HDF5 file of one period, relative to the folder of the study; its last row closes the period",
     of("profile", "file"), needed},
    {"excitation.motion", "time", KeyForm::column, Use::physics,
     "column of the time, by heading or number; default 1", of("profile", "file"), from(1)},
    {"excitation.motion", "column", KeyForm::column, Use::physics, "column of the values; default 2",
     of("profile", "file"), from(1)},
    {"excitation.motion", "unit", KeyForm::text, Use::physics,
     "unit of the values, if the file does not give it; g of accelerations is gravity",
     of("profile", "file")},
    {"excitation.motion", "quantity", KeyForm::choice, Use::physics, "what the file has of the support",
     words::course_quantities, of("profile", "file"), Default{0}},
    {"excitation.motion", "order", KeyForm::integer, Use::physics, "multiple of the frequency",
     of("profile", "harmonic"), from(0, highest_order), Default{1}},
    {"excitation.motion", "phase", KeyForm::value, Use::physics, "[rad], default 0"},
    {"excitation.motion", "crank", KeyForm::value, Use::physics, "radius of a crank [m]",
     of("profile", "crank"), needed, not_negative},
    {"excitation.motion", "rod", KeyForm::value, Use::physics,
     "length of a crank's rod [m], longer than the crank", of("profile", "crank"), needed, positive},
    {"excitation.motion", "taylor_order", KeyForm::integer, Use::physics,
     "1, 2 or 4: order at which the series of the crank's motion is truncated; left out: exact",
     of("profile", "crank"), from_or(1, 2, 4)},
    {"excitation.record", "acceleration_of", KeyForm::name, Use::physics,
     "the support whose acceleration was measured"},
    {"excitation.record", "velocity_of", KeyForm::name, Use::physics,
     "the support whose velocity was measured"},
    {"excitation.record", "displacement_of", KeyForm::name, Use::physics,
     "the support whose displacement was measured"},
    {"excitation.record", "force_on", KeyForm::name, Use::physics,
     "the mass on which the measured force acts"},
    {"excitation.record", "file", KeyForm::file, Use::physics,
     "CSV or HDF5 file, relative to the folder of the study"},
    {"excitation.record", "time", KeyForm::column, Use::physics,
     "column of the time, by heading or number; default 1", from(1)},
    {"excitation.record", "column", KeyForm::column, Use::physics, "column of the values; default 2",
     from(1)},
    {"excitation.record", "unit", KeyForm::text, Use::physics,
     "unit of the values, if the file does not give it; g of accelerations is gravity"},
    {"excitation.record", "interpolation", KeyForm::choice, Use::physics,
     "interpolation between samples of a displacement", words::interpolations, Default{0}},
    {"excitation.record", "scale", KeyForm::value, Use::physics, "multiplies the values, default 1"},
    {"excitation.record", "from", KeyForm::plain_value, Use::physics,
     "start of a window in the record's own time [s]"},
    {"excitation.record", "to", KeyForm::plain_value, Use::physics, "end of that window [s]"},
    {"axis", "parameter", KeyForm::name, Use::physics, "the parameter that varies", of("", "numbers"),
     needed},
    {"axis", "unit", KeyForm::text, Use::grid, "unit of from, to and values", of("", "numbers")},
    {"axis", "from", KeyForm::number, Use::grid, "first value; or a CSV file of samples",
     of("", "numbers|file"), Or{KeyForm::file}},
    {"axis", "to", KeyForm::number, Use::grid, "last value", of("", "numbers")},
    {"axis", "points", KeyForm::integer, Use::grid,
     "number of values, \"from\" and \"to\" included; for a single value use values = [...]",
     of("", "numbers"), from(2, most_axis_points)},
    {"axis", "spacing", KeyForm::choice, Use::grid, "spacing of the values", words::spacings,
     of("", "numbers"), Default{0}},
    {"axis", "values", KeyForm::numbers, Use::grid, "a list of values in place of from, to and points",
     of("", "numbers")},
    {"axis", "zip", KeyForm::name, Use::grid, "name of the zip; axes of the same zip advance together",
     of("", "numbers|samples|file")},
    {"axis", "samples", KeyForm::integer, Use::grid, "number of samples of uncertain parameters",
     of("", "samples"), needed, from(2, most_axis_points)},
    {"axis", "sequence", KeyForm::choice, Use::grid, "how samples are drawn", words::sequences,
     of("", "samples"), Default{0}},
    {"axis", "seed", KeyForm::integer, Use::grid, "seed of the samples", of("", "samples"), not_negative,
     Default{1}},
    {"axis", "of", KeyForm::tables, Use::nowhere, "a parameter that is uncertain, with its distribution",
     of("", "samples")},
    {"axis", "fixed_from", KeyForm::file, Use::grid,
     "result of an identification whose estimates are sampled", of("", "samples")},
    {"axis", "parameters", KeyForm::names, Use::physics, "those of its estimates that are sampled",
     of("", "samples")},
    {"axis", "records", KeyForm::files, Use::physics, "files of records, or { generate = ... }",
     of("", "records"), Or{KeyForm::table}},
    {"axis.of", "parameter", KeyForm::name, Use::physics, "the uncertain parameter", needed},
    {"axis.of", "unit", KeyForm::text, Use::grid, "unit of the distribution's numbers"},
    {"axis.of", "distribution", KeyForm::choice, Use::grid, "distribution of its values",
     words::distributions, needed},
    {"axis.of", "mean", KeyForm::number, Use::grid, "mean of a normal or lognormal distribution",
     of("distribution", "normal|lognormal"), needed_of("distribution", "normal")},
    {"axis.of", "median", KeyForm::number, Use::grid, "median of a lognormal distribution",
     of("distribution", "lognormal"), positive},
    {"axis.of", "mode", KeyForm::number, Use::grid, "most likely value of a triangular distribution",
     of("distribution", "triangular"), needed},
    {"axis.of", "deviation", KeyForm::number, Use::grid, "standard deviation",
     of("distribution", "normal|lognormal"), positive},
    {"axis.of", "variation", KeyForm::number, Use::grid, "standard deviation over the mean",
     of("distribution", "normal|lognormal"), positive},
    {"axis.of", "lower", KeyForm::number, Use::grid, "smallest value; truncates a normal distribution",
     needed_of("distribution", "uniform|triangular")},
    {"axis.of", "upper", KeyForm::number, Use::grid, "largest value; truncates a normal distribution",
     needed_of("distribution", "uniform|triangular")},
    {"axis.records", "generate", KeyForm::choice, Use::physics, "random records of this kind",
     words::generators, needed},
    {"axis.records", "count", KeyForm::integer, Use::physics, "number of records", needed,
     from(1, most_records)},
    {"axis.records", "seed", KeyForm::integer, Use::physics, "seed of the random numbers", not_negative,
     Default{1}},
    {"axis.records", "duration", KeyForm::plain_value, Use::physics, "duration of each record [s]", needed,
     positive},
    {"axis.records", "rate", KeyForm::number, Use::physics, "samples per second", needed, positive},
    {"axis.records", "intensity", KeyForm::number, Use::physics, "two-sided spectral density S0", needed,
     positive},
    {"axis.records", "ground_frequency", KeyForm::plain_value, Use::physics,
     "natural frequency of the soil [rad/s]", of("generate", "kanai_tajimi"), needed, positive},
    {"axis.records", "ground_damping", KeyForm::number, Use::physics, "damping ratio of the soil",
     of("generate", "kanai_tajimi"), needed, positive},
    {"axis.records", "corner_frequency", KeyForm::plain_value, Use::physics,
     "frequency below which the ground's motion is bounded [rad/s]", of("generate", "kanai_tajimi"),
     positive},
    {"axis.records", "corner_damping", KeyForm::number, Use::physics, "damping ratio at the corner frequency",
     of("generate", "kanai_tajimi"), positive},
    {"axis.records", "envelope", KeyForm::table, Use::nowhere,
     "how the strength of the record rises and falls", of("generate", "kanai_tajimi")},
    {"axis.records.envelope", "shape", KeyForm::choice, Use::physics, "shape of the envelope",
     words::envelopes, needed},
    {"axis.records.envelope", "rise", KeyForm::plain_value, Use::physics, "time until which it rises [s]",
     needed, positive},
    {"axis.records.envelope", "level_end", KeyForm::plain_value, Use::physics,
     "time until which it is level [s]", needed, positive},
    {"axis.records.envelope", "decay", KeyForm::plain_value, Use::physics, "rate at which it decays [1/s]",
     of("shape", "jennings"), needed, positive},
    {"coordinate", "name", KeyForm::name, Use::shown, "name of the coordinate", needed},
    {"coordinate", "value", KeyForm::expression, Use::shown, "expression of the parameters of one axis",
     needed},
    {"coordinate", "unit", KeyForm::text, Use::label,
     "unit of that value: a single parameter is converted to it, any other expression gives the number in "
     "it"},
    {"coordinate", "long_name", KeyForm::text, Use::label, "label for the axes of figures"},
    {"output", "quantities", KeyForm::choice, Use::physics,
     "\"standard\", \"all\", or names and patterns such as \"floor*_peak\"", of("kind", "sweep|transient"),
     words::sets_of_quantities, Or{KeyForm::patterns}},
    {"output", "precision", KeyForm::choice, Use::physics, "digits that are kept", words::precisions,
     of("kind", "sweep|transient"), Default{0}},
    {"output", "path", KeyForm::choice, Use::physics, "how orbits are found", words::paths,
     of("kind", "sweep"), Default{0}},
    {"output", "borders", KeyForm::boolean, Use::grid, "locate where regimes change between points",
     of("kind", "sweep"), Default{0}},
    {"output", "branches", KeyForm::boolean, Use::grid,
     "true, or { along, at }: follow branches through folds", of("kind", "sweep"), Or{KeyForm::table}},
    {"output", "orbits", KeyForm::list_of_settings, Use::grid, "points whose time histories are recorded",
     of("kind", "sweep"), Inside{KeyForm::plain_value}, Length{0}},
    {"output", "resonances", KeyForm::names, Use::grid,
     "masses whose resonances along the frequency axis are computed", of("kind", "sweep"), Length{0}},
    {"output", "quantiles", KeyForm::numbers, Use::shown, "quantiles over samples, such as [0.05, 0.5, 0.95]",
     of("kind", "sweep|transient"), from(least_quantile, 1.0 - least_quantile)},
    {"output", "histories", KeyForm::list_of_settings, Use::grid,
     "points of a map of motions whose histories are kept", of("kind", "transient"),
     Inside{KeyForm::plain_value}, Length{0}},
    {"output", "signal", KeyForm::tables, Use::nowhere,
     "a combination of coordinates that is reported like a mass", needed_of("kind", "decay|tune")},
    {"output.branches", "along", KeyForm::name, Use::grid,
     "the axis along which branches are followed; default: the innermost"},
    {"output.branches", "at", KeyForm::list_of_settings, Use::grid,
     "rows on which branches are followed: a list of { parameter = value }", Inside{KeyForm::plain_value}},
    {"output.signal", "name", KeyForm::name, Use::physics, "name of the signal", needed},
    {"output.signal", "along", KeyForm::settings, Use::physics, "{ mass = factor, ... }", needed},
    {"orbits", "starts", KeyForm::integer, Use::physics,
     "number of states from which the search at each point starts", from(1, 10'000),
     Default{periodic::OrbitsWanted{}.starts}},
    {"orbits", "most_multiple", KeyForm::integer, Use::physics,
     "longest period, in periods of the excitation", from(1, longest_multiple),
     Default{periodic::OrbitsWanted{}.most_multiple}},
    {"orbits", "show", KeyForm::choice, Use::physics, "which response a map shows", words::responses,
     of("kind", "sweep"), Default{0}},
    {"compare", "law", KeyForm::choice, Use::physics, "the other law of friction", words::compared_laws},
    {"compare", "slope", KeyForm::value, Use::physics, "slope of the arctan law [s/m]", positive,
     of("law", "arctan"), needed_of("law", "arctan")},
    {"compare", "taylor_order", KeyForm::integer, Use::physics,
     "order at which the series of every crank is truncated", from_or(1, 2, 4)},
    {"compare", "show", KeyForm::choice, Use::physics, "the other response, where there are several",
     words::responses},
    {"compare", "quantities", KeyForm::patterns, Use::physics,
     "what is compared; default: peak of the first mass"},
    {"report", "quantities", KeyForm::patterns, Use::label, "recorded quantities to show"},
    {"report", "headline", KeyForm::name, Use::label, "mass or element shown in the first table and picture"},
    {"report", "profile", KeyForm::text, Use::label, "masses over the height, the lowest first",
     of("kind", "sweep"), Or{KeyForm::names}, Length{2}},
    {"report", "height", KeyForm::number, Use::label, "heights of those masses [m]", of("kind", "sweep"),
     Or{KeyForm::numbers}, Length{2}},
    {"decay", "duration", KeyForm::value, Use::grid, "duration [s]; default: until rest", positive},
    {"decay", "samples", KeyForm::integer, Use::grid, "number of samples of the history; 0: none",
     from_or(2, most_samples, 0), Default{0}},
    {"decay", "reference_frequency", KeyForm::value, Use::physics,
     "frequency of loss factors [rad/s]; default: the lowest natural frequency", positive},
    {"transient", "duration", KeyForm::value, Use::physics, "[s]", positive},
    {"transient", "samples", KeyForm::integer, Use::grid, "number of samples of the history",
     from(2, most_samples), Default{samples_of_a_transient}},
    {"transient", "sweep_to", KeyForm::value, Use::physics, "frequency at the end of a run-up [rad/s]",
     positive},
    {"transient", "sweep_rate", KeyForm::value, Use::physics, "rate of change of the frequency [rad/s2]",
     positive},
    {"initial", "node", KeyForm::name, Use::physics, "the mass", needed},
    {"initial", "displacement", KeyForm::value, Use::physics, "displacement at the start [m]"},
    {"initial", "velocity", KeyForm::value, Use::physics, "velocity at the start [m/s]"},
    {"tune", "objective", KeyForm::choice, Use::physics, "what is minimised", words::objectives, needed},
    {"tune", "quantity", KeyForm::name, Use::physics, "the quantity that is minimised, such as main_peak",
     needed},
    {"tune", "band", KeyForm::table, Use::nowhere, "frequencies over which it counts", of("", "band")},
    {"tune", "solver", KeyForm::choice, Use::physics, "solver of the optimisation", words::solvers},
    {"tune", "start", KeyForm::choice, Use::physics, "where the search begins", words::starts_of_tunings,
     Or{KeyForm::integer}, from(1, 100'000)},
    {"tune", "global", KeyForm::choice, Use::physics, "a search over the whole box first",
     words::global_searches, of("", "band"), Default{0}},
    {"tune", "tolerance", KeyForm::number, Use::physics, "relative tolerance of the optimum",
     between(0.0, largest_tolerance), Default{1e-6}},
    {"tune", "weight", KeyForm::expression, Use::physics,
     "factor on the quantity, an expression of the band's parameter", of("", "band")},
    {"tune", "dominate", KeyForm::choice, Use::physics,
     "the schedule must be nowhere worse than the best constant", words::dominated, of("", "band")},
    {"tune", "trade_off", KeyForm::table, Use::nowhere, "limits of a second quantity, one optimum each",
     of("", "band")},
    {"tune", "noise", KeyForm::table, Use::nowhere, "the random excitation of objective = \"variance\"",
     of("", "band"), needed_of("objective", "variance")},
    {"tune", "quantile", KeyForm::number, Use::physics, "quantile over samples that is minimised",
     of("", "records"), between(0.0, 1.0)},
    {"tune", "records", KeyForm::files, Use::physics, "the records of a tuning over records",
     of("", "records"), Or{KeyForm::table, "axis.records"}},
    {"tune", "duration", KeyForm::number, Use::physics, "duration of the motion under records [s]",
     of("", "records"), positive},
    {"tune.band", "parameter", KeyForm::name, Use::physics,
     "the parameter on which the excitation frequency depends", needed},
    {"tune.band", "from", KeyForm::number, Use::physics, "lowest value", needed},
    {"tune.band", "to", KeyForm::number, Use::physics, "highest value", needed},
    {"tune.band", "unit", KeyForm::text, Use::physics, "unit of `from` and `to`"},
    {"tune.trade_off", "quantity", KeyForm::name, Use::physics, "the second quantity", needed},
    {"tune.trade_off", "values", KeyForm::numbers, Use::physics, "its limits", needed},
    {"tune.trade_off", "unit", KeyForm::text, Use::physics, "unit of the limits"},
    {"tune.noise", "force_on", KeyForm::name, Use::physics, "the mass under the random force"},
    {"tune.noise", "acceleration_of", KeyForm::name, Use::physics,
     "the support under the random acceleration"},
    {"tune.noise", "intensity", KeyForm::number, Use::physics, "two-sided spectral density S0", positive},
    {"design", "parameter", KeyForm::name, Use::physics, "the parameter that may change", needed},
    {"design", "lower", KeyForm::number, Use::physics, "its lower bound", needed},
    {"design", "upper", KeyForm::number, Use::physics, "its upper bound", needed},
    {"design", "unit", KeyForm::text, Use::physics, "unit of the bounds"},
    {"design", "schedule", KeyForm::table, Use::nowhere, "makes it a function of the band's parameter"},
    {"design", "rule", KeyForm::expression, Use::shown,
     "an expression that it is known to follow, for comparison"},
    {"design.schedule", "knots", KeyForm::integer, Use::physics, "number of its knots, or their places",
     Or{KeyForm::numbers}, Length{2}, needed, from(2, 10'000)},
    {"design.schedule", "max_slope", KeyForm::number, Use::physics, "bound on its slope", positive},
    {"design.schedule", "jumps", KeyForm::integer, Use::physics, "1: it may jump once", from(0, 1),
     Default{0}},
    {"constraint", "quantity", KeyForm::name, Use::physics, "the quantity that is limited", needed},
    {"constraint", "lower", KeyForm::number, Use::physics, "its lower limit"},
    {"constraint", "upper", KeyForm::number, Use::physics, "its upper limit"},
    {"constraint", "unit", KeyForm::text, Use::physics, "unit of the limits"},
    {"constraint", "band", KeyForm::table, Use::nowhere,
     "where the limit holds; default: the band of [tune]"},
    {"constraint.band", "from", KeyForm::number, Use::physics, "lowest value", needed},
    {"constraint.band", "to", KeyForm::number, Use::physics, "highest value", needed},
    {"constraint.band", "unit", KeyForm::text, Use::physics,
     "unit of `from` and `to`; default: that of the band of [tune]"},
    {"scenario", "name", KeyForm::name, Use::shown, "name of the scenario", needed},
    {"scenario", "set", KeyForm::settings, Use::physics, "{ parameter = value }",
     Inside{KeyForm::plain_value}, Length{0}, needed},
    {"column", "name", KeyForm::name, Use::shown, "name of the column", needed},
    {"column", "value", KeyForm::expression, Use::shown, "an expression of design parameters", needed},
    {"column", "unit", KeyForm::text, Use::label,
     "unit of the value: a single parameter is converted to it, any other expression gives the number in it"},
    {"column", "lower", KeyForm::number, Use::shown, "its lower limit"},
    {"column", "upper", KeyForm::number, Use::shown, "its upper limit"},
    {"identify", "method", KeyForm::choice, Use::physics, "how estimates are found", words::methods, needed},
    {"identify", "start", KeyForm::choice, Use::physics, "where a grey box starts", words::starts_of_fits,
     of("method", "grey_box"), Default{0}},
    {"identify", "fixed_from", KeyForm::file, Use::physics,
     "results of earlier identifications whose estimates are used", of("method", "grey_box"),
     Or{KeyForm::files}},
    {"identify", "curve", KeyForm::choice, Use::physics, "what excited a response curve", words::curves,
     of("method", "half_power|resonance_magnification|forced_resonance"), Default{0}},
    {"identify", "cycles", KeyForm::integer, Use::physics, "number of cycles of a logarithmic decrement",
     of("method", "log_decrement"), from(1, 1'000'000)},
    {"identify", "sensor_offset", KeyForm::boolean, Use::physics, "true: the sensor's zero is also estimated",
     of("method", "free_decay"), Default{0}},
    {"identify", "mass", KeyForm::value, Use::physics, "known mass [kg]",
     of("method", "free_decay|forced_resonance"), positive},
    {"identify", "stiffness", KeyForm::value, Use::physics, "known stiffness [N/m]",
     of("method", "free_decay|forced_resonance"), positive},
    {"identify", "reference_frequency", KeyForm::value, Use::physics,
     "frequency of hysteretic elements [rad/s]", of("method", "grey_box"), positive},
    {"identify", "record", KeyForm::tables, Use::nowhere, "a measurement", needed},
    {"identify", "parameter", KeyForm::tables, Use::nowhere, "a parameter to estimate",
     needed_of("method", "grey_box")},
    {"identify.record", "name", KeyForm::name, Use::physics, "name of the record"},
    {"identify.record", "file", KeyForm::file, Use::physics,
     "CSV or HDF5 file, relative to the folder of the study", needed},
    {"identify.record", "columns", KeyForm::settings, Use::physics, "quantity = column, by number or heading",
     Inside{KeyForm::column}, from(1)},
    {"identify.record", "units", KeyForm::settings, Use::physics,
     "quantity = unit, if the file does not give it", Inside{KeyForm::text}, Length{0}},
    {"identify.record", "set", KeyForm::settings, Use::physics, "{ parameter = value } for this record",
     of("method", "grey_box"), Inside{KeyForm::plain_value}, Length{0}},
    {"identify.record", "motion", KeyForm::choice, Use::physics,
     "kind of motion that a grey box's record shows; free: no harmonics, but constant loads and belts act",
     words::motions, of("method", "grey_box")},
    {"identify.record", "interpolation", KeyForm::choice, Use::physics,
     "interpolation between samples of a support's measured displacement", words::interpolations,
     of("method", "grey_box"), Default{0}},
    {"identify.record", "added_mass", KeyForm::value, Use::physics, "mass that was added [kg]",
     of("method", "added_mass"), not_negative},
    {"identify.record", "static_displacement", KeyForm::value, Use::physics,
     "displacement under the static force [m]", of("method", "resonance_magnification"), positive},
    {"identify.parameter", "parameter", KeyForm::name, Use::physics, "the parameter to estimate", needed},
    {"identify.parameter", "lower", KeyForm::number, Use::physics, "its lower bound",
     of("method", "grey_box")},
    {"identify.parameter", "upper", KeyForm::number, Use::physics, "its upper bound",
     of("method", "grey_box")},
    {"identify.parameter", "unit", KeyForm::text, Use::physics, "unit of the bounds"},
    {"identify.parameter", "each_record", KeyForm::boolean, Use::physics,
     "true: it has its own value in every record", of("method", "grey_box"), Default{0}},
    {"identify.parameter", "estimate", KeyForm::name, Use::physics, "the estimate of a formula that it takes",
     of("method", formulas.data()), needed},
    {"{ value, unit }", "value", KeyForm::number, Use::physics, "the number", needed},
    {"{ value, unit }", "unit", KeyForm::text, Use::physics,
     "its unit, as UDUNITS writes it: \"kN/m\", \"rpm\", \"degree\""},
    {"{ table, of }", "table", KeyForm::file, Use::physics,
     "CSV file of two columns; a parameter is interpolated between its rows", needed},
    {"{ table, of }", "of", KeyForm::name, Use::physics,
     "the parameter whose values its first column contains", needed},
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

std::string Limits::text(std::string_view kind) const {
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

std::string path_of(const StudyKey& key) {
  return *key.section == '\0' ? key.key : fmt::format("{}.{}", key.section, key.key);
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
