// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/floor_operator.hpp"

#include <algorithm>

#include "common/protocol/senders.hpp"
#include "simulator/world/disturbance_codec.hpp"

namespace sidestep {
namespace {

constexpr Duration kPeriod = std::chrono::milliseconds(250);
constexpr std::size_t kRequestsPerPlace = 6;
constexpr Duration kMinCarryTime = std::chrono::milliseconds(50);
constexpr Duration kResumePeriod = std::chrono::seconds(1);

}  // namespace

FloorOperator::FloorOperator(SimSystem& system, const Scenario& scenario)
    : system_(system),
      scenario_(scenario),
      bus_(system.network()),
      attestation_writer_(bus_.advertise(topics::kAttestation)) {
  bus_.become_observer();
  bus_.subscribe<msg::GroundTruth>(topics::kTruth, [this](const msg::GroundTruth& truth) {
    on_floor_.clear();
    for (const msg::TrueRobotState& robot : truth.robots())
      on_floor_[robot.robot()] = Vec2(robot.x_m(), robot.y_m());
  });
  bus_.subscribe<msg::OrderMemory>(topics::kOrderMemory, [this](const msg::OrderMemory& memory) {
    const auto is_of_coordinator = [](const msg::RememberedOrder& order) {
      return order.terms().order_kind() == msg::OrderKind::ORDER_HOLD && is_coordinator(order.client());
    };
    const auto count = std::min<std::size_t>(memory.order_count(), memory.orders().size());
    are_orders_lost_ |=
        std::any_of(memory.orders().begin(), memory.orders().begin() + count, is_of_coordinator);
  });
}

const Vec2* FloorOperator::position_of(RobotId robot) const {
  const auto found = on_floor_.find(robot);
  return found == on_floor_.end() ? nullptr : &found->second;
}

void FloorOperator::carry(const Carry& carry, Time limit) {
  const Vec2* const position_m = position_of(carry.robot);
  if (!position_m) return;
  RobotDisturbance disturbance;
  disturbance.robot = carry.robot;
  disturbance.kind = msg::DisturbanceKind::DISTURBANCE_CARRY;
  disturbance.place_m = carry.place_m;
  const Duration path_time = from_seconds((carry.place_m - *position_m).norm() / carry.speed_mps);
  disturbance.duration = std::max(kMinCarryTime, std::min(path_time, limit - system_.now()));
  system_.disturb(encode(disturbance));
}

void FloorOperator::place(const Place& place) {
  placings_.push_back({place});
  due_ = system_.now();
}

void FloorOperator::take_away(RobotId robot) {
  RobotDisturbance lift;
  lift.robot = robot;
  lift.kind = msg::DisturbanceKind::DISTURBANCE_LIFT;
  system_.disturb(encode(lift));
  taken_away_.insert(robot);
  due_ = system_.now();
}

std::optional<Time> FloorOperator::due() const {
  return placings_.empty() && taken_away_.empty() && !resumes_ ? std::nullopt : std::optional(due_);
}

void FloorOperator::resume_if_held() {
  const auto is_held = [](const RobotProgress& row) {
    return row.agent_state == msg::AgentState::AGENT_HELD;
  };
  if (!resumes_ || system_.now() - resumed_at_ < kResumePeriod ||
      !std::ranges::any_of(system_.metrics().progress(), is_held))
    return;
  resumed_at_ = system_.now();
  give(msg::OrderKind::ORDER_RESUME, kAllRobots);
}

void FloorOperator::send_to_goals() {
  if (!resumes_ || !are_orders_lost_ || system_.now() - sent_at_ < kResumePeriod) return;
  sent_at_ = system_.now();
  for (const RobotProgress& row : system_.metrics().progress()) {
    const std::vector<Goal>& goals = find_robot(scenario_, row.robot)->goals;
    if (row.agent_state == msg::AgentState::AGENT_WITHOUT_ORDER && !goals.empty())
      give(msg::OrderKind::ORDER_GO, row.robot, goals);
  }
}

void FloorOperator::give(msg::OrderKind kind, RobotId robot, std::vector<Goal> goals) {
  Order order{kind, robot, static_cast<ClientId>(Sender::kOperator),
              static_cast<OrderNumber>(to_ns(system_.now()))};
  order.goals = std::move(goals);
  system_.send(order);
}

void FloorOperator::update() {
  if (!due() || system_.now() < due_) return;
  due_ = system_.now() + kPeriod;
  resume_if_held();
  send_to_goals();
  std::erase_if(placings_, [this](Placing& placing) {
    const Place& request = placing.request;
    if (position_of(request.robot)) return placing.is_off_floor;
    placing.is_off_floor = true;
    RobotDisturbance disturbance;
    disturbance.robot = request.robot;
    disturbance.kind = msg::DisturbanceKind::DISTURBANCE_PLACE;
    disturbance.place_m = request.places_m[placing.requests++ / kRequestsPerPlace % request.places_m.size()];
    disturbance.heading_rad = request.heading_rad;
    system_.disturb(encode(disturbance));
    return false;
  });
  if (taken_away_.empty()) return;
  for (const RobotId robot : system_.metrics().unregistered_robots()) {
    if (!taken_away_.contains(robot) || position_of(robot)) continue;
    msg::AbsenceAttestation attestation;
    attestation.robot(robot);
    attestation.header().sender(static_cast<std::uint32_t>(Sender::kOperator));
    attestation_writer_.publish(attestation, system_.now());
  }
}

}  // namespace sidestep
