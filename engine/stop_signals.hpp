#pragma once

#include <csignal>
#include <string>

namespace frahm::engine {

// As long as it lives, SIGTERM, SIGINT and SIGUSR1 ask the run to stop instead of ending the process; a
// second SIGINT ends it at once. One of them that is ignored stays ignored. The previous handlers are
// restored afterwards. Only one may exist at a time (std::logic_error): signals belong to the process.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  // The first signal received, 0 if none.
  int received() const;

 private:
  struct sigaction terminate_before_ {};
  struct sigaction interrupt_before_ {};
  struct sigaction user_before_ {};
};

// From now on a write to a pipe whose reader has gone, or beyond the size a file may have (ulimit -f), fails
// instead of ending the process.
void let_failed_writes_return();

// "SIGTERM", "SIGINT", "SIGUSR1".
std::string signal_name(int signal);

}  // namespace frahm::engine
