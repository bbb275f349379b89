#include "studies/map/motion_kernel.hpp"

#include <algorithm>
#include <utility>

#include "solvers/mechanics/linear_system.hpp"
#include "studies/motion/one_motion.hpp"

namespace frahm::studies {

MotionKernel::MotionKernel(const MapPlan& plan, engine::StopAsked stop_asked, KnownPoints* earlier)
    : plan_(plan),
      stop_asked_(std::move(stop_asked)),
      tile_(plan.variables.size(), KnownDigits(plan.study, plan.variables), earlier),
      parameters_(plan.study.parameters.nominal()) {}

void MotionKernel::operator()(std::uint64_t tile, engine::Bytes& out) {
  const MapBox box = plan_.grid.box(tile);
  tile_.open(box);
  index_ = box.start;
  do {
    const std::uint64_t offset = box.offset_of(index_);
    if (tile_.is_known(offset)) continue;
    std::string reason = compute_point();
    tile_.put(offset, values_, std::move(reason));
  } while (next_point(box, plan_.grid.order, index_));
  encode(tile_.entry, out);
}

std::string MotionKernel::compute_point() {
  const Study& study = plan_.study;
  const MapChoice& map = *study.map();
  for (std::size_t d = 0; d < index_.size(); ++d) set_along(map, d, index_[d], parameters_);
  study.parameters.complete(std::span<double>(parameters_));
  const std::size_t record = map.records ? index_[map.records->dimension] : 0;
  std::string reason;
  try {
    transient::ForcedMotion motion = motion_at(study, parameters_, record, options_of_point());
    reason = std::move(motion.failure);
    if (reason.empty()) values_ = std::move(motion.numbers);
  } catch (const mechanics::MechanicsError& error) {
    reason = error.what();
  } catch (const StudyError& error) {
    reason = error.what();
  }
  if (reason.empty()) return reason;
  values_.clear();
  for (const transient::MotionQuantity& quantity : plan_.motion_quantities)
    values_.push_back(transient::missing_value(quantity));
  return reason;
}

// Samples are kept where a run-up is refined until they stand.
transient::ForcedOptions MotionKernel::options_of_point() const {
  transient::ForcedOptions options = forced_options(plan_.study, parameters_);
  if (options.run_up.rate == 0.0) options.samples = 0;
  options.quantities = plan_.motion_quantities;
  options.watch = [this] {
    if (stop_asked_ && stop_asked_()) throw engine::GivenUp{};
  };
  return options;
}

}  // namespace frahm::studies
