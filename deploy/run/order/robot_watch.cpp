// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/order/robot_watch.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/messaging/robot_notices.hpp"
#include "common/protocol/agent_state_text.hpp"
#include "common/protocol/senders.hpp"
#include "deploy/run/order/order_text.hpp"

namespace sidestep {
namespace {

// An agent waits for a moment whenever a coordinator takes over.
constexpr Duration kMinWait{500'000'000};
// An active coordinator sends a heartbeat every 20 ms.
constexpr Duration kCoordinatorSilence{1'000'000'000};

bool is_from(RobotId robot, const msg::Header& header) {
  return robot < kMaxRobots && header.sender() == robot;
}

}  // namespace

RobotWatch::RobotWatch(Bus& bus, const OrderClient& orders, bool has_keys)
    : bus_(bus), orders_(orders), has_keys_(has_keys), coordinator_heard_at_(bus.now()) {
  bus.subscribe(topics::kOrderStatus, [this](const msg::OrderStatus& status) { on_order_status(status); });
  if (bus.may_read(topics::kStatus, 0))
    bus.subscribe(topics::kStatus, [this](const msg::AgentStatus& status) { on_agent_status(status); });
  bus.subscribe(topics::kCoordinator,
                [this](const msg::CoordinatorState& state) { on_coordinator_state(state); });
}

void RobotWatch::watch(RobotId robot) {
  const auto [entry, is_new] = rows_.try_emplace(robot);
  if (!is_new) return;
  Row& row = entry->second;
  row.heard_at = row.agent_heard_at = bus_.now();
  row.hears_robot = bus_.may_read(topics::kFeedback, robot);
  if (!row.hears_robot) return;
  bus_.subscribe(topics::kFeedback, robot,
                 [this, robot](const msg::Feedback& message) { on_robot_report(robot, message); });
}

void RobotWatch::on_robot_report(RobotId robot, const msg::Feedback& message) {
  if (!is_from(robot, message.header())) return;
  Row& row = rows_.at(robot);
  row.heard_at = bus_.now();
  row.has_report = true;
  row.is_lifted = message.is_lifted();
}

void RobotWatch::on_order_status(const msg::OrderStatus& status) {
  if (!is_from(status.robot(), status.header())) return;
  if (watches_all_) watch(status.robot());
  const auto row = rows_.find(status.robot());
  if (row != rows_.end()) row->second.agent_heard_at = bus_.now();
}

void RobotWatch::on_agent_status(const msg::AgentStatus& status) {
  if (!is_from(status.robot(), status.header())) return;
  if (watches_all_) watch(status.robot());
  const auto row = rows_.find(status.robot());
  if (row == rows_.end()) return;
  if (row->second.agent_state != status.agent_state()) row->second.agent_state_since = bus_.now();
  row->second.agent_state = status.agent_state();
}

void RobotWatch::on_coordinator_state(const msg::CoordinatorState& state) {
  if (!is_coordinator(state.header().sender())) return;
  coordinator_heard_at_ = bus_.now();
  const bool is_active = state.coordinator_mode() != msg::CoordinatorMode::COORDINATOR_STANDBY &&
                         is_plausible(state.epoch(), bus_.now());
  if (!is_active || (is_active_heard() && state.epoch() < active_.epoch())) return;
  active_ = state;
  active_heard_at_ = bus_.now();
}

bool RobotWatch::is_active_heard() const {
  return active_heard_at_ && bus_.now() - *active_heard_at_ <= kCoordinatorSilence;
}

bool RobotWatch::is_held(RobotId robot, const std::optional<OrderBook>& remembered) const {
  const auto report = orders_.reports().find(robot);
  if (report != orders_.reports().end()) return report->second.is_held;
  return remembered && remembered->is_held(robot);
}

void RobotWatch::add_silences(const Row& row, std::vector<Hindrance>& found) const {
  const Duration agent = bus_.now() - row.agent_heard_at, robot = bus_.now() - row.heard_at;
  const Duration both = bus_.now() - std::max(row.agent_heard_at, coordinator_heard_at_);
  if (both > kAgentSilence) {
    found.push_back({"no agent", "neither a coordinator nor its agent has been heard", both});
    if (has_keys_) found.push_back({"no agent", "this key may have been revoked"});
    return;
  }
  if (agent > kAgentSilence) found.push_back({"no agent", "its agent has sent no report", agent});
  if (row.hears_robot && robot > kRobotSilence) found.push_back({"silent", "it has sent no report", robot});
}

void RobotWatch::add_notices(RobotId robot, std::vector<Hindrance>& found) const {
  if (!is_active_heard()) return;
  const auto names = [robot](const std::vector<RobotId>& robots) {
    return std::ranges::find(robots, robot) != robots.end();
  };
  if (names(quarantined_robots(active_)))
    found.push_back({"waiting", "it is quarantined: nothing is granted to it"});
  if (names(displaced_robots(active_)))
    found.push_back({"waiting", "it is displaced: vision sees it where none of its versions leads"});
}

void RobotWatch::add_agent_state(const Row& row, std::vector<Hindrance>& found) const {
  using enum msg::AgentState;
  if (!row.agent_state || *row.agent_state == AGENT_HELD) return;
  const char* const text = hindrance_text(*row.agent_state);
  if (!text || bus_.now() - row.agent_state_since < kMinWait) return;
  const std::vector<RobotId> missing = is_active_heard() && *row.agent_state == AGENT_WAITING
                                           ? missing_robots(active_)
                                           : std::vector<RobotId>();
  found.push_back({"waiting", missing.empty() ? text
                                              : fmt::format("the coordinator waits for robots {} to register",
                                                            fmt::join(missing, ", "))});
}

std::vector<Hindrance> RobotWatch::hindrances(RobotId robot, const Row& row,
                                              const std::optional<OrderBook>& remembered) const {
  std::vector<Hindrance> found;
  add_silences(row, found);
  if (row.is_lifted || row.agent_state == msg::AgentState::AGENT_ABSENT)
    found.push_back({"off floor", hindrance_text(msg::AgentState::AGENT_ABSENT)});
  if (is_held(robot, remembered))
    found.push_back({"held", held_text(remembered ? remembered->holds_of(robot) : std::vector<Order>())});
  add_notices(robot, found);
  if (found.empty()) add_agent_state(row, found);
  return found;
}

std::vector<Hindrance> RobotWatch::hindrances(RobotId robot) const {
  const auto row = rows_.find(robot);
  if (row == rows_.end()) return {};
  return hindrances(robot, row->second, orders_.remembered_orders());
}

std::map<RobotId, std::vector<Hindrance>> RobotWatch::all_hindrances() const {
  const std::optional<OrderBook> remembered = orders_.remembered_orders();
  std::map<RobotId, std::vector<Hindrance>> all;
  for (const auto& [robot, row] : rows_) {
    std::vector<Hindrance> found = hindrances(robot, row, remembered);
    if (!found.empty()) all[robot] = std::move(found);
  }
  return all;
}

bool RobotWatch::is_complete() const {
  const std::optional<OrderBook> remembered = orders_.remembered_orders();
  return std::ranges::all_of(rows_, [&](const auto& entry) {
    const auto& [robot, row] = entry;
    const bool is_known = !row.hears_robot || row.has_report || bus_.now() - row.heard_at > kRobotSilence;
    return is_known && (remembered || !is_held(robot, remembered));
  });
}

}  // namespace sidestep
