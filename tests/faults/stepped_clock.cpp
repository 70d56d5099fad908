// SPDX-License-Identifier: Apache-2.0
// A library for LD_PRELOAD: adds an offset to this process's CLOCK_REALTIME, so that a test can set the clock
// of a simulated host. The offset is the number of nanoseconds at the start of the file that the environment
// variable SIDESTEP_TEST_CLOCK names; it may change at any time.
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

namespace {

using Offset = std::atomic<std::int64_t>;

const Offset* open_offset() {
  const char* const path = std::getenv("SIDESTEP_TEST_CLOCK");
  const int file = path ? open(path, O_RDONLY | O_CLOEXEC) : -1;
  if (file < 0) std::abort();
  void* const page = mmap(nullptr, sizeof(Offset), PROT_READ, MAP_SHARED, file, 0);
  close(file);
  if (page == MAP_FAILED) std::abort();
  return static_cast<const Offset*>(page);
}

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* t) noexcept {
  static const Offset* const offset = open_offset();
  const long result = syscall(SYS_clock_gettime, clock, t);
  if (clock != CLOCK_REALTIME || result != 0) return static_cast<int>(result);
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  const std::int64_t ns = t->tv_sec * kSecond_ns + t->tv_nsec + offset->load();
  *t = {ns / kSecond_ns, ns % kSecond_ns};
  return 0;
}
