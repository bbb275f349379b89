#include "studies/map/tornado_group.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include "solvers/algebra/no_value.hpp"
#include "solvers/mechanics/linear_system.hpp"
#include "solvers/mechanics/smooth_laws.hpp"
#include "solvers/response/periodic_response.hpp"
#include "solvers/samples/scatter.hpp"
#include "studies/map/statistics_group.hpp"
#include "studies/provenance/assembly_stage.hpp"
#include "studies/provenance/result_variables.hpp"

namespace frahm::studies {
namespace {

// The uncertain parameters: their indices, and the moments of their samples (SI).
struct Uncertain {
  std::vector<std::size_t> parameters;
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

Uncertain uncertain_of(const Study& study) {
  const SweepChoice& sweep = *study.sweep();
  Uncertain uncertain;
  Eigen::MatrixXd samples(sweep.dimensions[sweep.samples->dimension].size, sweep.samples->axes.size());
  for (Eigen::Index p = 0; p < samples.cols(); ++p) {
    const ParameterAxis& axis = sweep.axes[sweep.samples->axes[static_cast<std::size_t>(p)]];
    uncertain.parameters.push_back(axis.parameter);
    samples.col(p) = Eigen::Map<const Eigen::VectorXd>(axis.si_values.data(), samples.rows());
  }
  uncertain.mean = samples::means(samples);
  uncertain.covariance = samples::covariance(samples);
  return uncertain;
}

// Solves the points of /tornado; each thread has one.
class TornadoMaking {
 public:
  TornadoMaking(const MapPlan& plan, const Grid& beside, const Uncertain& uncertain,
                GroupBesideSamples& group)
      : plan_(plan),
        beside_(beside),
        uncertain_(uncertain),
        group_(group),
        quantities_(tornado_quantities(plan)),
        response_(plan.study.network, quantities_, periodic::Path::fastest, plan.study.orbits_wanted()),
        parameters_(plan.study.parameters.nominal()) {}

  std::function<void()> make(std::uint64_t number) {
    const MapBox box = beside_.chunk_box(number);
    const std::size_t each = 2 + 2 * uncertain_.parameters.size();
    std::vector<double> table(each * quantities_.size() * box.points(), kNone);
    std::vector<std::size_t> dimensions(box.start.size());
    std::iota(dimensions.begin(), dimensions.end(), std::size_t{0});
    std::vector<std::uint64_t> index = box.start;
    response_.forget();
    std::size_t point = 0;
    do {
      solve(index);
      for (std::size_t v = 0; v < row_.size(); ++v) table[v * box.points() + point] = row_[v];
      ++point;
    } while (next_point(box, dimensions, index));
    GroupBesideSamples::Chunk chunk(group_, box.start);
    for (std::size_t v = 0; v < row_.size(); ++v)
      chunk.put(v, box, std::span(table).subspan(v * box.points(), box.points()));
    return chunk.writing();
  }

 private:
  // The variables at a point apart from the samples, into row_.
  void solve(const std::vector<std::uint64_t>& index) {
    const Study& study = plan_.study;
    const std::size_t n = uncertain_.parameters.size();
    row_.assign((2 + 2 * n) * quantities_.size(), kNone);
    for (std::size_t d = 0; d < index.size(); ++d)
      set_along(*study.sweep(), d < study.map()->samples->dimension ? d : d + 1, index[d], parameters_);
    for (std::size_t p = 0; p < n; ++p)
      parameters_[uncertain_.parameters[p]] = uncertain_.mean(static_cast<Eigen::Index>(p));
    evaluate(study.values, study.parameters, parameters_, values_);
    std::vector<mechanics::NetworkValues> directions(n);
    for (std::size_t p = 0; p < n; ++p)
      differentiate(study.values, study.parameters, parameters_, uncertain_.parameters[p], directions[p]);
    try {
      response_.set_values(values_);
    } catch (const mechanics::MechanicsError&) {
      return;  // no value
    }
    response_.begin_row();
    response_.solve();
    std::vector<double> found(quantities_.size()), gradient(n * quantities_.size());
    response_.quantities(found);
    response_.gradient(directions, gradient);
    for (std::size_t q = 0; q < quantities_.size(); ++q) note(q, found[q], gradient);
  }

  void note(std::size_t q, double value, const std::vector<double>& gradient) {
    const std::size_t n = uncertain_.parameters.size();
    Eigen::VectorXd g(static_cast<Eigen::Index>(n));
    for (std::size_t p = 0; p < n; ++p)
      g(static_cast<Eigen::Index>(p)) = gradient[p * quantities_.size() + q];
    const Eigen::VectorXd to = uncertain_.covariance * g;
    const double variance = g.dot(to);
    double* row = row_.data() + q * (2 + 2 * n);
    *row++ = value;
    *row++ = std::isnan(variance) ? kNone : std::sqrt(std::max(0.0, variance));
    for (Eigen::Index p = 0; p < g.size(); ++p) {
      *row++ = g(p) * std::sqrt(uncertain_.covariance(p, p));
      *row++ = variance > 0.0 ? g(p) * to(p) / variance : kNone;
    }
  }

  const MapPlan& plan_;
  const Grid& beside_;
  const Uncertain& uncertain_;
  GroupBesideSamples& group_;
  std::vector<periodic::Quantity> quantities_;
  periodic::PeriodicResponse response_;
  std::vector<double> parameters_;  // SI
  mechanics::NetworkValues values_;
  std::vector<double> row_;
};

}  // namespace

std::vector<periodic::Quantity> tornado_quantities(const MapPlan& plan) {
  std::vector<periodic::Quantity> quantities;
  if (!plan.study.sweep()) return quantities;
  if (mechanics::has_smooth_law(plan.study.network) || plan.study.sweep()->orbits.is_slow_sweep())
    return quantities;
  for (const periodic::Quantity& quantity : plan.quantities) {
    const auto described = periodic::describe(quantity, plan.study.network, plan.study.dimensionless);
    if (periodic::is_differentiable(quantity.measure) && has_statistics(described))
      quantities.push_back(quantity);
  }
  return quantities;
}

std::vector<results::Variable> tornado_variables(const MapPlan& plan) {
  const MapChoice& map = *plan.study.map();
  std::vector<results::Variable> variables;
  for (const periodic::Quantity& quantity : tornado_quantities(plan)) {
    const auto of = periodic::describe(quantity, plan.study.network, plan.study.dimensionless);
    variables.push_back(variable({"*_at_mean", {of.name}, {of.long_name}}, of.unit));
    variables.push_back(variable({"*_first_order_deviation", {of.name}, {of.long_name}}, of.unit));
    for (const std::size_t axis : map.samples->axes) {
      const std::string& name = plan.study.parameters.list[map.axes[axis].parameter].name;
      variables.push_back(variable({"*_by_*", {of.name, name}, {of.long_name, name}}, of.unit));
      variables.push_back(variable({"*_share_*", {of.name, name}, {name, of.long_name}}, "1"));
    }
  }
  return variables;
}

void write_tornado(const MapPlan& plan, const results::MapLayout& map, const AssemblyOptions& options,
                   results::MapWriter& writer) {
  if (!plan.study.map()->samples) return;
  std::vector<results::Variable> variables = tornado_variables(plan);
  if (variables.empty()) return;
  GroupBesideSamples group(writer, tornado_group, layout_beside_samples(plan, map, std::move(variables)));
  const Grid beside = grid_beside_samples(plan);
  const Uncertain uncertain = uncertain_of(plan.study);
  const auto make_work = [&]() -> engine::PieceWork {
    // Shared, as a PieceWork has to be copyable.
    auto making = std::make_shared<TornadoMaking>(plan, beside, uncertain, group);
    return [making](std::uint64_t number) { return making->make(number); };
  };
  carry_out({.name = "tornado",
             .pieces = beside.chunks(),
             .points = beside.points(),
             .points_of = [&](std::uint64_t chunk) { return beside.chunk_box(chunk).points(); },
             .make_work = make_work},
            options);
}

}  // namespace frahm::studies
