#include "tests/invariants/invariants.hpp"

#include <algorithm>
#include <cmath>

#include "solvers/flow/equations.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "tests/invariants/changes.hpp"

namespace frahm::invariants {
namespace {

using periodic::Measure;

constexpr double kAgreement = 1e-8;       // of the largest displacement
constexpr double kOtherAgreement = 1e-7;  // of the largest velocity, acceleration, force or energy
constexpr double kOfForcing = 1e-10;      // of what the excitation would do at rest: rounding
constexpr double kShareAgreement = 1e-6;  // of shares of a period and of energy
constexpr double kBalance = 1e-9, kResidual = 1e-12, kStable = 1.0 + 1e-9, kLimit = 1.0 + 1e-9;
// Of the largest force, and of its work on the largest displacement: a limit and the energy of a period may
// be orders of magnitude below them.
constexpr double kRounding = 1e-14;

bool is_energy(Measure measure) {
  return measure == Measure::energy || measure == Measure::energy_input;
}

bool is_compared(const Figure& figure) {
  switch (figure.quantity.measure) {
    case Measure::error_bound:
    case Measure::residual:
    case Measure::energy_balance:
    case Measure::newton_iterations:
    case Measure::events:
    case Measure::reversals:
    case Measure::status:
    case Measure::phase:
    case Measure::peak_phase:
    case Measure::element_phase:
    case Measure::magnification:
    case Measure::transmissibility:
    case Measure::force_transmissibility:
    case Measure::modal_damping:
      return false;
    default:
      return true;
  }
}

Standing standing_of(const Answer& one, const Answer& other) {
  constexpr double kNeutral = 1.0 - 1e-6;
  if (one.status == 2 || other.status == 2) return Standing::grazing;
  if (one["floquet_radius"] > kNeutral || other["floquet_radius"] > kNeutral) return Standing::neutral;
  return Standing::ok;
}

// Lengths, times and forces of the excitation.
Factors size_of_forcing(const Case& c) {
  Factors size{0.0, 1.0 / (c.values.omega * c.network.reference_order), 0.0};
  double softest = HUGE_VAL;
  for (std::size_t e = 0; e < c.network.elements.size(); ++e) {
    if (c.network.elements[e].type == mechanics::ElementType::spring)
      softest = std::min(softest, std::abs(c.values.element[e]));
  }
  for (std::size_t k = 0; k < c.network.excitations.size(); ++k) {
    const double amplitude = std::abs(c.values.excitation[k].amplitude);
    if (c.network.excitations[k].kind == mechanics::ExcitationKind::force) {
      size.force += amplitude;
      size.length += amplitude / softest;
    } else {
      size.length += amplitude;
      size.force += amplitude * softest;
    }
  }
  // The faster of the excitation and of a force on the lightest mass.
  const double lightest = *std::ranges::min_element(c.values.mass);
  if (size.force > 0.0) size.time = std::min(size.time, std::sqrt(size.length * lightest / size.force));
  return size;
}

// More than rounding goes in.
bool has_energy(const Case& c, const Answer& base) {
  constexpr double kOfRounding = 1e-8;
  return base["energy_input"] > kOfRounding * factor_of("J", size_of_forcing(c));
}

double largest_in_unit(const Answer& answer, const std::string& unit) {
  double largest = 0.0;
  for (const Figure& figure : answer.figures) {
    if (figure.unit == unit && is_compared(figure)) largest = std::max(largest, std::abs(figure.value));
  }
  return largest;
}

class Worst {
 public:
  explicit Worst(Violation of) : worst_(std::move(of)) {}
  void check(const std::string& figure, double found, double expected, double allowed) {
    const double off = std::abs(found - expected);
    if (off <= allowed || (std::isnan(found) && std::isnan(expected))) return;
    const double excess = std::isnan(off) ? HUGE_VAL : off / std::max(allowed, 1e-300);
    if (excess <= excess_) return;
    excess_ = excess;
    worst_.figure = figure;
    worst_.found = found;
    worst_.expected = expected;
    worst_.allowed = allowed;
  }
  void add_to(std::vector<Violation>& violations) const {
    if (excess_ > 0.0) violations.push_back(worst_);
  }

 private:
  Violation worst_;
  double excess_ = 0.0;
};

// What an error of the displacements makes of the errors of other figures: no motion is faster than the
// fastest rate of the system, nor a spring stiffer than what gives all masses that rate.
class ErrorOfDisplacements {
 public:
  explicit ErrorOfDisplacements(const Case& c) {
    mechanics::LinearSystem system;
    mechanics::Assembly(c.network).set_values(c.values, system);
    rate_ = periodic::fastest_rate(system);
    mass_ = system.M.trace();
  }
  double in_unit(const std::string& unit, double error) const {
    if (unit == "m") return error;
    if (unit == "m s-1") return error * rate_;
    if (unit == "m s-2") return error * rate_ * rate_;
    if (unit == "N") return error * rate_ * rate_ * mass_;
    return 0.0;
  }

 private:
  double rate_ = 0.0, mass_ = 0.0;  // [rad/s], [kg]
};

double allowed_difference(const Figure& figure, const Case& original, const Answer& base) {
  const double rounding = kOfForcing * factor_of(figure.unit, size_of_forcing(original));
  if (figure.quantity.measure == Measure::stops || figure.quantity.measure == Measure::regime) return 0.5;
  if (figure.quantity.measure == Measure::natural_frequency) return 1e-9 * figure.value;
  if (figure.unit == "1") return kShareAgreement;
  const double agreement = figure.unit == "m" ? kAgreement : kOtherAgreement;
  return agreement * largest_in_unit(base, figure.unit) + rounding;
}

bool belongs_to(const Figure& figure, const std::string& element) {
  return !element.empty() && figure.name.rfind(element + "_", 0) == 0;
}

// What the changed network's figure must be.
double expected_value(const Figure& figure, const Change& change) {
  double value = figure.value * factor_of(figure.unit, change.factors);
  if (figure.quantity.measure == Measure::mean) value *= change.sign;
  if (is_energy(figure.quantity.measure) || figure.quantity.measure == Measure::stops)
    value *= change.periods;
  return value;
}

void compare(const Case& original, const Answer& base, const Change& change, const Answer& other,
             std::vector<Violation>& violations) {
  const Standing standing = standing_of(base, other);
  Worst worst({change.name, "", 0, 0, 0, standing});
  if (base.has_response() != other.has_response()) {
    worst.check("status" + (other.reason.empty() ? "" : " (" + other.reason + ")"), other.status, base.status,
                0.0);
    worst.add_to(violations);
    return;
  }
  if (!base.has_response()) return;
  const ErrorOfDisplacements error(original);
  const double bounds = base["error_bound"] + other["error_bound"] / change.factors.length;
  for (const Figure& figure : base.figures) {
    if (!is_compared(figure) || belongs_to(figure, change.without)) continue;
    if (figure.quantity.measure == Measure::energy_share && !has_energy(original, base)) continue;
    const Figure* found = other.find(figure.name);
    if (found == nullptr) continue;
    if (figure.quantity.measure == Measure::floquet_radius &&
        (change.periods != 1.0 || standing == Standing::grazing))
      continue;
    // One or several stops is said of a period.
    if (figure.quantity.measure == Measure::regime && change.periods != 1.0) continue;
    double allowed = allowed_difference(figure, original, base) * factor_of(figure.unit, change.factors);
    if (is_energy(figure.quantity.measure)) allowed *= change.periods;
    const double bound = error.in_unit(figure.unit, bounds) * factor_of(figure.unit, change.factors);
    if (bound > allowed) allowed = bound;
    worst.check(figure.name, found->value, expected_value(figure, change), allowed);
  }
  worst.add_to(violations);
}

// One-sided: found <= most.
void at_most(const std::string& invariant, const std::string& figure, double found, double most,
             const Answer& base, std::vector<Violation>& violations) {
  if (found <= most) return;
  violations.push_back({invariant, figure, found, most, 0.0, standing_of(base, base)});
}

void check_contacts(const Case& original, const Answer& base, std::vector<Violation>& violations) {
  Worst stuck({"stuck throughout without stops", "", 0, 0, 0, standing_of(base, base)});
  const double rounding = kRounding * largest_in_unit(base, "N");
  for (std::size_t e = 0; e < original.network.elements.size(); ++e) {
    if (original.network.elements[e].type != mechanics::ElementType::coulomb) continue;
    const std::string& name = original.network.elements[e].name;
    const double limit = original.values.element[e];
    at_most("friction within its limit", name + "_force_peak", base[name + "_force_peak"],
            std::max(limit * kLimit, limit + rounding), base, violations);
    if (base[name + "_regime"] != 5.0) continue;
    stuck.check(name + "_stops", base[name + "_stops"], 0.0, 0.0);
    stuck.check(name + "_stuck_fraction", base[name + "_stuck_fraction"], 1.0, 1e-12);
    stuck.check(name + "_reversals", base[name + "_reversals"], 0.0, 0.0);
  }
  stuck.add_to(violations);
}

// What the answer must be by itself. `where` is the change that it is of.
void check_itself(const Case& asked, const Answer& base, std::vector<Violation>& violations) {
  check_contacts(asked, base, violations);
  if (has_energy(asked, base)) {
    const double rounding = kRounding * largest_in_unit(base, "N") * largest_in_unit(base, "m");
    at_most("energy balance", "energy_balance", base["energy_balance"],
            kBalance + rounding / base["energy_input"], base, violations);
  }
  at_most("residual", "residual", base["residual"], kResidual, base, violations);
  if (base.status == 1)
    at_most("stable", "floquet_radius", base["floquet_radius"], kStable, base, violations);
}

void check_superposition(const Case& original, const Answer& base, std::vector<Violation>& violations) {
  const std::vector<Case> parts = parts_of_excitation(original);
  if (parts.empty() || !base.has_response()) return;
  const Answer first = answer(parts[0]), second = answer(parts[1]);
  if (!first.has_response() || !second.has_response()) return;
  double largest = 0.0;
  for (const Answer* of : {&base, &first, &second}) largest = std::max(largest, largest_in_unit(*of, "m"));
  Worst worst({"superposition", "", 0, 0, 0, standing_of(base, base)});
  for (std::size_t i = 0; i < base.displacements.size(); ++i) {
    for (std::size_t k = 0; k < base.displacements[i].size(); ++k) {
      worst.check(original.network.masses[i] + "_displacement", base.displacements[i][k],
                  first.displacements[i][k] + second.displacements[i][k], kAgreement * largest);
    }
  }
  worst.add_to(violations);
}

const char* name_of_status(int status) {
  constexpr const char* kNames[] = {"refused", "ok", "grazing", "unbounded", "failed"};
  return kNames[status];
}

void count(const Answer& base, Tally* tally) {
  if (tally == nullptr) return;
  ++tally->networks;
  ++tally->statuses[name_of_status(base.status)];
  if (!base.reason.empty()) ++tally->reasons[base.reason];
  if (base.status == 1 && std::isnan(base["error_bound"])) ++tally->without_error_bound;
}

}  // namespace

std::vector<Violation> violations_of(const Case& original, Tally* tally, const std::string& only) {
  std::vector<Violation> violations;
  const Answer base = answer(original);
  count(base, tally);
  if (base.status == 0) return violations;
  if (base.has_response()) check_itself(original, base, violations);
  if (base.status == 4) return violations;  // it has said why, and takes as long each time
  const auto asked = [&](const std::string& invariant) { return only.empty() || only == invariant; };
  for (const Change& change : changes_of(original)) {
    if (!asked(change.name)) continue;
    compare(original, base, change, answer(change.changed), violations);
    if (tally != nullptr && base.status == 1) ++tally->compared[change.name];
  }
  if (asked("end of a sweep"))
    compare(original, base, {"end of a sweep", original, {}}, answer_of_sweep(original), violations);
  if (asked("superposition")) check_superposition(original, base, violations);
  return violations;
}

}  // namespace frahm::invariants
