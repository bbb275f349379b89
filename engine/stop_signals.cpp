#include "engine/stop_signals.hpp"

#include <atomic>
#include <stdexcept>

namespace frahm::engine {
namespace {

// What a handler may touch: lock-free atomics, shared by all threads.
constexpr int not_listening = -1;
std::atomic<int> first_signal = not_listening;
std::atomic<int> interrupts = 0;
static_assert(std::atomic<int>::is_always_lock_free);

extern "C" void ask_to_stop(int signal) {
  int none = 0;
  first_signal.compare_exchange_strong(none, signal);
  if (signal == SIGINT && interrupts.fetch_add(1) > 0) {
    // Takes effect when this handler returns.
    std::signal(SIGINT, SIG_DFL);
    std::raise(SIGINT);
  }
}

// A signal that is ignored already, as nohup and a shell's jobs in the background have it, stays ignored.
void listen_to(int signal, struct sigaction& before) {
  struct sigaction action {};
  action.sa_handler = ask_to_stop;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  // These cannot fail: the signals exist and may be caught.
  ::sigaction(signal, nullptr, &before);
  if (before.sa_handler != SIG_IGN) ::sigaction(signal, &action, nullptr);
}

}  // namespace

StopSignals::StopSignals() {
  int expected = not_listening;
  if (!first_signal.compare_exchange_strong(expected, 0)) {
    throw std::logic_error("a run is already under way in this process");
  }
  interrupts = 0;
  listen_to(SIGTERM, terminate_before_);
  listen_to(SIGINT, interrupt_before_);
  listen_to(SIGUSR1, user_before_);
}

StopSignals::~StopSignals() {
  ::sigaction(SIGTERM, &terminate_before_, nullptr);
  ::sigaction(SIGINT, &interrupt_before_, nullptr);
  ::sigaction(SIGUSR1, &user_before_, nullptr);
  first_signal = not_listening;
}

int StopSignals::received() const {
  return first_signal;
}

void let_failed_writes_return() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

std::string signal_name(int signal) {
  switch (signal) {
    case SIGTERM:
      return "SIGTERM";
    case SIGINT:
      return "SIGINT";
    case SIGUSR1:
      return "SIGUSR1";
    default:
      return "signal " + std::to_string(signal);
  }
}

}  // namespace frahm::engine
