// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/fault/operator_messages.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdexcept>
#include <thread>

#include "common/messaging/dds/event_loop.hpp"
#include "common/messaging/dds/presence.hpp"
#include "common/messaging/operator_header.hpp"
#include "common/process/network_text.hpp"
#include "deploy/trial/fault/fault_target.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

constexpr Duration kDiscoveryTimeout = 5s;  ///< longer than the period of participant announcements
/// Discovery counts as complete if no new subscribers appear for this time.
constexpr Duration kDiscoverySettling = 1500ms;
constexpr Duration kSilenceSlack = 2s;  ///< a dead participant is forgotten this much later than the limit
constexpr auto kPollPeriod = 10ms;

template <typename Condition>
bool wait_until(Condition condition) {
  const Time deadline = EventLoop::now() + kDiscoveryTimeout;
  while (!condition()) {
    if (EventLoop::now() > deadline) return false;
    std::this_thread::sleep_for(kPollPeriod);
  }
  return true;
}

}  // namespace

std::vector<std::string> wait_for_targets(OperatorChannel& channel, const DdsSettings& dds,
                                          const std::string& participant, const std::string& remedy) {
  std::vector<std::string> found;
  Time changed_at = EventLoop::now();
  const bool is_complete = wait_until([&] {
    if (const auto now = without_observers(channel.subscribers()); now != found) {
      found = now;
      changed_at = EventLoop::now();
    }
    if (participant.empty()) return !found.empty() && EventLoop::now() - changed_at > kDiscoverySettling;
    return std::ranges::find(found, participant) != found.end();
  });
  if (participant.empty() && !found.empty()) return found;
  if (is_complete) return {participant};
  throw std::runtime_error(fmt::format(
      "{} accepts these faults {}{}{}", participant.empty() ? "no process" : "no " + participant,
      network_text(dds), found.empty() ? "" : fmt::format(", only {}", fmt::join(found, ", ")), remedy));
}

void wait_for_writer(OperatorChannel& channel, const std::string& topic, const std::string& error) {
  if (!wait_until([&] { return channel.has_writer(topic); })) throw std::runtime_error(error);
}

void wait_until_acknowledged(OperatorChannel& channel) {
  if (!channel.wait_until_acknowledged(kSilenceLimit + kSilenceSlack)) {
    throw std::runtime_error(fmt::format("the fault was sent, but not acknowledged by all of {}",
                                         fmt::join(channel.subscribers(), ", ")));
  }
}

msg::Header operator_header() {
  const Time now = EventLoop::now();
  return operator_header(now, 1, now);
}

}  // namespace sidestep
