// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/order_codec.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "common/messaging/enumerator.hpp"
#include "common/messaging/version_codec.hpp"

namespace sidestep {
namespace {

constexpr double kMaxHeading_rad = 100;
constexpr double kMaxRemaining_s = 1e9;

// False if the value is NaN.
bool is_between(double value, double low, double high) { return value >= low && value <= high; }

/// Zero means that there is no value.
bool is_none_or_between(double value, double low, double high) {
  return value == 0 || is_between(value, low, high);
}

std::optional<double> if_positive(double value) { return value > 0 ? std::optional(value) : std::nullopt; }

bool is_on_floor(double x_m, double y_m) {
  return is_between(x_m, -kMaxCoordinate_m, kMaxCoordinate_m) &&
         is_between(y_m, -kMaxCoordinate_m, kMaxCoordinate_m);
}

bool is_valid(const msg::OrderPose& pose) {
  return is_on_floor(pose.x_m(), pose.y_m()) &&
         is_between(pose.heading_rad(), -kMaxHeading_rad, kMaxHeading_rad) &&
         is_none_or_between(pose.speed_limit_mps(), kMinSpeedLimit_mps, kMaxSpeed_mps) &&
         is_none_or_between(pose.tolerance_m(), kMinTolerance_m, kMaxTolerance_m);
}

Goal decode(const msg::OrderPose& pose) {
  return {{pose.x_m(), pose.y_m()},
          pose.has_heading() ? std::optional(pose.heading_rad()) : std::nullopt,
          if_positive(pose.speed_limit_mps()),
          if_positive(pose.tolerance_m())};
}

msg::OrderPose encode(const Goal& goal) {
  msg::OrderPose pose;
  pose.x_m(goal.position_m.x());
  pose.y_m(goal.position_m.y());
  pose.has_heading(goal.heading_rad.has_value());
  pose.heading_rad(goal.heading_rad.value_or(0));
  pose.speed_limit_mps(goal.speed_limit_mps.value_or(0));
  pose.tolerance_m(goal.tolerance_m.value_or(0));
  return pose;
}

/// Whether orders of this kind may have this value of Order::robot: kAllRobots, one robot, or either.
bool fits(msg::OrderKind kind, RobotId robot) {
  switch (kind) {
    case msg::OrderKind::ORDER_GO:
    case msg::OrderKind::ORDER_CANCEL:
      return robot != kAllRobots;
    case msg::OrderKind::ORDER_HOLD:
    case msg::OrderKind::ORDER_RESUME:
      return true;
    case msg::OrderKind::ORDER_ZONE:
    case msg::OrderKind::ORDER_REMOVE_ZONE:
      return robot == kAllRobots;
  }
  return false;
}

bool is_valid(const msg::OrderTerms& terms, std::size_t poses) {
  const bool is_zone = terms.order_kind() == msg::OrderKind::ORDER_ZONE;
  return is_zone ? is_between(static_cast<double>(poses), 1, kMaxZoneCorners) &&
                       is_between(terms.zone_radius_m(), 0, kMaxCoordinate_m) &&
                       is_none_or_between(terms.zone_speed_limit_mps(), kMinSpeedLimit_mps, kMaxSpeed_mps)
                 : poses == 0 || terms.order_kind() == msg::OrderKind::ORDER_GO;
}

/// Decodes an order of a client or of the scenario; the latter has no poses.
std::optional<Order> decode(RobotId robot, ClientId client, const msg::OrderTerms& terms,
                            std::span<const msg::OrderPose> poses, Time now) {
  const auto is_valid_pose = [](const msg::OrderPose& pose) { return is_valid(pose); };
  const bool is_known_kind = is_enumerator(terms.order_kind(), msg::OrderKind::ORDER_REMOVE_ZONE);
  if (!is_known_kind || !fits(terms.order_kind(), robot) || terms.order_number() == 0 ||
      !is_name_of(terms.client_name(), client) || !is_plausible(terms.order_number(), now) ||
      !is_valid(terms, poses.size()) || !std::ranges::all_of(poses, is_valid_pose))
    return std::nullopt;
  Order order{terms.order_kind(), robot, client, terms.order_number()};
  if (order.kind == msg::OrderKind::ORDER_GO)
    std::ranges::transform(poses, std::back_inserter(order.goals), [](const auto& p) { return decode(p); });
  order.client_name = terms.client_name();
  order.zone_number = terms.zone();
  if (order.kind == msg::OrderKind::ORDER_ZONE) {
    for (const msg::OrderPose& corner : poses) order.zone.corners_m.emplace_back(corner.x_m(), corner.y_m());
    order.zone.radius_m = terms.zone_radius_m();
    order.zone.speed_limit_mps = if_positive(terms.zone_speed_limit_mps());
  }
  return order;
}

msg::OrderTerms encode_terms(const Order& order) {
  msg::OrderTerms terms;
  terms.order_kind(order.kind);
  terms.order_number(order.number);
  terms.zone(order.zone_number);
  terms.zone_radius_m(order.zone.radius_m);
  terms.zone_speed_limit_mps(order.zone.speed_limit_mps.value_or(0));
  terms.client_name(order.client_name);
  return terms;
}

std::vector<msg::OrderPose> encode_poses(const Order& order) {
  std::vector<msg::OrderPose> poses;
  for (const Goal& goal : order.goals) poses.push_back(encode(goal));
  for (const Vec2& corner : order.zone.corners_m) poses.push_back(encode(Goal{corner}));
  return poses;
}

bool is_client(std::uint32_t sender) {
  return sender == static_cast<std::uint32_t>(Sender::kOperator) ||
         sender == static_cast<std::uint32_t>(Sender::kReferee) ||
         sender >= static_cast<std::uint32_t>(Sender::kClient);
}

/// Whether an order from this client may be remembered: scenarios only give orders to drive, and coordinators
/// only hold robots.
bool may_order(std::uint32_t client, const msg::OrderTerms& terms, std::size_t poses) {
  if (is_coordinator(client)) return terms.order_kind() == msg::OrderKind::ORDER_HOLD;
  const bool is_go = terms.order_kind() == msg::OrderKind::ORDER_GO;
  if (client == static_cast<std::uint32_t>(Sender::kScenario)) return is_go && poses == 0;
  return is_client(client) && (!is_go || poses > 0);
}

}  // namespace

// Comparing numbers and clients is enough, because they determine an order's contents.
bool have_same_orders(const OrderPage& a, const OrderPage& b) {
  const auto is_same = [](const RememberedOrder& x, const RememberedOrder& y) {
    return x.order.number == y.order.number && x.order.client == y.order.client &&
           x.order.robot == y.order.robot && x.order.kind == y.order.kind &&
           x.order.zone_number == y.order.zone_number && x.progress.state == y.progress.state &&
           x.progress.goal_index == y.progress.goal_index;
  };
  return &a == &b || std::ranges::equal(a.orders, b.orders, is_same);
}

std::optional<Order> decode(const msg::Order& message, Time now) {
  const std::uint32_t client = message.header().sender();
  const auto& poses = message.poses();
  if (!is_client(client) || !may_order(client, message.terms(), poses.size())) return std::nullopt;
  return decode(message.robot(), client, message.terms(), poses, now);
}

std::optional<OrderPage> decode(const msg::OrderMemory& message, Time now) {
  const std::uint32_t process = message.header().sender();
  const bool is_valid = message.process() == process && (is_coordinator(process) || process < kMaxRobots) &&
                        message.order_count() <= msg::MAX_MEMORY_ORDERS &&
                        message.page_count() <= kMaxOrderPages &&
                        message.page_index() < std::max(1U, message.page_count());
  if (!is_valid) return std::nullopt;
  OrderPage page{process, message.is_complete(), message.page_index(), message.page_count(), {}};
  std::span<const msg::OrderPose> poses = message.poses();
  for (std::size_t i = 0; i < message.order_count(); ++i) {
    const msg::RememberedOrder& remembered = message.orders()[i];
    const std::size_t count = remembered.pose_count();
    if (count > poses.size()) return std::nullopt;
    const auto own_poses = poses.first(count);
    poses = poses.subspan(count);
    if (!may_order(remembered.client(), remembered.terms(), count) ||
        !is_enumerator(remembered.order_state(), msg::OrderState::ORDER_LEFT) ||
        remembered.order_state() == msg::OrderState::ORDER_BLOCKED)
      return std::nullopt;
    auto order = decode(remembered.robot(), remembered.client(), remembered.terms(), own_poses, now);
    if (!order) return std::nullopt;
    page.orders.push_back({std::move(*order), {remembered.order_state(), remembered.pose_index()}});
  }
  if (!poses.empty()) return std::nullopt;
  page.incarnation = message.header().incarnation();
  return page;
}

std::optional<OrderReport> decode(const msg::OrderStatus& message) {
  const bool is_valid = message.robot() < kMaxRobots && message.header().sender() == message.robot() &&
                        is_enumerator(message.order_state(), msg::OrderState::ORDER_LEFT) &&
                        is_enumerator(message.block_reason(), msg::BlockReason::BLOCK_PASSING_ROBOT) &&
                        is_on_floor(message.blocker_x_m(), message.blocker_y_m()) &&
                        is_on_floor(message.nearest_x_m(), message.nearest_y_m()) &&
                        is_between(message.blocker_speed_mps(), 0, kMaxSpeed_mps) &&
                        is_name_of(message.client_name(), message.client()) &&
                        message.remaining_s() <= kMaxRemaining_s;
  const bool is_blocked = message.order_state() == msg::OrderState::ORDER_BLOCKED;
  if (!is_valid || (is_blocked && message.block_reason() == msg::BlockReason::BLOCK_NONE))
    return std::nullopt;
  OrderReport report{
      message.robot(),
      message.client(),
      message.order_number(),
      {is_blocked ? msg::OrderState::ORDER_DRIVING : message.order_state(), message.pose_index()}};
  report.is_held = message.is_held();
  if (message.block_reason() != msg::BlockReason::BLOCK_NONE) {
    report.blockage = Blockage{message.block_reason(),
                               message.blocker(),
                               {message.blocker_x_m(), message.blocker_y_m()},
                               {message.nearest_x_m(), message.nearest_y_m()},
                               message.blocker_speed_mps()};
  }
  if (message.remaining_s() >= 0) report.remaining_s = message.remaining_s();
  report.client_name = message.client_name();
  return report;
}

msg::OrderStatus encode(const OrderReport& report) {
  msg::OrderStatus message;
  message.robot(report.robot);
  message.client(report.client);
  message.order_number(report.number);
  const bool is_blocked = report.blockage && !report.progress.is_finished();
  message.order_state(is_blocked ? msg::OrderState::ORDER_BLOCKED : report.progress.state);
  message.pose_index(static_cast<std::uint16_t>(report.progress.goal_index));
  message.is_held(report.is_held);
  if (report.blockage) {
    message.block_reason(report.blockage->reason);
    message.blocker(report.blockage->blocker);
    message.blocker_x_m(report.blockage->blocker_m.x());
    message.blocker_y_m(report.blockage->blocker_m.y());
    message.nearest_x_m(report.blockage->nearest_m.x());
    message.nearest_y_m(report.blockage->nearest_m.y());
    message.blocker_speed_mps(report.blockage->blocker_speed_mps);
  }
  message.remaining_s(std::min(report.remaining_s.value_or(-1), kMaxRemaining_s));
  message.client_name(report.client_name);
  return message;
}

msg::Order encode(const Order& order) {
  msg::Order message;
  message.robot(order.robot);
  message.header().sender(order.client);
  message.terms(encode_terms(order));
  message.poses(encode_poses(order));
  return message;
}

std::vector<msg::OrderMemory> encode(std::span<const RememberedOrder> orders, bool is_complete,
                                     bool have_changed) {
  std::vector<msg::OrderMemory> pages(1);
  for (const RememberedOrder& order : orders) {
    const auto poses = encode_poses(order.order);
    const msg::OrderMemory& last = pages.back();
    if (last.order_count() == msg::MAX_MEMORY_ORDERS ||
        last.poses().size() + poses.size() > msg::MAX_MEMORY_POSES)
      pages.emplace_back();
    msg::OrderMemory& page = pages.back();
    msg::RememberedOrder& remembered = page.orders()[page.order_count()];
    remembered.robot(order.order.robot);
    remembered.client(order.order.client);
    remembered.terms(encode_terms(order.order));
    remembered.pose_count(static_cast<std::uint8_t>(poses.size()));
    remembered.pose_index(static_cast<std::uint16_t>(order.progress.goal_index));
    remembered.order_state(order.progress.state);
    page.order_count(static_cast<std::uint8_t>(page.order_count() + 1));
    page.poses().insert(page.poses().end(), poses.begin(), poses.end());
  }
  for (std::size_t i = 0; i < pages.size(); ++i) {
    pages[i].is_complete(is_complete);
    pages[i].page_index(static_cast<std::uint32_t>(have_changed ? 0 : i));
    pages[i].page_count(static_cast<std::uint32_t>(have_changed ? 0 : pages.size()));
  }
  return pages;
}

}  // namespace sidestep
