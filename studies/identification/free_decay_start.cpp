#include "studies/identification/free_decay_start.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "solvers/identification/free_decay.hpp"
#include "solvers/identification/least_squares.hpp"
#include "solvers/mechanics/system_derivative.hpp"

namespace frahm::studies {
namespace {

using identification::GreyBoxTask, identification::Identification, identification::Model;

// The record for Liang and Feeny's method; the reading of the study ensures that there is one.
std::size_t record_of(const Study& study) {
  const auto& records = study.identify()->records;
  const std::string role = study.network.masses.front() + "_displacement";
  const auto found = std::find_if(records.begin(), records.end(), [&](const RecordChoice& record) {
    return record.motion == identification::MotionKind::free && record.find(role);
  });
  if (found == records.end()) throw std::logic_error("no free record has a displacement");
  return static_cast<std::size_t>(found - records.begin());
}

double estimate_of(const Identification& first, const char* name) {
  const auto found = std::find_if(first.estimates.begin(), first.estimates.end(),
                                  [&](const auto& estimate) { return estimate.name == name; });
  if (found == first.estimates.end()) throw std::logic_error(std::string("no estimate ") + name);
  return found->value;
}

// The values that the model should have: omega_n [rad/s], zeta [1], x_f [m].
struct Wanted {
  double natural_frequency, damping_ratio, friction_displacement;
};

// The distance of one mass from the wanted values, each relative to its scale, and its derivatives:
//   ln(omega_n / wanted),  zeta - wanted,  (x_f - wanted) / x_0
class Distance {
 public:
  Distance(const GreyBoxTask& task, std::size_t record, const Wanted& wanted, double largest)
      : task_(task), record_(record), wanted_(wanted), largest_(largest), assembly_(task.network) {}

  bool operator()(const Eigen::VectorXd& p, Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian) {
    std::vector<double> at(p.data(), p.data() + p.size());
    for (const identification::FixedParameter& fixed : task_.fixed) at.push_back(fixed.value);
    Model model;
    std::vector<Model> derivatives;
    task_.model_at(record_, at, model, jacobian ? &derivatives : nullptr);
    model.values.omega = 1.0;
    try {
      assembly_.set_values(model.values, system_);
    } catch (const mechanics::MechanicsError&) {
      return false;  // a step too far: the solver takes a shorter one
    }
    const double m = system_.M(0, 0), c = system_.C(0, 0), k = system_.K(0, 0);
    const double f = on_mass(system_.limit);
    const double omega = std::sqrt(k / m), zeta = 0.5 * c / std::sqrt(k * m);
    residuals.resize(3);
    residuals << std::log(omega / wanted_.natural_frequency), zeta - wanted_.damping_ratio,
        (f / k - wanted_.friction_displacement) / largest_;
    if (!jacobian) return true;
    jacobian->resize(3, p.size());
    for (Eigen::Index i = 0; i < p.size(); ++i) {
      mechanics::LinearSystem by;
      assembly_.set_forcing(model.values, system_);
      mechanics::differentiate(assembly_, model.values, derivatives[static_cast<std::size_t>(i)].values,
                               system_, by);
      const double dm = by.M(0, 0), dc = by.C(0, 0), dk = by.K(0, 0);
      const double df = on_mass(by.limit);
      jacobian->col(i) << 0.5 * (dk / k - dm / m),
          0.5 * dc / std::sqrt(k * m) - 0.5 * zeta * (dk / k + dm / m), (df - f * dk / k) / (k * largest_);
    }
    return true;
  }

 private:
  // What friction of these limits on the contacts makes on the mass, through levers too.
  double on_mass(const Eigen::VectorXd& limits) const {
    return system_.W.row(0).cwiseAbs().dot(limits.transpose());
  }

  const GreyBoxTask& task_;
  std::size_t record_;
  Wanted wanted_;
  double largest_;
  mechanics::Assembly assembly_;
  mechanics::LinearSystem system_;
};

}  // namespace

Identification first_estimates(const Study& study) {
  const RecordChoice& record = study.identify()->records[record_of(study)];
  const DataColumn* displacement = record.find(study.network.masses.front() + "_displacement");
  return identification::free_decay(record.find("time")->values, displacement->values,
                                    identification::FreeDecayOptions{});
}

void set_start(const Study& study, const Identification& first, GreyBoxTask& task) {
  const std::size_t record = record_of(study);
  const Wanted wanted{estimate_of(first, "natural_frequency"),
                      std::max(0.0, estimate_of(first, "damping_ratio")),
                      std::max(0.0, estimate_of(first, "friction_displacement"))};
  double largest = 0.0;
  for (const identification::Channel& channel : task.records[record].channels) {
    if (channel.signal != identification::Signal::displacement) continue;
    for (const double value : channel.values) largest = std::max(largest, std::abs(value));
  }
  std::vector<identification::Unknown> unknowns;
  for (const identification::FittedParameter& parameter : task.parameters) {
    const double size = std::abs(parameter.start);
    unknowns.push_back({.name = parameter.name,
                        .start = parameter.start,
                        .lower = parameter.lower,
                        .upper = parameter.upper,
                        .scale = size > 0.0 ? size : 1.0});
  }
  const identification::LeastSquaresFit fit =
      identification::least_squares(unknowns, Distance(task, record, wanted, largest));
  for (std::size_t i = 0; i < task.parameters.size(); ++i)
    task.parameters[i].start = fit.p[static_cast<Eigen::Index>(i)];
}

}  // namespace frahm::studies
