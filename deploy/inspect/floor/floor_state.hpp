// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/messaging/topics.hpp"
#include "common/motion/driving_course.hpp"
#include "common/motion/version.hpp"
#include "common/protocol/order_book.hpp"
#include "common/time/time.hpp"
#include "idl/course.hpp"
#include "idl/laser.hpp"
#include "idl/monitor.hpp"
#include "idl/negotiation.hpp"
#include "idl/order.hpp"
#include "idl/robot.hpp"
#include "idl/vision.hpp"

namespace sidestep {

/// A value and its reception time.
template <typename Value>
struct Received {
  Value value;
  Time at{};
};

/// Values received longer ago than this are not shown.
inline constexpr Duration kMaxShownAge = std::chrono::seconds(1);

/// The value, if it is recent enough to be shown; otherwise nullptr.
template <typename Value>
const Value* fresh(const std::optional<Received<Value>>& received, Time now,
                   Duration max_age = kMaxShownAge) {
  // A time in the future was recorded before the clock was set back.
  return received && std::chrono::abs(now - received->at) <= max_age ? &received->value : nullptr;
}

/// A message of any topic.
struct AnyMessage {
  const TopicInfo& topic;
  std::uint32_t channel;  ///< for per-robot topics, each robot has a different channel
  const std::string& channel_name;
  const msg::Header& header;
  const void* message;
};

/// A candidate that the coordinator did not grant.
struct Denial {
  msg::Reason reason = msg::Reason::REASON_NOT_EVALUATED;
  RobotId blocker = 0;  ///< valid if the reason is REASON_CONFLICT
};

/// The newest information about one robot.
struct RobotView {
  std::optional<Received<msg::TrueRobotState>> truth;
  std::optional<Received<msg::TrackedRobot>> seen;
  std::optional<Received<msg::Feedback>> feedback;
  std::optional<Received<msg::AgentStatus>> status;
  std::optional<Received<msg::OrderStatus>> order;
  std::optional<Received<msg::Proposal>> proposal;
  std::optional<Received<msg::Version>> granted;
  std::optional<Received<Denial>> denial;  ///< last denial since the last grant
  std::optional<Received<msg::LaserScan>> scan;
  std::optional<Received<DrivingCourse>> course;   ///< an empty one: the robot has none
  std::map<std::uint32_t, std::uint64_t> denials;  ///< denials of first candidates, by msg::Reason
};

/// The course that the robot has now; nullptr if it has none, or if the course is over or has not been
/// repeated.
const DrivingCourse* present_course(const RobotView& robot, Time now);

/// The newest state of the floor according to messages. Values in messages are not trusted: robots and
/// coordinators with numbers beyond those that the protocol allows are ignored.
class FloorState {
 public:
  void on(const msg::GroundTruth& truth, Time now);
  void on(const msg::WorldState& world, Time now);
  void on(const msg::ObstacleList& list, Time now);
  void on(const msg::DetectionFrame& frame, Time now);
  void on(const msg::Feedback& feedback, Time now);
  void on(const msg::AgentStatus& status, Time now);
  void on(const msg::OrderStatus& status, Time now);
  void on(const msg::Proposal& proposal, Time now);
  void on(const msg::Verdict& verdict, Time now);
  void on(const msg::LedgerPage& page, Time now);
  void on(const msg::CoordinatorState& state, Time now);
  void on(const msg::OrderMemory& memory, Time now);
  void on(const msg::LaserScan& scan, Time now);
  /// Ignores courses that no coordinator has relayed, because other robots do not know them.
  void on(const msg::Course& course, Time now);

  const std::map<RobotId, RobotView>& robots() const { return robots_; }
  const std::optional<Received<msg::WorldState>>& world() const { return world_; }
  const std::optional<Received<msg::ObstacleList>>& obstacles() const { return obstacles_; }
  /// The latest frame of each camera.
  const std::map<std::uint32_t, Received<msg::DetectionFrame>>& detections() const { return detections_; }
  const std::map<std::uint32_t, Received<msg::CoordinatorState>>& coordinators() const {
    return coordinators_;
  }
  /// The pages of the ledger, by index.
  const std::map<std::uint32_t, Received<msg::LedgerPage>>& ledger() const { return ledger_; }
  const OrderBook& orders() const { return orders_; }

 private:
  RobotView* robot(std::uint32_t id);

  std::map<RobotId, RobotView> robots_;
  std::optional<Received<msg::WorldState>> world_;
  std::optional<Received<msg::ObstacleList>> obstacles_;
  std::map<std::uint32_t, Received<msg::DetectionFrame>> detections_;
  std::map<std::uint32_t, Received<msg::CoordinatorState>> coordinators_;
  std::map<std::uint32_t, Received<msg::LedgerPage>> ledger_;
  OrderBook orders_;
};

}  // namespace sidestep
