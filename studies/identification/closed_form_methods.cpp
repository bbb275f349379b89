#include "studies/identification/closed_form_methods.hpp"

#include <algorithm>
#include <array>

#include "solvers/identification/added_mass.hpp"
#include "solvers/identification/energy_balance.hpp"
#include "solvers/identification/forced_resonance.hpp"
#include "solvers/identification/free_decay.hpp"
#include "solvers/identification/half_power.hpp"
#include "solvers/identification/hysteresis_loop.hpp"
#include "solvers/identification/log_decrement.hpp"
#include "solvers/identification/resonance_magnification.hpp"
#include "studies/motion/one_motion.hpp"

namespace frahm::studies {
namespace {

using identification::Identification, identification::OneMass, identification::ResponseTo;

// The numbers of a role; empty where the record has none.
std::vector<double> column(const RecordChoice& record, const char* role) {
  const DataColumn* found = record.find(role);
  return found ? found->values : std::vector<double>{};
}

std::optional<double> stated(const Study& study, const std::optional<StudyValue>& value) {
  if (!value) return std::nullopt;
  return stated(study, *value);
}

OneMass known_of(const Study& study) {
  return {.mass = stated(study, study.identify()->mass),
          .stiffness = stated(study, study.identify()->stiffness)};
}

ResponseTo shaken_by(const IdentifyChoice& choice) {
  return choice.curve == CurveOf::support ? ResponseTo::support : ResponseTo::force;
}

identification::ResponseCurve curve_of(const RecordChoice& record) {
  return {.omega = column(record, "frequency"), .amplitude = column(record, "amplitude")};
}

Identification half_power_of(const Study& study, const RecordChoice& record) {
  if (record.find("amplitude"))
    return identification::half_power(curve_of(record), shaken_by(*study.identify()));
  return identification::half_power(identification::HalfPowerRows{.peak = column(record, "natural_frequency"),
                                                                  .lower = column(record, "lower_frequency"),
                                                                  .upper = column(record, "upper_frequency")},
                                    shaken_by(*study.identify()));
}

Identification magnification_of(const Study& study, const RecordChoice& record) {
  if (record.find("amplitude")) {
    return identification::resonance_magnification(
        curve_of(record), stated(study, *record.static_displacement), shaken_by(*study.identify()));
  }
  return identification::resonance_magnification(
      identification::MagnificationRows{.static_displacement = column(record, "static_displacement"),
                                        .resonant = column(record, "resonant_displacement")},
      shaken_by(*study.identify()));
}

// Turning points given as data: a time for each, or none.
identification::DecayExtrema extrema_of(const RecordChoice& record) {
  identification::DecayExtrema extrema;
  extrema.time = column(record, "extremum_time");
  extrema.displacement = column(record, "extremum");
  return extrema;
}

Identification log_decrement_of(const Study& study, const RecordChoice& record) {
  const auto cycles = study.identify()->cycles;
  if (record.find("extremum")) return identification::log_decrement(extrema_of(record), cycles);
  return identification::log_decrement(column(record, "time"), column(record, "displacement"), cycles);
}

Identification free_decay_of(const Study& study, const RecordChoice& record) {
  const identification::FreeDecayOptions options{.known = known_of(study),
                                                 .sensor_offset = study.identify()->sensor_offset};
  if (record.find("extremum")) return identification::free_decay(extrema_of(record), options);
  return identification::free_decay(column(record, "time"), column(record, "displacement"), options);
}

Identification forced_resonance_of(const Study& study, const RecordChoice& record) {
  const OneMass known = known_of(study);
  if (record.find("slope")) {
    return identification::forced_resonance(
        identification::ResonanceLines{.slope = column(record, "slope"),
                                       .intercept = column(record, "intercept")},
        shaken_by(*study.identify()), known);
  }
  identification::ResonancePairs pairs{.response = column(record, "response"),
                                       .excitation = column(record, "support")};
  if (record.find("force")) {
    pairs.excitation = column(record, "force");
    for (double& force : pairs.excitation) force /= *known.stiffness;  // P/k
  }
  return identification::forced_resonance(pairs, shaken_by(*study.identify()), known);
}

Identification energy_balance_of(const Study&, const RecordChoice& record) {
  return identification::energy_balance({.amplitude = column(record, "amplitude"),
                                         .energy = column(record, "energy"),
                                         .omega = column(record, "frequency"),
                                         .velocity_rms = column(record, "velocity_rms")});
}

Identification hysteresis_loop_of(const Study&, const RecordChoice& record) {
  return identification::hysteresis_loop({.time = column(record, "time"),
                                          .displacement = column(record, "displacement"),
                                          .force = column(record, "force")});
}

// The natural frequency of each record by its free decay, unless a table gives them.
Identification added_mass_of(const Study& study, const RecordChoice& first) {
  if (first.find("frequency"))
    return identification::added_mass({.added = column(first, "added_mass"),
                                       .omega = column(first, "frequency"),
                                       .sigma = column(first, "frequency_error")});
  identification::AddedMassRows rows;
  Identification decays;
  for (const RecordChoice& record : study.identify()->records) {
    Identification decay = identification::free_decay(column(record, "time"), column(record, "displacement"),
                                                      identification::FreeDecayOptions{});
    if (!decay.failure.empty()) {
      decay.failure = "record \"" + record.name + "\": " + decay.failure;
      return decay;
    }
    const auto frequency =
        std::find_if(decay.estimates.begin(), decay.estimates.end(),
                     [](const auto& estimate) { return estimate.name == "natural_frequency"; });
    rows.added.push_back(record.added_mass ? stated(study, *record.added_mass) : 0.0);
    rows.omega.push_back(frequency->value);
    rows.sigma.push_back(frequency->standard_error);
    rows.degrees_of_freedom.push_back(frequency->degrees_of_freedom);
    for (auto& each : decay.records) {
      each.name = record.name;
      decays.records.push_back(std::move(each));
    }
  }
  if (std::any_of(rows.sigma.begin(), rows.sigma.end(), [](double sigma) { return !(sigma > 0.0); })) {
    rows.sigma.clear();
    rows.degrees_of_freedom.clear();
  }
  Identification result = identification::added_mass(rows);
  result.records.insert(result.records.end(), decays.records.begin(), decays.records.end());
  return result;
}

// Of each method, in the order of IdentifyMethod. The last, a grey box, has no formula.
constexpr std::array formulas{half_power_of,       magnification_of,  log_decrement_of,   free_decay_of,
                              forced_resonance_of, energy_balance_of, hysteresis_loop_of, added_mass_of};
static_assert(formulas.size() == static_cast<std::size_t>(IdentifyMethod::grey_box));

}  // namespace

Identification identify_in_closed_form(const Study& study) {
  const auto& records = study.identify()->records;
  const auto formula = formulas.at(static_cast<std::size_t>(study.identify()->method));
  Identification result = formula(study, records.front());
  if (records.size() > 1) return result;  // that have their names
  for (identification::FittedRecord& fitted : result.records)
    fitted.name =
        result.records.size() == 1 ? records.front().name : records.front().name + "_" + fitted.name;
  return result;
}

}  // namespace frahm::studies
