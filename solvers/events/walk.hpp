#pragma once

#include <algorithm>
#include <limits>

#include "solvers/events/passage.hpp"
#include "solvers/events/passage_steps.hpp"
#include "solvers/events/workspace.hpp"

namespace frahm::periodic {

struct GuardEvent;  // events/search.hpp
struct BendEvent;   // events/bend_guards.hpp

// Follows motions on a flow, one passage after the other. It has the workspace; the flow has none.
template <int N, int H>
class Walk {
 public:
  using S = Sizes<N, H>;

  explicit Walk(Flow<N, H>& flow) : flow_(flow) {}

  // The flow from state z at `phase` (omega t) [rad] over `length` steps. held: contacts that stick
  // regardless of their force, to test whether they stick throughout. steps: to keep the steps taken in;
  // null: they are not kept.
  void pass(const typename S::State& z, double phase, double length, Passage<N, H>& passage,
            Tangent tangent = Tangent::followed, ContactMask held = 0, PassageSteps<N, H>* steps = nullptr);

  // The same without a tangent from where the last passage ended, which `phase` is of too, under what drives
  // the flow now (Flow::set_recorded).
  void go_on(double phase, double length, Passage<N, H>& passage, PassageSteps<N, H>* steps);

 private:
  void open(double phase, Passage<N, H>& passage, PassageSteps<N, H>* steps);
  bool keeps_mode(double phase);
  void enter(double phase, ContactMask stuck_before = 0);
  void begin(Passage<N, H>& passage);
  void follow(double phase, double length, Passage<N, H>& passage);
  void begin_tangent(Passage<N, H>& passage) const;
  std::vector<int> stopped_at_start() const;
  bool starts_at_limit(Eigen::Index contact, double speed);
  void take_step(Passage<N, H>& passage);
  void move_tangent(double steps, Passage<N, H>& passage);
  void end_stretch(Passage<N, H>& passage);
  void advance(double fraction, double phase, Passage<N, H>& passage);
  PassageStep<N, H>* keep_step(double length);
  void pass_event(const GuardEvent& event, double phase, Passage<N, H>& passage);
  void pass_share(const GuardEvent& event, double phase, Passage<N, H>& passage);
  void pass_bend(const BendEvent& event, double phase, Passage<N, H>& passage);
  bool is_here(double fraction) const {
    constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();
    return fraction <= std::max(kSameInstant, kRounding * w_.clock);
  }
  void saltate(ContactMask released, Passage<N, H>& passage);
  void catch_contacts(ContactMask arrived, const Mode<N, H>& mode_before, Passage<N, H>& passage);
  Event* change_here(Passage<N, H>& passage) const;
  void arrive_at(double fraction, double phase, Passage<N, H>& passage);
  void note_change(const GuardEvent& event, const Mode<N, H>& mode_before, Passage<N, H>& passage) const;
  void open_segment(Passage<N, H>& passage);

  Flow<N, H>& flow_;
  Workspace<N, H> w_;
  PassageSteps<N, H>* steps_ = nullptr;  // of the current passage
};

extern template class Walk<1, 1>;
extern template class Walk<2, 1>;
extern template class Walk<Eigen::Dynamic, Eigen::Dynamic>;

}  // namespace frahm::periodic
