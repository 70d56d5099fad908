// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/order_clients.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "common/protocol/client_text.hpp"
#include "common/protocol/process_names.hpp"
#include "simulator/world/body.hpp"

namespace sidestep {
namespace {

constexpr double kRestSpeed_mps = 0.01;
constexpr auto kOperator = static_cast<ClientId>(Sender::kOperator);

bool drives(const Order& order) {
  return order.kind == msg::OrderKind::ORDER_GO || order.kind == msg::OrderKind::ORDER_CANCEL;
}

}  // namespace

OrderClients::OrderClients(SimSystem& system, const Scenario& scenario)
    : touching_distance_m_(2 * scenario.radius_m + kContactTolerance_m),
      time_to_coast_(from_seconds(scenario.limits.speed_mps / Body::kRolling_mps2)),
      system_(system),
      bus_(system.network()) {
  bus_.become_observer();
  bus_.subscribe<msg::GroundTruth>(topics::kTruth, [this](const auto& truth) { on_truth(truth); });
  bus_.subscribe<msg::OrderMemory>(topics::kOrderMemory, [this](const auto& page) { on_memory(page); });
}

OrderClients::Client& OrderClients::client_of(ClientId id) {
  std::unique_ptr<Client>& client = clients_[id];
  if (!client) {
    client = std::make_unique<Client>(system_.network(), id);
    client->orders.on_change([this, id](const SentOrder& sent) { on_change(id, sent); });
  }
  return *client;
}

void OrderClients::give(const Order& order) {
  Client& client = client_of(order.client);
  switch (order.kind) {
    case msg::OrderKind::ORDER_GO:
      client.given.push_back(client.orders.go(order.robot, order.goals));
      break;
    case msg::OrderKind::ORDER_CANCEL:
      client.given.push_back(client.orders.cancel(order.robot));
      break;
    case msg::OrderKind::ORDER_HOLD:
      client.given.push_back(client.orders.hold(order.robot));
      holds_.push_back({order.client, order.robot, client.given.back()});
      break;
    case msg::OrderKind::ORDER_RESUME:
      client.given.push_back(client.orders.resume(order.robot));
      lift(order);
      break;
    case msg::OrderKind::ORDER_ZONE:
      client.orders.zone(order.zone_number, order.zone);
      break;
    case msg::OrderKind::ORDER_REMOVE_ZONE:
      client.orders.remove_zone(order.zone_number);
      break;
  }
}

void OrderClients::stop_judging(const std::string& coordinator) {
  if (const auto process = process_id(coordinator)) excused_.insert(*process);
}

void OrderClients::lift(const Order& resume) {
  std::erase_if(holds_, [&](Hold& hold) {
    if (resume.client != kOperator && resume.client != hold.client) return false;
    if (resume.robot == kAllRobots || resume.robot == hold.robot) return true;
    if (hold.robot == kAllRobots) hold.released.insert(resume.robot);
    return false;
  });
}

void OrderClients::on_change(ClientId client, const SentOrder& sent) {
  if (sent.phase != OrderPhase::kAccepted) return;
  for (Hold& hold : holds_) {
    const bool is_new = hold.client == client && hold.handle == sent.handle && !hold.confirmed_at;
    if (is_new) hold.confirmed_at = system_.now();
  }
}

const OrderClients::Hold* OrderClients::hold_of(RobotId robot) const {
  const Hold* longest = nullptr;
  for (const Hold& hold : holds_) {
    const bool holds = hold.confirmed_at && (hold.robot == robot || hold.robot == kAllRobots) &&
                       !hold.released.contains(robot);
    if (holds && (!longest || *hold.confirmed_at < *longest->confirmed_at)) longest = &hold;
  }
  return longest;
}

bool OrderClients::touches_another(const msg::TrueRobotState& body, const msg::GroundTruth& truth) const {
  return std::ranges::any_of(truth.robots(), [&](const msg::TrueRobotState& other) {
    return other.robot() != body.robot() &&
           std::hypot(other.x_m() - body.x_m(), other.y_m() - body.y_m()) < touching_distance_m_;
  });
}

bool OrderClients::is_disturbed(const msg::TrueRobotState& body, const msg::GroundTruth& truth, Time now) {
  Disturbance& disturbance = disturbances_[body.robot()];
  const auto disturb = [&](Time end) {
    if (end > disturbance.end) disturbance = {end, false};
  };
  if (body.disturbance_end_ns() >= 0) disturb(time_from_ns(body.disturbance_end_ns()));
  // A robot that is carried pushes others.
  if (touches_another(body, truth)) disturb(now);
  if (now > disturbance.end && std::hypot(body.vx_mps(), body.vy_mps()) < kRestSpeed_mps)
    disturbance.has_rested = true;
  const Duration time_to_rest = disturbance.has_rested ? kTimeToRest : time_to_coast_ + kTimeToRest;
  return disturbance.end != Time{} && now <= disturbance.end + time_to_rest;
}

void OrderClients::on_truth(const msg::GroundTruth& truth) {
  // The truth may be that of the second simulator, whose robots are elsewhere, and robots of the first one
  // may follow the second one's fixes. The system hears every truth before this observer.
  if (system_.was_second_simulator_accepted()) return;
  const Time now = time_from_ns(truth.valid_at_ns());
  std::map<RobotId, Vec2> rest_m;
  for (const msg::TrueRobotState& body : truth.robots()) {
    const Hold* const hold = hold_of(body.robot());
    const bool may_move = is_disturbed(body, truth, now);
    if (!hold || now < *hold->confirmed_at + kTimeToRest || may_move) continue;
    const Vec2 position_m(body.x_m(), body.y_m());
    const auto known = rest_m_.find(body.robot());
    rest_m[body.robot()] = known == rest_m_.end() ? position_m : known->second;
    const double moved_m = (position_m - rest_m[body.robot()]).norm();
    if (moved_m <= kMaxMovement_m) continue;
    rest_m[body.robot()] = position_m;
    failures_.push_back(fmt::format("held robot {} moved {:.3f} m, {:.3f} s after a hold of {} was confirmed",
                                    body.robot(), moved_m, to_seconds(now - *hold->confirmed_at),
                                    client_phrase(hold->client, {})));
  }
  rest_m_ = std::move(rest_m);
}

void OrderClients::on_memory(const msg::OrderMemory& message) {
  if (message.page_count() == 0) return;
  const auto page = decode(message, bus_.now());
  if (!page) return;  // invalid, for example because its coordinator has different rules
  if (!page->is_complete) {
    // The process was restarted, and may know no order yet.
    memories_.erase(page->process);
    return;
  }
  Memory& memory = arriving_[page->process];
  if (page->index == 0) memory = {};
  if (page->index != memory.pages) return;
  for (const RememberedOrder& order : page->orders) {
    if (drives(order.order))
      memory.drives[{order.order.robot, rank_of(order.order.client)}] = {order.order.number,
                                                                         order.order.client};
  }
  if (++memory.pages == page->count) memories_[page->process] = memory;
}

void OrderClients::check_drives(const Client& sender, std::vector<std::string>& failures) const {
  for (const OrderHandle handle : sender.given) {
    const SentOrder* const sent = sender.orders.find(handle);
    if (!sent || sent->phase == OrderPhase::kRefused) continue;
    const Order& order = sent->order;
    const std::string client = client_phrase(order.client, order.client_name);
    if (sent->phase == OrderPhase::kSent) {
      failures.push_back(fmt::format("{} got no answer to an order", client));
      continue;
    }
    if (!drives(order)) continue;
    for (const auto& [process, memory] : memories_) {
      if (excused_.contains(process)) continue;
      const auto known = memory.drives.find({order.robot, rank_of(order.client)});
      if (known == memory.drives.end() || known->second < std::pair(order.number, order.client))
        failures.push_back(fmt::format("{} has forgotten order {} of {} to robot {}", process_name(process),
                                       order.number, client, order.robot));
    }
  }
}

std::vector<std::string> OrderClients::failures() const {
  std::vector<std::string> failures = failures_;
  for (const auto& [id, client] : clients_) check_drives(*client, failures);
  return failures;
}

}  // namespace sidestep
