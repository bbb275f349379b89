// Preloaded into a program (LD_PRELOAD), makes its wall clock jump back and forth by hours from look to look,
// as an operator or a wrong time server might. The monotonic clock goes on as ever.
#include <dlfcn.h>
#include <sys/time.h>

#include <atomic>
#include <ctime>

namespace {

// What is added to the time at this look [s].
time_t jump() {
  constexpr time_t hours = 5 * 3600;
  static std::atomic<unsigned> looks = 0;
  switch (looks++ % 3) {
    case 0:
      return 0;
    case 1:
      return hours;
    default:
      return -hours;
  }
}

timespec jumping_time() {
  using Clock = int(clockid_t, timespec*);
  static const auto real = reinterpret_cast<Clock*>(::dlsym(RTLD_NEXT, "clock_gettime"));
  timespec now{};
  real(CLOCK_REALTIME, &now);
  now.tv_sec += jump();
  return now;
}

}  // namespace

extern "C" {

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  using Clock = int(clockid_t, timespec*);
  static const auto real = reinterpret_cast<Clock*>(::dlsym(RTLD_NEXT, "clock_gettime"));
  if (clock != CLOCK_REALTIME && clock != CLOCK_REALTIME_COARSE) return real(clock, time);
  *time = jumping_time();
  return 0;
}

time_t time(time_t* result) noexcept {
  const time_t now = jumping_time().tv_sec;
  if (result != nullptr) *result = now;
  return now;
}

int gettimeofday(timeval* result, void*) noexcept {
  const timespec now = jumping_time();
  result->tv_sec = now.tv_sec;
  result->tv_usec = now.tv_nsec / 1000;
  return 0;
}

}  // extern "C"
