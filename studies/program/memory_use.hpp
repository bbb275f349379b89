#pragma once

namespace frahm::studies {

// The memory that a run takes, from a sample of its work on one thread, which is done between the making of
// this and the question.
class MemoryUse {
 public:
  MemoryUse();
  // What the process held before the sample and, once for each thread, what the sample held at its most
  // [bytes].
  double of_run(int threads) const;

 private:
  double before_;
};

}  // namespace frahm::studies
