// SPDX-License-Identifier: Apache-2.0
#include "common/process/stop_signals.hpp"

#include <utility>

namespace sidestep {
namespace {

// Global, because a signal handler takes no user data.
std::function<void()> stop_now;

void handle(int) {
  if (stop_now) stop_now();
}

}  // namespace

StopSignals::StopSignals(std::function<void()> stop) {
  stop_now = std::move(stop);
  struct sigaction action {};
  action.sa_handler = handle;
  sigaction(SIGINT, &action, &old_int_);
  sigaction(SIGTERM, &action, &old_term_);
}

StopSignals::~StopSignals() {
  sigaction(SIGINT, &old_int_, nullptr);
  sigaction(SIGTERM, &old_term_, nullptr);
  stop_now = nullptr;
}

}  // namespace sidestep
