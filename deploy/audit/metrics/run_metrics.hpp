// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/messaging/bus.hpp"
#include "common/messaging/rules_exchange.hpp"
#include "common/protocol/drop_reasons.hpp"
#include "common/protocol/order.hpp"
#include "deploy/audit/auditor.hpp"
#include "deploy/audit/metrics/floor_recorder.hpp"
#include "deploy/audit/metrics/report.hpp"
#include "deploy/audit/metrics/robot_sighting.hpp"
#include "idl/monitor.hpp"
#include "idl/negotiation.hpp"
#include "idl/order.hpp"

namespace sidestep {

/// One robot's row of the progress table.
struct RobotProgress {
  RobotId robot = 0;
  Team team = Team::kBlue;
  std::optional<msg::AgentState> agent_state;  ///< nullopt: no status received yet
  bool arrived = false;
  bool is_without_goal = false;  ///< at rest with nothing to arrive at: no goal in the scenario, and no order
  bool is_done = false;          ///< at rest, and arrived or without a goal
  double distance_to_go_m = 0;   ///< distance to the last goal, according to ground truth or vision
  double speed_mps = 0;
  std::uint64_t grants = 0;
  std::uint64_t denials = 0;
  Duration negotiation_p50{0};
  Duration negotiation_p99{0};
};

/// Collects the metrics of one run from its messages. A robot has arrived when its agent reports arrival and
/// ground truth, or vision where there is none, shows it at its last goal and nearly at rest. Times count
/// from the first message in which a coordinator reports that it grants. Counters are summed over all
/// incarnations of a process.
class RunMetrics {
 public:
  static constexpr double kAtRest_mps =
      0.02;  ///< a robot that is slower than this in ground truth is at rest

  /// The scenario must outlive this object.
  explicit RunMetrics(const Scenario& scenario);

  void on_truth(const msg::GroundTruth& truth);
  /// Has no effect once ground truth has been received.
  void on_world_state(const msg::WorldState& world);
  void on_status(const msg::AgentStatus& status);
  void on_order_status(const msg::OrderStatus& status);
  void on_coordinator(const msg::CoordinatorState& state);
  void on_counters(const msg::Counters& counters);
  void on_death(const std::string& process, const std::string& reason, Time at, bool restarted);
  /// Records a process whose messages are refused because its rules differ.
  void on_mismatch(const RulesMismatch& mismatch);

  /// Includes the auditor's findings in reports; the auditor must outlive the last report.
  void set_auditor(const Auditor& auditor) { auditor_ = &auditor; }

  /// Includes the drops of the monitor's own bus in reports; the bus must outlive the last report.
  void set_bus(const Bus& bus) { bus_ = &bus; }

  /// Whether the scenario gives no robot a goal, which means that clients give the orders.
  bool awaits_orders() const;
  /// Whether any robot has received a drive order from a client since the start.
  bool has_received_orders() const { return has_received_orders_; }
  /// Whether all robots have arrived, except those without a goal, which need to be at rest. A robot without
  /// a goal in the scenario has arrived if it has finished its orders.
  bool all_arrived() const;
  int arrived() const;
  /// Number of robots at rest that have no goal in the scenario, and no order.
  int without_goal() const;
  /// Whether all robots are at rest, according to ground truth or vision.
  bool all_at_rest() const;
  /// Robots whose agents have not sent a status.
  std::vector<RobotId> silent_agents() const;
  bool has_truth() const { return truth_at_.has_value(); }
  /// Whether vision or ground truth has shown robots.
  bool has_seen_robots() const { return has_truth() || seen_at_.has_value(); }
  bool has_coordinator_state() const { return active_.has_value(); }
  /// Number of robot pairs in conflict, as last reported by the coordinator.
  std::uint32_t conflicts() const { return active_ ? active_->conflicts() : 0; }
  /// The robots that the coordinator currently names, in words: "robot 3 displaced, robot 5 quarantined".
  std::string named_robots() const;
  /// The epochs that coordinators began; at most the first kMaxEpochs. Their at_s is not set.
  const std::vector<EpochRecord>& epochs() const { return epochs_; }
  static constexpr std::size_t kMaxEpochs = 200;
  /// Robots whose registrations are missing, as last reported by the coordinator.
  std::vector<RobotId> unregistered_robots() const;
  /// When a coordinator first reported that it grants.
  std::optional<Time> granting_since() const { return granting_since_; }
  /// The last time at which the robots were seen, in ground truth or by vision.
  std::optional<Time> seen_at() const { return truth_at_ ? truth_at_ : seen_at_; }
  /// Number of invalid or outdated messages that were ignored here.
  std::uint64_t dropped_messages() const { return dropped_messages_; }

  /// The last sighting of each robot that has been seen and is not off the floor.
  std::vector<RobotSighting> sightings() const;
  std::vector<RobotProgress> progress() const;
  /// The report, except for floor_trace() and what only the caller knows: program, seed, wall-clock times,
  /// and why the run ended.
  Report report() const;
  /// What happened on the floor so far. Separate from report(), which callers with a display need often.
  FloorTrace floor_trace() const { return floor_.trace(granting_since_); }

 private:
  struct RobotRecord {
    const RobotSpec* spec = nullptr;
    Vec2 position_m{0, 0};
    double speed_mps = 0;
    std::optional<RobotSighting> sighting;  ///< nullopt: it has not been seen
    bool is_at_rest = true;
    std::optional<Time> settled_since;  ///< time since which it has been nearly at rest at the last goal
    std::vector<msg::AgentStatus> incarnations;  ///< the last status of each incarnation of its agent, sorted
    Incarnation authoritative = 0;               ///< the incarnation whose status is used
    int fencing_statuses =
        0;  ///< number of statuses from fencing incarnations since the authoritative one's last status
    std::optional<Blockage> blockage;  ///< according to the latest status of its order

    /// The status to use; nullptr if there is none yet. It is the most recently received one, except that an
    /// incarnation that is still fencing is used only if no other one reports. Using the highest incarnation
    /// would be wrong: it may have started on a host whose clock was ahead, and died before its robot obeyed
    /// it.
    const msg::AgentStatus* status() const;
  };

  /// Maximum distance from the last goal, and maximum speed, at which a robot counts as settled there.
  struct SettledLimits {
    double distance_m, speed_mps;
  };
  RobotRecord* find(RobotId robot);
  /// Stores a robot's state from ground truth or vision.
  void place(RobotRecord& robot, const Vec2& position_m, double speed_mps, const SettledLimits& limits,
             Time at);
  void record_epoch(const msg::CoordinatorState& state);
  bool is_done(const RobotRecord& robot) const;
  bool is_without_goal(const RobotRecord& robot) const;
  bool has_arrived(const RobotRecord& robot) const { return is_done(robot) && !is_without_goal(robot); }
  /// Why a robot has not arrived, as a clause.
  std::string reason_not_arrived(const RobotRecord& robot) const;
  double distance_to_go_m(const RobotRecord& robot) const;
  void add_ground_truth(Report& report) const;
  void add_arrivals(Report& report) const;
  void add_agents(Report& report) const;
  void add_clocks(Report& report) const;
  void add_counters(Report& report) const;
  /// Whether the scenario has a process with this id.
  bool has_process(std::uint32_t process);

  const Scenario& scenario_;
  const Auditor* auditor_ = nullptr;
  const Bus* bus_ = nullptr;
  bool has_received_orders_ = false;
  std::vector<RobotRecord> robots_;  ///< sorted by id
  FloorRecorder floor_;
  std::vector<msg::GroundTruth> simulators_;  ///< last ground truth of each incarnation, without robots
  std::map<std::pair<std::uint32_t, Incarnation>, std::uint64_t>
      coordinators_;  ///< the last message number, by coordinator number and incarnation
  /// The last counters of one incarnation of a process.
  struct IncarnationCounters {
    Incarnation incarnation = 0;
    std::uint64_t message_number = 0;
    std::array<std::uint64_t, kDropReasonCount> counts{};
  };
  struct ProcessCounters {
    std::vector<IncarnationCounters> incarnations;  // the latest incarnations, sorted
    IncarnationCounters earlier;  // the sum over all earlier incarnations, with the number of the last one
  };
  /// The counters of an incarnation; nullptr if the incarnation is older than those kept separately.
  static IncarnationCounters* counters_of(ProcessCounters& counters, Incarnation incarnation);
  std::map<std::uint32_t, ProcessCounters> counters_;  ///< indexed by process of the scenario
  std::optional<msg::CoordinatorState> active_;        ///< the latest state in the highest epoch
  std::set<std::pair<RobotId, RobotId>> conflicts_;
  std::set<RobotId> quarantined_, displaced_;  ///< robots that the coordinator named at any time
  std::optional<Time> granting_since_;
  std::optional<Time> truth_at_;  ///< time of the latest ground truth
  std::optional<Time> seen_at_;   ///< time of the latest world state
  double max_reference_error_m_ = 0;
  std::uint64_t dropped_messages_ = 0;
  std::vector<Death> deaths_;
  std::vector<EpochRecord> epochs_;
  std::map<std::string, std::vector<RuleDifference>> mismatches_;  ///< indexed by process
};

/// Subscribes the metrics to a bus; they must outlive the bus's last callback.
void listen(Bus& bus, RunMetrics& metrics);

}  // namespace sidestep
