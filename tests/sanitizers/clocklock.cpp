// SPDX-License-Identifier: Apache-2.0
// Linked into every program built with the thread sanitizer. The sanitizer's library of g++ 12 does not
// intercept pthread_mutex_clocklock(), with which Fast DDS locks mutexes with a deadline. Without this
// replacement it would consider each such mutex unlocked and report false data races.
#include <cstdint>
#include <pthread.h>
#include <time.h>

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

std::int64_t in_ns(const timespec& t) { return std::int64_t{t.tv_sec} * kSecond_ns + t.tv_nsec; }

std::int64_t now_ns(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return in_ns(t);
}

}  // namespace

extern "C" [[gnu::visibility("default")]] int pthread_mutex_clocklock(pthread_mutex_t* mutex, clockid_t clock,
                                                                      const timespec* until) noexcept {
  const std::int64_t until_ns = in_ns(*until) - now_ns(clock) + now_ns(CLOCK_REALTIME);
  const timespec real_until{until_ns / kSecond_ns, until_ns % kSecond_ns};
  return pthread_mutex_timedlock(mutex, &real_until);
}
