#include "engine/stop_request.hpp"

#include <fmt/format.h>

namespace frahm::engine {

bool StopRequest::asked() const {
  return signals_.received() != 0 || (called_off_ && *called_off_) || (budget_ && elapsed() >= *budget_);
}

std::string StopRequest::reason() const {
  if (signals_.received() != 0) return "stopped by " + signal_name(signals_.received());
  if (called_off_ && *called_off_) return "called off";
  if (budget_ && elapsed() >= *budget_)
    return fmt::format("the time budget of {} s is used up", budget_->count());
  return "";
}

}  // namespace frahm::engine
