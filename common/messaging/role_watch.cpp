// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/role_watch.hpp"

#include <cmath>
#include <fmt/format.h>

#include "common/protocol/process_names.hpp"
#include "common/protocol/senders.hpp"

namespace sidestep {
namespace {

// Bounded, because a hostile sender may invent any number of processes.
constexpr std::size_t kMaxOthers = 16;

bool is(std::uint32_t process, Sender sender) { return process == static_cast<std::uint32_t>(sender); }

}  // namespace

bool must_be_alone(std::uint32_t process) {
  return is(process, Sender::kSimulator) || is(process, Sender::kVision) || is(process, Sender::kReferee);
}

RoleWatch::RoleWatch(Bus& bus, std::uint32_t process, Incarnation incarnation,
                     std::function<void(Incarnation)> on_other)
    : bus_(bus), process_(process), incarnation_(incarnation), on_other_(std::move(on_other)) {
  if (must_be_alone(process) || is_coordinator(process))
    bus_.subscribe(topics::kCounters, [this](const msg::Counters& message) { on_counters(message); });
}

void RoleWatch::on_counters(const msg::Counters& message) {
  const Incarnation incarnation = message.header().incarnation();
  const bool is_own = message.process() == process_ && message.header().sender() == process_;
  if (!is_own || incarnation == incarnation_) return;
  if (others_.size() >= kMaxOthers && !others_.contains(incarnation)) {
    const auto heard = [](const auto& other) { return other.second.first_heard; };
    others_.erase(std::ranges::min_element(others_, {}, heard));
  }
  const auto [entry, is_new] =
      others_.try_emplace(incarnation, Other{bus_.now(), message.header().message_number()});
  Other& other = entry->second;
  if (is_new || other.is_confirmed || message.header().message_number() <= other.first_number) return;
  if (bus_.now() - other.first_heard < kConfirmation) return;
  other.is_confirmed = true;
  on_other_(incarnation);
}

std::string describe_other(std::uint32_t process, Incarnation own, Incarnation other) {
  const std::string name = process_name(process);
  const double by_s = to_seconds(Duration{static_cast<std::int64_t>(own - other)});
  return fmt::format(
      "another {} is running in this domain; it started {:.1f} s {}, and there must be only one", name,
      std::abs(by_s), by_s > 0 ? "earlier" : "later");
}

std::string describe_conflict(const TopicInfo& topic, std::uint32_t robot, const msg::Header& header) {
  return fmt::format(
      "two processes send '{}' as {}; their messages on this topic are ignored until one of them exits",
      channel_name(topic, robot),
      topic.per_robot ? fmt::format("robot {}", robot) : process_name(header.sender()));
}

}  // namespace sidestep
