// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>

#include "agents/agent/agent_changes.hpp"
#include "agents/agent/assignment.hpp"
#include "agents/agent/displaced_obstacles.hpp"
#include "agents/agent/negotiation.hpp"
#include "agents/agent/neighbours.hpp"
#include "agents/agent/observed_obstacles.hpp"
#include "agents/agent/planning_scratch.hpp"
#include "agents/agent/planning_settings.hpp"
#include "agents/agent/route_obstacles.hpp"
#include "agents/navigation/deadlock_recovery.hpp"
#include "agents/navigation/give_way.hpp"
#include "agents/navigation/local_driver.hpp"
#include "agents/navigation/motion_control.hpp"
#include "agents/navigation/route_planner.hpp"
#include "agents/navigation/zone_map.hpp"
#include "agents/perception/laser_sight.hpp"
#include "agents/safety/escape_search.hpp"
#include "common/config/scenario.hpp"
#include "common/protocol/drop_counters.hpp"
#include "idl/monitor.hpp"

namespace sidestep {

/// A desired motion: the query for the safety search, and the base and intent that are proposed with its
/// result.
struct MotionPlan {
  SearchQuery query;
  VersionNumber base = 0;  ///< the version that the motion continues
  Intent intent;           ///< what the robot intends after the motion
};

/// Makes the decisions of one robot, once per cycle: it turns observations and messages into proposals and
/// commands. All messages passed to it are already decoded for the robot, and the caller encodes those that
/// it returns. All times are by the robot's clock, as estimated by the caller.
class Agent {
 public:
  /// The consequences of a verdict.
  struct VerdictResult {
    std::optional<Command> command;      ///< the command that forwards the granted version
    std::optional<Duration> round_trip;  ///< time from the proposal to its verdict
  };

  /// Precondition: `scenario` contains the robot, and `scratch` was made for this scenario.
  Agent(const Scenario& scenario, RobotId robot, Incarnation incarnation,
        std::shared_ptr<PlanningScratch> scratch, const PlanningSettings& settings = {});

  /// Processes feedback. Returns whether the agent should propose again immediately, because the robot does
  /// not execute the version that the last proposal was based on.
  bool on_feedback(const Feedback& feedback);
  /// Processes a world state. `now` is an upper bound of the time by the robot's clock. If that clock has not
  /// been measured yet, the observation is only forwarded, because a robot that has lost its pose reports
  /// nothing until it gets one.
  void on_world(const WorldObservations& world, Time now, bool is_robot_clock_known = true);
  /// Processes a list of obstacles. `now` is an upper bound of the time by the robot's clock.
  void on_obstacles(const ObstacleObservations& list, Time now) {
    obstacles_.on_list(list, estimate_.position_m, now);
  }
  /// Processes a scan of the robot's laser. `now` is an upper bound of the time by the robot's clock.
  void on_scan(const LaserScan& scan, Time now);
  void on_page(const ReceivedPage& page) { neighbours_.on_page(page); }
  /// Records where the lifted robot is to be put down.
  void on_placement(const Vec2& position_m) { placement_m_ = position_m; }
  void on_coordinator_state(const CoordinatorHeartbeat& heartbeat, Time now);
  /// Processes orders that a coordinator remembers.
  void on_orders(std::shared_ptr<const OrderPage> page);
  VerdictResult on_verdict(const Verdict& verdict, Time now);
  /// Closes the cycle that ends now: abandons this agent's proposals that have no verdict yet.
  void close_cycle(Time now) { negotiation_.close_cycle(now); }

  // State of the negotiation; see Negotiation.
  Incarnation incarnation() const { return negotiation_.incarnation(); }
  Epoch epoch() const { return negotiation_.epoch(); }
  bool is_superseded() const { return negotiation_.is_superseded(); }
  bool must_ask_robot() const { return negotiation_.must_ask_robot(); }
  bool needs_registration() const { return negotiation_.needs_registration(); }
  bool is_fenced() const { return negotiation_.is_fenced(); }
  /// Whether the active coordinator has announced all orders that this agent remembers. Only then does the
  /// agent register, so that no order that an agent remembers is lost.
  bool is_told_all_orders() const;
  bool may_propose(Time now) const { return negotiation_.may_propose(now); }
  bool has_upcoming_version(Time now) const { return negotiation_.has_upcoming_version(now); }

  Registration registration();
  void on_request(Time now) { negotiation_.on_request(now); }
  /// Whether the coordinator does not serve this agent, so that the agent should ask for another coordinator.
  bool is_unserved(Time now) const;
  /// See Negotiation.
  Registration epoch_notice() const { return negotiation_.epoch_notice(); }
  /// The earliest start for a new version: the next cycle, or a later one on a slow network.
  Time earliest_start(Time next_cycle) const { return next_cycle + cycle_ * (negotiation_.lead() - 1); }
  /// The start of the version to propose at the start of a cycle; nullopt if there is nothing to propose.
  std::optional<Time> start_to_propose(Time now, Time next_cycle) const;

  /// Plans the motion from `start` on. Returns nullopt if the version that the robot holds already ends at
  /// its goal. Also returns nullopt if vision has lost the robot, which must not rely on its own pose
  /// estimate, and if the coordinator has lost vision, or the agent has had no list of obstacles
  /// recently. `max_speed_mps`: the speed that the clocks allow. `max_lag`: how much the robot may be late,
  /// beyond the clock bound (ClockMonitor).
  [[nodiscard]] std::optional<MotionPlan> plan(Time now, Time start,
                                               double max_speed_mps = std::numeric_limits<double>::infinity(),
                                               Duration max_lag = Duration{0});
  /// The proposal for a plan. Returns nullopt if the search finds no clear candidate; the robot then brakes.
  [[nodiscard]] std::optional<Proposal> search(const MotionPlan& plan, Time now);

  /// Why plan() returns nothing at this time, unless the reason lies in the robot's own versions.
  WaitReason wait_reason(Time now) const;
  AgentActivity activity(Time now) const;

  /// Whether the robot is off the floor and a rest version may be proposed at the place where it is to be put
  /// down.
  bool needs_rest_version(Time now) const;
  /// The proposal for that rest version. Precondition: needs_rest_version().
  [[nodiscard]] Proposal propose_rest_version(Time now, Time start);

  /// The command of this cycle. It fences the robot, forwards the latest observation, and repeats a granted
  /// version until that version starts.
  Command command(Time now);

  const Assignment& assignment() const { return assignment_; }
  /// Starts the next order if the robot has finished one.
  void choose_order();
  /// See Assignment.
  std::vector<RememberedOrder> take_missing_orders() { return assignment_.take_missing(); }
  /// The report on the robot's order, without the remaining time.
  OrderReport order_report() const;
  /// Estimated time to reach all remaining goals; nullopt: unknown.
  std::optional<double> remaining_s() const;

  void count_drops(DropCounters& drops) const;
  /// The agent's status, without the durations, which the caller measures.
  msg::AgentStatus status(Time now) const;

 private:
  /// A corner from behind which a person may appear, and the time until which routes avoid it.
  struct OccludedCorner {
    Vec2 at_m{0, 0};
    Time until{};
  };
  /// A place at which no speed was safe, and the time since which the robot has not moved away from it.
  struct Standstill {
    Vec2 at_m{0, 0};
    Time since{};
  };
  /// Stores the robot's own state estimate.
  void update_estimate(const Feedback& feedback);
  /// Switches to the next goal when the robot has arrived. Precondition: the robot is fenced.
  void update_goal(const Feedback& feedback);
  /// Precondition: the robot has an order.
  const Goal& goal() const { return *assignment_.goal(); }
  /// Starts a new goal if the goal has changed since this revision of the assignment.
  void begin_if_changed(std::uint64_t revision);
  /// The robot's target: its goal, or the rest position if it has no goal.
  Vec2 target_m(const Vec2& rest_m) const { return assignment_.goal() ? goal().position_m : rest_m; }
  /// Starts a new route if the target or the zones have changed. Also starts one if stationary robots or
  /// moving obstacles have changed, unless the last route is free and recent.
  void update_route_planner(const Vec2& target_m, Time now);
  std::vector<TemporaryObstacle> temporary_obstacles(const Vec2& target_m, Time now);
  std::vector<Circle> moving_obstacles(const Vec2& target_m, Time now);
  /// Whether a robot at rest will not move away by itself.
  bool is_to_stay(const Neighbours::Stationary& other) const;
  /// Records since when the target has been unreachable.
  void update_blockage(const Route& route, Time now);
  /// Required distance of the robot's centre from the edge of an obstacle.
  double required_separation_m() const { return rules_.radius_m + rules_.margin_m; }
  /// Preferred extra clearances of routes from obstacles, in descending order.
  std::span<const double> extra_clearances_m() const;
  /// Preferred distance of the robot's centre from the edge of an obstacle.
  double planning_separation_m() const;
  /// Whether the robot is at rest at the end of `base`, where vision agrees with its own position estimate. A
  /// version from there has no inflation.
  bool may_end_inflation(const Version& base, Time start) const;
  /// Distance between start positions beyond which versions cannot conflict.
  double search_horizon_m() const;
  /// Like search_horizon_m(), plus the distance that robots drive while a ledger page ages.
  double page_horizon_m() const;
  /// The robot's clock was set back, so it is unknown how long ago the recorded times were: restarts all
  /// timers.
  void restart_timers(Time now);
  /// If this robot makes no progress, lets it leave a passage for a robot with the right of way.
  void decide_whether_to_give_way(Time now);
  /// The robots to which this one may have to give way.
  std::vector<OtherRobot> others_in_passages(Time now);
  /// The intent, given the intents of other robots, of this robot if it is in the state `at_start` at
  /// `start`.
  Intent steer(const State& at_start, Time start, const Route& route);
  /// Like steer(), but uses the planner's local methods. Fills preferred_mps_.
  Intent steer_locally(const State& at_start, Time start, Route route);
  /// The accelerations that lead to the velocities in preferred_mps_; empty without local methods.
  std::span<const Vec2> preferred_accelerations(const Vec2& velocity_mps, Duration hold);
  /// Adds the walls of the map that a robot at a position would see to the steering.
  void add_walls(const Vec2& position_m);
  /// The time for which an acceleration may be held: from min_hold() to max_hold().
  Duration min_hold() const { return std::max(cycle_, settings_.min_hold); }
  Duration max_hold() const { return std::max(min_hold(), cycle_ * negotiation_.lead()); }
  /// The acceleration towards a place.
  AccelerationCommand hold_towards(const Vec2& displacement_m, const Vec2& velocity_mps,
                                   const MotionLimits& limits) const;
  AccelerationCommand follow(const Intent& intent, const State& at_start, const Route& route,
                             double max_speed_mps) const;
  /// Like follow(), but limited to the highest speed at which the robot comes to rest before anybody who was
  /// hidden can touch it; almost 0 if there is no such speed.
  AccelerationCommand follow_in_sight(const Intent& intent, const State& at_start, Time start,
                                      const Route& route, double max_speed_mps, const HiddenSpace& hidden);
  /// Moves away from where somebody may step out, so slowly that the robot counts as being at rest.
  AccelerationCommand creep_away(const State& at_start, const HiddenSpace& hidden) const;
  /// The floor that the laser did not see in its last scan; empty without a laser.
  HiddenSpace hidden_space() const;
  /// Remembers a corner that the robot cannot pass at any speed, if it has waited there for a while.
  void update_occlusion(const Intent& intent, const State& at_start, const HiddenSpace& hidden, Time now);
  /// Obstacles that the laser sees but the rules do not contain, and corners that the robot could not pass.
  std::vector<TemporaryObstacle> obstacles_in_sight(const Vec2& target_m) const;
  /// The direction of the route, turned right by deadlock recovery as far as obstacles allow.
  Vec2 recovery_direction(const Vec2& position_m, const Route& route) const;

  const RobotSpec robot_;
  const PlanningSettings settings_;
  const std::shared_ptr<PlanningScratch> scratch_;
  const FloorRules& rules_;
  // Maximum difference between two clocks that both stay within the clock bound.
  const Duration max_clock_difference_;
  const Duration cycle_;
  const double drift_bound_m_;
  const double goal_tolerance_m_;
  Negotiation negotiation_;
  Neighbours neighbours_;
  ObservedObstacles obstacles_;
  DisplacedObstacles displaced_;
  std::optional<LaserSight> sight_;  // nullopt: the robot has no laser
  const double max_person_speed_mps_;
  const Duration scan_period_;
  std::vector<Circle> seen_robots_;  // the robots at the time of the last scan
  std::optional<Standstill> standstill_;
  bool is_creeping_ = false;  // no speed was safe at the last planning
  std::vector<OccludedCorner> occluded_corners_;
  std::uint64_t future_scans_ = 0;
  Time watched_until_{};  // the coordinator's last comparison of the robots' places with their versions
  LastChoice last_choice_;
  Rng rng_;
  Assignment assignment_;
  bool robot_has_moved_ = false;  // the robot has executed a granted version
  /// The coordinator that was last heard in its epoch.
  struct Charge {
    std::uint32_t coordinator = 0;
    Incarnation incarnation = 0;
    Epoch epoch = 0;
  };
  Charge in_charge_;
  double desired_heading_rad_;
  ZoneMap zones_;
  NamedPlanner planner_;
  std::optional<LocalDriver> local_driver_;  // nullopt: planner_ has no local methods
  std::vector<Circle> bodies_nearby_;
  std::vector<Vec2> preferred_mps_, preferred_mps2_;  // chosen by the local methods in this cycle
  std::optional<RouteObstacles> route_obstacles_;
  std::optional<RoutePlanner> route_planner_;  // uses planner_ and route_obstacles_
  bool has_route_ = false;                     // has a route since the target or zones last changed
  bool is_route_outdated_ = false;             // obstacles have changed since routed_at_
  Time routed_at_{};
  double route_length_m_ = 0;  // length of the last route
  // Remaining length of the last route; infinite if it does not lead to the goal.
  double remaining_to_goal_m_ = 0;
  std::optional<Blockage> blockage_;  // what blocks the target
  std::optional<Time> blocked_since_;
  Time last_plan_{};
  DeadlockRecovery recovery_;
  const Duration passage_period_;  // how long a robot has the right of way in a passage
  GiveWay give_way_;
  bool is_escaping_ = false;  // the last search has found only an escape from a conflict
  bool arrived_ = false;
  State estimate_;                   // the robot's own estimate
  double max_dead_reckoning_m_ = 0;  // how far the robot may drive from estimate_ without being observed
  std::optional<PoseFix> fix_;       // observed but not yet forwarded
  Time last_fix_{};
  Vec2 last_fix_m_{0, 0};
  std::optional<Version> forwarded_;
  std::optional<Vec2> placement_m_;  // where the robot is to be put down
  std::uint64_t invalid_ = 0;        // number of observations from the future
  // Number of times that the robot has stopped because it was off its reference.
  std::uint64_t reference_losses_ = 0;
  VersionNumber last_own_stop_ = 0;  // newest of those stops
  Time last_steered_start_{};
};

}  // namespace sidestep
