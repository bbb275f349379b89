#pragma once

#include <functional>
#include <type_traits>
#include <vector>

#include "solvers/flow/linear_form.hpp"
#include "solvers/quantities/orbit_steps.hpp"
#include "solvers/quantities/trace_scan.hpp"

namespace frahm::periodic {

// An orbit as seen through one linear form after the other.
template <int N, int H>
class TracedOrbit {
 public:
  using Form = LinearForm<N, H>;
  using FormOf = std::function<Form(const Mode<N, H>&)>;

  // Looks at the orbit laid out in `steps`, which must outlive what is asked below, through the form that
  // `form_of` gives in each mode.
  void look(OrbitSteps<N, H>& steps, const Flow<N, H>& flow, const FormOf& form_of);

  // section: omega t where the orbit begins [rad].
  Extremes extremes(double section) const {
    const Within within{*this};
    return scan_extremes(trace_, section, flow_->fundamental_rate(), std::cref(within));
  }
  Extremes candidates(double section_sign, std::vector<Candidate>& list) const {
    const Within within{*this};
    return scan_candidates(trace_, section_sign, std::cref(within), list);
  }

 private:
  struct Within {
    const TracedOrbit& traced;
    Polynomial operator()(std::size_t step) const {
      const Form& form = traced.forms_[traced.segment_[step]];
      return form.polynomial(traced.steps_->expand(traced.steps_->steps()[step]));
    }
  };

  OrbitSteps<N, H>* steps_ = nullptr;
  const Flow<N, H>* flow_ = nullptr;
  std::vector<TraceStep> trace_;
  std::vector<Form> forms_;           // of each segment
  std::vector<std::size_t> segment_;  // of each step
};

template <int N, int H>
void TracedOrbit<N, H>::look(OrbitSteps<N, H>& orbit, const Flow<N, H>& flow, const FormOf& form_of) {
  steps_ = &orbit;
  flow_ = &flow;
  const auto steps = orbit.steps();
  trace_.resize(steps.size());
  segment_.resize(steps.size());
  forms_.clear();
  bool starts_segment = true;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const PassageStep<N, H>& step = steps[i];
    if (starts_segment) forms_.push_back(form_of(flow.mode(step.mode)));
    const Form& form = forms_.back();
    trace_[i] = {step.start,          step.length,    form.at(step.left),
                 form.at(step.right), starts_segment, step.ends_segment};
    if (orbit.frame().moves()) {
      const double slower = orbit.frame().rate_of(form.z.head(flow.equations().masses()));
      trace_[i].left.slope -= slower;
      trace_[i].right.slope -= slower;
    }
    segment_[i] = forms_.size() - 1;
    starts_segment = step.ends_segment;
  }
}

// The extremes of the quantity with the form `form_of(mode)`, over an orbit from omega t = section [rad].
template <int N, int H>
Extremes find_extremes(OrbitSteps<N, H>& orbit, const Flow<N, H>& flow, double section,
                       const std::type_identity_t<typename TracedOrbit<N, H>::FormOf>& form_of) {
  TracedOrbit<N, H> traced;
  traced.look(orbit, flow, form_of);
  return traced.extremes(section);
}

extern template class TracedOrbit<1, 1>;
extern template class TracedOrbit<2, 1>;
extern template class TracedOrbit<Eigen::Dynamic, Eigen::Dynamic>;

}  // namespace frahm::periodic
