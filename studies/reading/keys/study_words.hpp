#pragma once

#include "studies/reading/keys/study_keys.hpp"

// The words of a study's choices. "In the order of" names an enumeration that they are read as
// (TomlSection::choice_as).
namespace frahm::studies::words {

inline constexpr StudyWord kinds[] = {  // in the order of StudyKind
    {"sweep", "a map of periodic responses over the axes"},
    {"decay", "a free vibration from initial values"},
    {"transient", "a forced motion from initial values, or a map of such motions over the axes"},
    {"tune", "the values of design parameters at which an objective is least"},
    {"identify", "a model, or its parameters, from measurements"}};

inline constexpr StudyWord units[] = {{"SI", "values may have units, bare numbers are SI"},
                                      {"dimensionless", "all values are plain numbers"}};

inline constexpr StudyWord friction_laws[] = {  // in the order of ForceLaw
    {"exact", "F sgn(v) while it slides, up to F (or static_force) at rest; solved exactly"},
    {"arctan", "smooth: F (2/pi) arctan(slope v); integrated, an estimate"},
    {"stribeck", "smooth: the curve of `table`, force over speed; integrated, an estimate"}};

inline constexpr StudyWord compared_laws[] = {{"exact", "Coulomb's law, which sticks"},
                                              {"arctan", "the smooth law F (2/pi) arctan(slope v)"}};

inline constexpr StudyWord slider_distributions[] = {
    {"uniform", "the forces at which the sliders give way are spread evenly from 0"},
    {"power", "their density grows with the power `chi` of the force"}};

inline constexpr StudyWord harmonic[] = {{"harmonic", "amplitude cos(order omega t + phase)"}};
inline constexpr StudyWord profiles[] = {
    harmonic[0],
    {"crank", "motion of a slider on a rod, driven by a crank that turns with omega t + phase"},
    {"file", "one period from a file, as its Fourier series"}};
inline constexpr StudyWord force_profiles[] = {harmonic[0], profiles[2]};
inline constexpr StudyWord course_quantities[] = {
    {"displacement", "the file has the displacement of the support"},
    {"velocity", "its velocity"},
    {"acceleration", "its acceleration"}};

inline constexpr StudyWord spacings[] = {{"linear", "in equal steps"}, {"log", "in equal ratios"}};

inline constexpr StudyWord interpolations[] = {  // in the order of transient::Interpolation
    {"spline", "a cubic spline through the samples, smooth"},
    {"linear", "straight lines from sample to sample: the velocity jumps at each"}};

inline constexpr StudyWord sequences[] = {  // in the order of samples::Sequence
    {"sobol", "Sobol's points, shifted at random: evenly over all parameters together"},
    {"latin_hypercube",
     "Latin hypercube: each parameter has one random value in each of as many equally likely parts"},
    {"random", "independent of each other"}};

inline constexpr StudyWord distributions[] = {  // in the order of samples::Distribution::Kind
    {"normal", "by mean and deviation, or variation; cut off at lower and upper, if given"},
    {"lognormal", "its logarithm is normal; by median or mean, and deviation or variation"},
    {"uniform", "every value from lower to upper is equally likely"},
    {"triangular", "from lower to upper, most likely at mode"}};

inline constexpr StudyWord generators[] = {
    {"white", "white noise of the spectral density `intensity`"},
    {"kanai_tajimi", "an earthquake: white noise through a layer of soil, with an envelope"}};

inline constexpr StudyWord envelopes[] = {
    {"jennings", "(t/rise)^2, then level, from level_end on falling by exp(-decay t)"},
    {"trapezoid", "t/rise, then level, from level_end on straight to 0"}};

inline constexpr StudyWord sets_of_quantities[] = {{"standard", "the quantities most often needed"},
                                                   {"all", "every quantity of the study"}};

inline constexpr StudyWord precisions[] = {  // in the order of Precision
    {"double", "eight bytes, with the digits beyond the known ones cleared"},
    {"single", "four bytes"},
    {"full", "eight bytes, every bit"}};

inline constexpr StudyWord paths[] = {
    {"fastest", "the equation of the events where no contact sticks, shooting elsewhere"},
    {"general", "every orbit by shooting, as a check"}};

inline constexpr StudyWord responses[] = {  // in the order of OrbitsWanted::Show
    {"largest", "of several responses, the one with the largest motion"},
    {"smallest", "of several responses, the one with the smallest motion"},
    {"up", "the response reached as the frequency rises"},
    {"down", "the response reached as the frequency falls"}};

inline constexpr StudyWord objectives[] = {
    {"minimax", "the worst value in the band", "band"},
    {"mean_square", "the mean of its square over the band", "band"},
    {"variance", "the mean square under white noise", "band"},
    {"worst_peak", "the largest peak under the records", "records"},
    {"mean_peak", "the mean of the peaks under the records", "records"}};

inline constexpr StudyWord solvers[] = {
    {"ipopt", "Ipopt's interior points: for schedules of many knots"},
    {"slsqp", "NLopt's sequential quadratic programming: for constants and few knots"},
    {"mma", "NLopt's method of moving asymptotes"}};

inline constexpr StudyWord starts_of_tunings[] = {
    {"given", "from the study's own values"},
    {"map", "from low places of a map of the whole box; over a band"},
    {"nlopt", "from the end of a `global` search of the box; over a band"}};

inline constexpr StudyWord global_searches[] = {
    {"crs2", "NLopt's controlled random search with local mutation"},
    {"isres", "NLopt's evolution with stochastic ranking"},
    {"direct", "NLopt's dividing rectangles"},
    {"mlsl", "NLopt's local searches from many starts"}};

inline constexpr StudyWord dominated[] = {{"constant", "the best constant in place of the schedule"}};

inline constexpr StudyWord methods[] = {  // in the order of IdentifyMethod
    {"half_power", "damping ratio by the width of a resonance"},
    {"resonance_magnification", "damping ratio by the height of a resonance over the static displacement"},
    {"log_decrement", "damping ratio by how the turning points of a free decay fall"},
    {"free_decay", "damping ratio and friction together, by the turning points of a free decay"},
    {"forced_resonance", "damping ratio and friction together, by responses at resonance"},
    {"energy_balance", "damping and friction by the energy lost in a cycle"},
    {"hysteresis_loop", "stiffness and losses by the loop of force over displacement"},
    {"added_mass", "mass and stiffness by frequencies with and without added masses"},
    {"grey_box", "any parameters of the system, by least squares between its motion and the records"}};

inline constexpr StudyWord starts_of_fits[] = {  // in the order of IdentifyStart
    {"given", "from the study's own values"},
    {"free_decay", "from what the method \"free_decay\" finds"}};

inline constexpr StudyWord curves[] = {  // in the order of CurveOf
    {"force", "a force on the mass"},
    {"support", "a motion of its support"}};

inline constexpr StudyWord motions[] = {{"free", "from initial values, not driven"},
                                        {"forced", "from initial values, driven"},
                                        {"periodic", "the steady response"}};

}  // namespace frahm::studies::words
