// SPDX-License-Identifier: Apache-2.0
#include "common/process/stop_signals.hpp"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <utility>

namespace sidestep {
namespace {

// Global, because a signal handler takes no user data.
std::function<void()> stop_now, give_up_now;

/// When the first signal arrived, by the steady clock; 0: none has.
std::atomic<std::int64_t> first_signal_ms{0};
static_assert(std::atomic<std::int64_t>::is_always_lock_free, "used by a signal handler");

std::int64_t steady_ms() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return std::int64_t{t.tv_sec} * 1000 + t.tv_nsec / 1'000'000;
}

void handle(int signal) {
  const int saved_errno = errno;
  const std::int64_t now_ms = steady_ms();
  std::int64_t first_ms = 0;
  const bool is_repeated = !first_signal_ms.compare_exchange_strong(first_ms, now_ms) &&
                           now_ms - first_ms >= StopSignals::kSameRequest.count();
  if (is_repeated && signal == SIGINT && give_up_now)
    give_up_now();
  else if (stop_now)
    stop_now();
  errno = saved_errno;
}

}  // namespace

StopSignals::StopSignals(std::function<void()> stop, std::function<void()> give_up) {
  stop_now = std::move(stop);
  give_up_now = std::move(give_up);
  first_signal_ms = 0;
  struct sigaction action {};
  action.sa_handler = handle;
  // Neither signal interrupts the handler of the other.
  sigaddset(&action.sa_mask, SIGINT);
  sigaddset(&action.sa_mask, SIGTERM);
  sigaction(SIGINT, &action, &old_int_);
  sigaction(SIGTERM, &action, &old_term_);
}

StopSignals::~StopSignals() {
  sigaction(SIGINT, &old_int_, nullptr);
  sigaction(SIGTERM, &old_term_, nullptr);
  stop_now = nullptr;
  give_up_now = nullptr;
}

}  // namespace sidestep
