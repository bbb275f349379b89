#pragma once

#include <span>
#include <vector>

#include "solvers/flow/flow.hpp"

namespace frahm::periodic {

// A step of one mode, with a Taylor expansion on request.
template <int N, int H>
struct PassageStep {
  double start = 0.0;   // [steps] since the passage began
  double length = 1.0;  // (0, 1]; shorter at the end of a segment
  std::size_t mode = 0;
  bool ends_segment = false;
  Instant<N, H> left, right;  // both seen from inside the step's mode
  Expansion<N, H> expansion;
  bool expanded = false;
};

// The steps of a passage, in their order: those a walk has taken (Walk::pass), or laid out again from the
// passage's segments (OrbitSteps).
template <int N, int H>
class PassageSteps {
 public:
  explicit PassageSteps(const Flow<N, H>& flow) : flow_(flow) {}

  void clear() { count_ = 0; }
  PassageStep<N, H>& add() {
    if (count_ == steps_.size()) steps_.resize(count_ == 0 ? 64 : 2 * count_);
    steps_[count_].expanded = steps_[count_].ends_segment = false;
    return steps_[count_++];
  }
  // The last step, if there is one, is the end of its segment.
  void end_segment() {
    if (count_ > 0) steps_[count_ - 1].ends_segment = true;
  }

  const Expansion<N, H>& expand(PassageStep<N, H>& step) const {
    if (!step.expanded) flow_.expand(step.left, flow_.mode(step.mode), step.expansion);
    step.expanded = true;
    return step.expansion;
  }

  std::span<PassageStep<N, H>> steps() { return {steps_.data(), count_}; }
  std::span<const PassageStep<N, H>> steps() const { return {steps_.data(), count_}; }

 protected:
  const Flow<N, H>& flow_;

 private:
  std::vector<PassageStep<N, H>> steps_;
  std::size_t count_ = 0;
};

}  // namespace frahm::periodic
