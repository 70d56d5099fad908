// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/end_process.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>

namespace sidestep {
namespace {

using std::chrono::steady_clock;

/// Returns whether the child has ended in time.
bool wait_for_end(Processes& processes, const std::string& name, Processes::Milliseconds timeout) {
  const auto until = steady_clock::now() + timeout;
  for (auto now = steady_clock::now(); now < until; now = steady_clock::now()) {
    const auto events = processes.poll(std::chrono::ceil<Processes::Milliseconds>(until - now));
    const bool has_ended = std::ranges::any_of(events, [&](const ChildEvent& event) {
      return event.kind == ChildEvent::Kind::kDied && event.name == name;
    });
    if (has_ended) return true;
  }
  return false;
}

}  // namespace

void end_process(Processes& processes, const std::string& name, Processes::Milliseconds timeout) {
  if (!processes.send_signal(name, SIGTERM) || wait_for_end(processes, name, timeout)) return;
  if (processes.send_signal(name, SIGKILL)) (void)wait_for_end(processes, name, timeout);
}

}  // namespace sidestep
