// SPDX-License-Identifier: Apache-2.0
#include "common/client/client.hpp"

#include <map>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include "common/client/conversion.hpp"
#include "common/client/order_client.hpp"
#include "common/client/order_states.hpp"
#include "common/client/robot_table.hpp"
#include "common/messaging/dds/bus.hpp"
#include "common/messaging/refusal_text.hpp"
#include "common/version/version.hpp"

namespace sidestep::client {
namespace {

DdsSettings dds_settings(const Settings& settings) {
  if (settings.name.empty() && !settings.is_operator)
    throw std::invalid_argument("client: a client that is not an operator needs a name");
  const std::string name = settings.name.empty() ? "operator" : settings.name;
  return {settings.domain,
          settings.interface,
          "sidestep-client " + name,
          false,
          settings.is_operator,
          settings.peers,
          settings.keys,
          settings.insecure,
          settings.is_operator ? Identity{Role::kOperator} : Identity{Role::kClient, 0, 0, settings.name}};
}

ClientId id_of(const Settings& settings) {
  return settings.is_operator ? static_cast<ClientId>(Sender::kOperator) : client_id(settings.name);
}

std::string name_of(const Settings& settings) { return settings.is_operator ? "" : settings.name; }

}  // namespace

const char* version() { return kVersion; }

const char* text(Refusal refusal) {
  switch (refusal) {
    case Refusal::kNone:
      return "";
    case Refusal::kMalformed:
      return "it has no goals or corners, too many of them, or a number that is NaN or out of bounds";
    case Refusal::kUnknownRobot:
      return refusal_text(msg::OrderResult::RESULT_UNKNOWN_ROBOT);
    case Refusal::kOutsideField:
      return refusal_text(msg::OrderResult::RESULT_OUTSIDE_FIELD);
    case Refusal::kTooMany:
      return refusal_text(msg::OrderResult::RESULT_TOO_MANY);
    case Refusal::kUnknownZone:
      break;
  }
  return "this client has no zone of this number";
}

struct Client::Impl {
  using Send = std::function<OrderHandle(OrderClient&)>;

  explicit Impl(const Settings& settings)
      : bus(dds_settings(settings)), orders(bus, id_of(settings), name_of(settings)), table(id_of(settings)) {
    orders.on_change([this](const SentOrder& sent) { on_change(sent); });
    bus.subscribe(topics::kOrderStatus, [this](const msg::OrderStatus& status) {
      const std::lock_guard lock(mutex);
      table.on_status(status, bus.now());
    });
    bus.subscribe(topics::kWorld, [this](const msg::WorldState& world) {
      const std::lock_guard lock(mutex);
      table.on_world_state(world, bus.now());
    });
    thread = std::thread([this] { bus.run(); });
  }
  ~Impl() {
    bus.stop();
    thread.join();
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  OrderId send(Send send_order) {
    const OrderId id = states.add();
    bus.post([this, id, send_order = std::move(send_order)] { ids[send_order(orders)] = id; });
    return id;
  }

  OrderId send_zone(std::uint32_t number, Send send_order) {
    const OrderId id = states.add();
    bus.post([this, id, number, send_order = std::move(send_order)] {
      replace_zone(number, send_order(orders), id);
    });
    return id;
  }

  OrderId remove_zone(std::uint32_t number) {
    const OrderId id = states.add();
    bus.post([this, id, number] {
      if (orders.may_have_zone(number))
        replace_zone(number, orders.remove_zone(number), id);
      else
        mark_refused(id, Refusal::kUnknownZone);
    });
    return id;
  }

  /// The order client forgets its earlier orders about a zone.
  void replace_zone(std::uint32_t number, OrderHandle handle, OrderId id) {
    ids[handle] = id;
    if (const auto earlier = zones.find(number); earlier != zones.end()) {
      ids.erase(earlier->second.first);
      update(earlier->second.second, {OrderPhase::kReplaced, Refusal::kNone, 0, true}, true);
    }
    zones[number] = {handle, id};
  }

  OrderId refuse(Refusal refusal) {
    const OrderId id = states.add();
    bus.post([this, id, refusal] { mark_refused(id, refusal); });
    return id;
  }

  void mark_refused(OrderId id, Refusal refusal) {
    update(id, {OrderPhase::kRefused, refusal, 0, true}, true);
  }

  OrderId send_to(RobotId robot, OrderHandle (OrderClient::*order)(sidestep::RobotId)) {
    // Without this check, the number kAllRobots would address all robots instead of one.
    if (robot >= kMaxRobots) return refuse(Refusal::kUnknownRobot);
    return send([robot, order](OrderClient& client) { return (client.*order)(robot); });
  }

  void on_change(const SentOrder& sent) {
    const auto found = ids.find(sent.handle);
    if (found == ids.end()) return;
    const OrderId id = found->second;
    const OrderState state = state_of(sent);
    const bool is_final = stays(sent, state);
    if (is_final) ids.erase(found);
    if (is_final && sent.order.kind == msg::OrderKind::ORDER_REMOVE_ZONE) zones.erase(sent.order.zone_number);
    update(id, state, is_final);
  }

  void update(OrderId id, const OrderState& state, bool is_final) {
    if (!states.update(id, state, is_final)) return;
    std::function<void(OrderId, const OrderState&)> call;
    {
      const std::lock_guard lock(mutex);
      call = callback;
    }
    if (call) call(id, state);
  }

  DdsBus bus;
  OrderClient orders;  ///< used only by `thread`
  // Used only by `thread`.
  std::map<OrderHandle, OrderId> ids;                              ///< orders that may still change
  std::map<std::uint32_t, std::pair<OrderHandle, OrderId>> zones;  ///< the latest order about each zone
  OrderStates states;
  mutable std::mutex mutex;  ///< guards `table` and `callback`
  RobotTable table;
  std::function<void(OrderId, const OrderState&)> callback;
  std::thread thread;
};

Client::Client(const Settings& settings) : impl_(std::make_unique<Impl>(settings)) {}
Client::~Client() = default;

OrderId Client::go(RobotId robot, const std::vector<Goal>& goals) {
  if (robot >= kMaxRobots) return impl_->refuse(Refusal::kUnknownRobot);
  sidestep::Order order{msg::OrderKind::ORDER_GO, robot};
  order.goals = to_goals(goals);
  if (!is_well_formed(order, impl_->bus.now())) return impl_->refuse(Refusal::kMalformed);
  return impl_->send(
      [order = std::move(order)](OrderClient& client) { return client.go(order.robot, order.goals); });
}

OrderId Client::cancel(RobotId robot) { return impl_->send_to(robot, &OrderClient::cancel); }
OrderId Client::hold(RobotId robot) { return impl_->send_to(robot, &OrderClient::hold); }
OrderId Client::resume(RobotId robot) { return impl_->send_to(robot, &OrderClient::resume); }

OrderId Client::hold_all() {
  return impl_->send([](OrderClient& client) { return client.hold(kAllRobots); });
}

OrderId Client::resume_all() {
  return impl_->send([](OrderClient& client) { return client.resume(kAllRobots); });
}

OrderId Client::set_zone(std::uint32_t number, const Zone& zone) {
  sidestep::Order order{msg::OrderKind::ORDER_ZONE, kAllRobots};
  order.zone = to_zone(zone);
  if (!is_well_formed(order, impl_->bus.now())) return impl_->refuse(Refusal::kMalformed);
  return impl_->send_zone(number, [number, zone = std::move(order.zone)](OrderClient& client) {
    return client.zone(number, zone);
  });
}

OrderId Client::remove_zone(std::uint32_t number) { return impl_->remove_zone(number); }

std::optional<OrderState> Client::state(OrderId order) const { return impl_->states.find(order); }

std::optional<OrderState> Client::wait(OrderId order, std::chrono::nanoseconds timeout) const {
  if (std::this_thread::get_id() == impl_->thread.get_id()) return state(order);
  return impl_->states.wait(order, timeout);
}

std::vector<Robot> Client::robots() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->table.robots(impl_->bus.now());
}

void Client::on_change(std::function<void(OrderId, const OrderState&)> callback) {
  const std::lock_guard lock(impl_->mutex);
  impl_->callback = std::move(callback);
}

}  // namespace sidestep::client
