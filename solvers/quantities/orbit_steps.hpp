#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "solvers/orbits/orbit.hpp"

namespace frahm::periodic {

// An orbit laid out in steps of one mode each, from its section on. A step has a Taylor expansion on request.
template <int N, int H>
struct OrbitStep {
  double start = 0.0;   // [steps] since the section
  double length = 1.0;  // (0, 1]; shorter at the end of a segment
  std::size_t mode = 0;
  bool ends_segment = false;
  Instant<N, H> left, right;  // both seen from inside the step's mode
  Expansion<N, H> expansion;
  bool expanded = false;
};

template <int N, int H>
class OrbitSteps {
 public:
  explicit OrbitSteps(const Flow<N, H>& flow) : flow_(flow) {}

  void lay_out(const Orbit<N, H>& orbit) {
    count_ = 0;
    for (const Segment<N, H>& segment : orbit.passage.segments) {
      const Mode<N, H>& mode = flow_.mode(segment.mode);
      typename Sizes<N, H>::State z = segment.z;
      for (double done = 0.0; done < segment.length;) {
        OrbitStep<N, H>& step = next();
        step.start = segment.start + done;
        step.length = std::min(1.0, segment.length - done);
        step.mode = segment.mode;
        const double phase = orbit.section + step.start * flow_.fundamental_rate();
        if (done == 0.0)
          flow_.instant_at(z, phase, mode, step.left);
        else
          step.left = steps_[count_ - 2].right;
        if (step.length == 1.0) {
          step.expanded = flow_.step(step.left, mode, step.right, step.expansion);
        } else {
          expand(step);
          Flow<N, H>::evaluate(step.expansion, step.length, z);
          flow_.instant_at(z, phase + step.length * flow_.fundamental_rate(), mode, step.right);
        }
        done += 1.0;
        step.ends_segment = done >= segment.length;
      }
    }
  }

  const Expansion<N, H>& expand(OrbitStep<N, H>& step) const {
    if (!step.expanded) flow_.expand(step.left, flow_.mode(step.mode), step.expansion);
    step.expanded = true;
    return step.expansion;
  }

  std::span<OrbitStep<N, H>> steps() { return {steps_.data(), count_}; }
  std::span<const OrbitStep<N, H>> steps() const { return {steps_.data(), count_}; }

 private:
  OrbitStep<N, H>& next() {
    if (count_ == steps_.size()) steps_.resize(count_ == 0 ? 64 : 2 * count_);
    steps_[count_].expanded = false;
    return steps_[count_++];
  }

  const Flow<N, H>& flow_;
  std::vector<OrbitStep<N, H>> steps_;
  std::size_t count_ = 0;
};

}  // namespace frahm::periodic
