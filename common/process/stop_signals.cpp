// SPDX-License-Identifier: Apache-2.0
#include "common/process/stop_signals.hpp"

#include <csignal>
#include <utility>

namespace sidestep {
namespace {

// Global, because a signal handler takes no user data.
std::function<void()> stop_now, give_up_now;
volatile std::sig_atomic_t is_asked_to_stop = 0;

void handle(int signal) {
  const bool is_repeated = is_asked_to_stop != 0;
  is_asked_to_stop = 1;
  if (is_repeated && signal == SIGINT && give_up_now) return give_up_now();
  if (stop_now) stop_now();
}

}  // namespace

StopSignals::StopSignals(std::function<void()> stop, std::function<void()> give_up) {
  stop_now = std::move(stop);
  give_up_now = std::move(give_up);
  is_asked_to_stop = 0;
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
