#include "engine/team.hpp"

#include <omp.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <mutex>
#include <string_view>

namespace frahm::engine {
namespace {

struct Team {
  const std::function<void(const std::atomic<bool>&)>& work;
  std::atomic<bool> failed = false;
  std::mutex first_error_turn;
  std::exception_ptr first_error;
  // Orders what happens before, in and after the team in the C++ memory model. OpenMP's own barriers do so
  // too, but those of GCC's runtime are invisible to ThreadSanitizer, which would see races everywhere.
  std::atomic<int> handover = 0;
};

void take_part(Team& team) {
  team.handover.load(std::memory_order_acquire);
  try {
    team.work(team.failed);
  } catch (...) {  // must not leave an OpenMP region; run_team returns it
    const std::lock_guard turn(team.first_error_turn);
    if (!team.first_error) team.first_error = std::current_exception();
    team.failed = true;
  }
  team.handover.fetch_add(1, std::memory_order_release);
}

// Without ThreadSanitizer, as the handing over of `team` itself precedes the handover above.
__attribute__((no_sanitize("thread"))) void in_parallel(int threads, Team& team) {
#pragma omp parallel num_threads(threads)
  take_part(team);
}

}  // namespace

int default_threads(const Ranks* ranks) {
  if (std::getenv("OMP_NUM_THREADS")) return omp_get_max_threads();
  if (const char* text = std::getenv("SLURM_CPUS_PER_TASK")) {
    const std::string_view digits(text);
    int processors = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), processors);
    if (processors > 0) return std::min(processors, omp_get_num_procs());
  }
  return ranks ? ranks->processors() : omp_get_num_procs();
}

int team_size(int wanted, std::uint64_t pieces) {
  const auto most = static_cast<std::uint64_t>(wanted > 0 ? wanted : default_threads());
  return static_cast<int>(std::clamp<std::uint64_t>(pieces, 1, most));
}

std::exception_ptr run_team(int threads, const std::function<void(const std::atomic<bool>& failed)>& work) {
  Team team{.work = work, .first_error_turn = {}, .first_error = {}};
  team.handover.store(0, std::memory_order_release);
  in_parallel(threads, team);
  team.handover.load(std::memory_order_acquire);
  return team.first_error;
}

}  // namespace frahm::engine
