// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "agents/agent/agent_event_logger.hpp"
#include "agents/agent/agent_status.hpp"
#include "agents/agent/motion_planner.hpp"
#include "agents/agent/negotiation.hpp"
#include "agents/agent/observations.hpp"
#include "agents/agent/order_execution.hpp"
#include "agents/agent/planning_scratch.hpp"
#include "agents/agent/proposal_search.hpp"
#include "agents/agent/stranger_watch.hpp"
#include "common/config/scenario.hpp"
#include "common/protocol/drop_counters.hpp"

namespace sidestep {

/// Makes the decisions of one robot, once per cycle: it turns observations and messages into proposals and
/// commands. It only connects the classes that decide: Negotiation, Observations, OrderExecution,
/// MotionPlanner and ProposalSearch. The caller decodes all messages before it passes them to the agent, and
/// encodes the messages that the agent returns. All times are by the robot's clock, as estimated by the
/// caller.
class Agent {
 public:
  /// The consequences of a verdict.
  struct VerdictResult {
    std::optional<Command> command;      ///< the command that forwards the granted version
    std::optional<Duration> round_trip;  ///< time from the proposal to its verdict
  };

  /// Precondition: `floor` contains the robot, and `scratch` was made for this scenario.
  Agent(const FloorSpec& floor, RobotId robot, Incarnation incarnation,
        std::shared_ptr<PlanningScratch> scratch);

  /// Processes a report of the robot. Returns whether the agent should propose again immediately, because the
  /// robot does not execute the version that the last proposal was based on.
  bool on_robot_report(const RobotReport& robot_report);
  /// Processes a world state; see Observations. Here and below, `now` is an upper bound of the time by the
  /// robot's clock.
  void on_world_state(const WorldObservations& world, Time now, bool is_robot_clock_known = true) {
    observations_.on_world_state(world, now, is_robot_clock_known);
  }
  void on_obstacles(const ObstacleObservations& list, Time now) { observations_.on_obstacles(list, now); }
  /// Precondition: the robot has a laser.
  void on_scan(const LaserScan& scan, Time now) { observations_.on_scan(scan, now); }
  void on_page(const ReceivedPage& page) { observations_.on_page(page); }
  /// Records where the lifted robot will be put down.
  void on_placement(const Vec2& position_m) { placement_m_ = position_m; }
  void on_coordinator_state(const CoordinatorHeartbeat& heartbeat, Time now);
  /// Processes orders that a coordinator remembers.
  void on_orders(std::shared_ptr<const OrderPage> page);
  VerdictResult on_verdict(const Verdict& verdict, Time now);
  /// Closes the cycle that ends now: abandons this agent's proposals that have no verdict yet.
  void close_cycle(Time now) {
    negotiation_.close_cycle(now);
    strangers_.close_cycle(now);
  }

  /// Proposes no more versions, so the robot brakes along the version that it has.
  void stop() { is_stopping_ = true; }
  /// Whether the robot stays at rest if the agent ends: it has no version that still moves it, and none that
  /// awaits its verdict. Holds if the robot does not obey this agent.
  bool is_at_rest(Time now) const;

  // State of the negotiation; see Negotiation.
  Incarnation incarnation() const { return negotiation_.incarnation(); }
  Incarnation robot_incarnation() const { return negotiation_.robot_incarnation(); }
  Epoch epoch() const { return negotiation_.epoch(); }
  bool is_superseded() const { return negotiation_.is_superseded(); }
  bool must_query_robot() const { return negotiation_.must_query_robot(); }
  bool needs_registration() const { return negotiation_.needs_registration(); }
  bool is_fenced() const { return negotiation_.is_fenced(); }
  /// Whether the active coordinator has announced all orders that this agent remembers. The agent registers
  /// only after that, so no remembered order is lost.
  bool coordinator_knows_all_orders() const {
    return orders_.coordinator_knows_all_orders(negotiation_.epoch());
  }
  bool may_propose(Time now) const { return negotiation_.may_propose(now); }
  bool has_upcoming_version(Time now) const { return negotiation_.has_upcoming_version(now); }

  Registration registration();
  void on_request(Time now) { negotiation_.on_request(now); }
  /// Whether the agent should ask for another coordinator, because the present coordinator does not serve it.
  bool needs_other_coordinator(Time now) const;
  /// See Negotiation.
  Registration epoch_notice() const { return negotiation_.epoch_notice(); }
  /// The earliest start for a new version: the next cycle, or a later cycle on a slow network.
  Time earliest_start(Time next_cycle) const { return next_cycle + cycle_ * (negotiation_.lead() - 1); }
  /// The start of the version to propose at the start of a cycle; nullopt if there is nothing to propose.
  std::optional<Time> start_to_propose(Time now, Time next_cycle) const;

  /// Plans the motion from `start` on. Returns nullopt if the robot's current version already ends at its
  /// goal, if vision has lost the robot, if the coordinator has lost vision, or if the agent has no recent
  /// list of obstacles. `max_speed_mps`: the speed that the clocks allow. `max_lag`: the robot's maximum lag
  /// in excess of the clock bound; see ClockMonitor.
  [[nodiscard]] std::optional<MotionPlan> plan(Time now, Time start, double max_speed_mps, Duration max_lag);
  /// The proposal for a plan. Returns nullopt if the search finds no clear candidate; the robot then brakes.
  [[nodiscard]] std::optional<Proposal> search(const MotionPlan& plan, Time now);

  /// Plans courses for the cycles to come. It may take milliseconds: call it when the verdict on the proposal
  /// has been forwarded.
  void plan_courses();
  /// Says how long the last call of plan_courses() took, by the bus's time, which does not pass meanwhile in
  /// simulations: these have to be repeatable.
  void charge_courses(Duration taken) {
    if (course_start_) planner_.charge_courses(taken);
  }
  void on_course(std::shared_ptr<const DrivingCourse> course, Time now) {
    courses_.set_place(observations_.own().estimate().position_m);
    courses_.on_course(std::move(course), now);
  }
  void on_course_offer(std::shared_ptr<const CourseOffer> offer, Time now) {
    courses_.on_offer(std::move(offer), now);
  }
  /// The course that the robot follows; nullptr if it has none.
  const DrivingCourse* course() const { return planner_.course(); }
  /// The offers that the last call of plan_courses() made to others.
  std::span<const CourseOffer> course_offers() const {
    return course_start_ ? planner_.course_offers() : std::span<const CourseOffer>{};
  }

  /// The reason why plan() returns nullopt now. Does not consider the robot's own versions. A robot that
  /// waits for an order nevertheless steps aside for others.
  WaitReason wait_reason(Time now) const;
  AgentActivity activity(Time now) const;

  /// Proposes to rest from `start` on: where a lifted robot will be put down, or where a robot rests after
  /// its own stop, so that the stop's inflation ends, whether it has an order or not. Returns nullopt if the
  /// robot needs no such version or may not propose it.
  [[nodiscard]] std::optional<Proposal> propose_rest_version(Time now, Time start);

  /// The command of this cycle. It fences the robot, forwards the latest observation, and repeats a granted
  /// version until that version starts.
  Command command(Time now);

  const Assignment& assignment() const { return orders_.assignment(); }
  /// Starts the next order if the robot has finished its order.
  void choose_order();
  /// See Assignment.
  std::vector<RememberedOrder> take_missing_orders() { return orders_.take_missing(); }
  /// The report on the robot's order, without the remaining time.
  OrderReport order_report() const;
  /// Estimated time to reach all remaining goals; nullopt: unknown.
  std::optional<double> remaining_s() const {
    if (strangers_.lasting()) return std::nullopt;
    return planner_.remaining_s(assignment(), orders_.has_arrived());
  }

  void count_drops(DropCounters& drops) const;
  /// The agent's status, without the durations, which the caller measures.
  msg::AgentStatus status(Time now) const {
    return status_of(robot_.id, negotiation_, observations_.own(), orders_, planner_, now);
  }

 private:
  /// Starts the next goal if the robot has reached its goal. Precondition: the robot is fenced.
  void update_goal(const RobotReport& robot_report);

  const RobotSpec robot_;
  const std::shared_ptr<PlanningScratch> scratch_;
  const Duration cycle_;
  Negotiation negotiation_;
  Observations observations_;
  OrderExecution orders_;
  MotionPlanner planner_;
  ProposalSearch search_;
  StrangerWatch strangers_;
  CourseBook courses_;
  std::optional<Time> course_start_;  // start of the motion after the one planned in this cycle
  Rng rng_;
  std::optional<Version> forwarded_;  // granted version that has not started yet
  bool is_stopping_ = false;
  std::optional<Vec2> placement_m_;  // place where the robot will be put down
};

}  // namespace sidestep
