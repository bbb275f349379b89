#pragma once

#include <algorithm>

#include "solvers/events/passage_steps.hpp"
#include "solvers/orbits/orbit.hpp"

namespace frahm::periodic {

// An orbit laid out in steps of one mode each, from its section on.
template <int N, int H>
class OrbitSteps : public PassageSteps<N, H> {
 public:
  using PassageSteps<N, H>::PassageSteps;

  void lay_out(const Orbit<N, H>& orbit) {
    const Flow<N, H>& flow = this->flow_;
    this->clear();
    for (const Segment<N, H>& segment : orbit.passage.segments) {
      const Mode<N, H>& mode = flow.mode(segment.mode);
      typename Sizes<N, H>::State z = segment.z;
      for (double done = 0.0; done < segment.length;) {
        PassageStep<N, H>& step = this->add();
        step.start = segment.start + done;
        step.length = std::min(1.0, segment.length - done);
        step.mode = segment.mode;
        const double phase = orbit.section + step.start * flow.fundamental_rate();
        if (done == 0.0)
          flow.instant_at(z, phase, mode, step.left);
        else
          step.left = this->steps()[this->steps().size() - 2].right;
        if (step.length == 1.0) {
          step.expanded = flow.step(step.left, mode, step.right, step.expansion);
        } else {
          this->expand(step);
          Flow<N, H>::evaluate(step.expansion, step.length, z);
          flow.instant_at(z, phase + step.length * flow.fundamental_rate(), mode, step.right);
        }
        done += 1.0;
        step.ends_segment = done >= segment.length;
      }
    }
  }
};

}  // namespace frahm::periodic
