// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "deploy/monitor/audit/auditor.hpp"
#include "deploy/monitor/metrics/report.hpp"
#include "idl/monitor.h"
#include "idl/negotiation.h"

namespace sidestep {

/// One robot's line of the progress table.
struct RobotProgress {
  RobotId robot = 0;
  Team team = Team::kBlue;
  std::optional<msg::AgentState> phase;  ///< none: no status seen yet
  bool arrived = false;
  double distance_to_go_m = 0;  ///< to the last goal, in ground truth
  double speed_mps = 0;
  std::uint64_t grants = 0;
  std::uint64_t denials = 0;
  Duration negotiation_p50{0};
  Duration negotiation_p99{0};
};

/// Watches one run from outside and says how it went. A robot has arrived when ground truth has it at its
/// last goal, nearly at rest, and its agent says so. Times count from the first moment on which a coordinator
/// said that it grants. Counters of processes that were restarted are summed over their lives.
class RunMetrics {
 public:
  /// The scenario outlives the judge.
  explicit RunMetrics(const Scenario& scenario);

  void on_truth(const msg::GroundTruth& truth);
  void on_status(const msg::AgentStatus& status);
  void on_coordinator(const msg::CoordinatorState& state);
  void on_death(const std::string& process, const std::string& reason, Time at, bool restarted);

  /// Puts what the auditor finds into the report; it outlives the judge's last report.
  void include(const Auditor& auditor) { auditor_ = &auditor; }

  bool all_arrived() const;
  int arrived() const;
  /// Whether no robot moves in the latest ground truth.
  bool all_at_rest() const;
  /// Robots whose agents have not been heard.
  std::vector<RobotId> silent_agents() const;
  bool truth_seen() const { return truth_at_.has_value(); }
  bool coordinator_seen() const { return active_.has_value(); }
  /// Pairs of robots that may come too near to each other, as the coordinator last said.
  std::uint32_t conflicts() const { return active_ ? active_->conflicts() : 0; }
  /// Robots that the coordinator misses, as it last said.
  std::vector<RobotId> unregistered() const;
  /// When a coordinator first granted.
  std::optional<Time> granting_since() const { return granting_since_; }
  /// The latest ground truth's time.
  std::optional<Time> truth_at() const { return truth_at_; }
  /// Messages that made no sense and were dropped here.
  std::uint64_t dropped() const { return dropped_; }

  std::vector<RobotProgress> progress() const;
  /// All of the report but what only the caller knows: seed, wall-clock times, and why the run ended.
  Report report() const;

 private:
  struct Watched {
    const RobotSpec* spec;
    Vec2 position_m{0, 0};
    double speed_mps = 0;
    std::optional<Time> settled_since;    ///< at the last goal and slow, without a break
    std::vector<msg::AgentStatus> lives;  ///< the last status of each life of its agent, in order
    Incarnation speaker = 0;              ///< the incarnation of the one of them that speaks for the robot
    int others = 0;                       ///< statuses since then of others that are but fencing

    /// What the robot's agent says, nullptr: nothing yet. Of several lives it is the one that was heard last,
    /// of those that are but fencing only while no other speaks. Not the highest incarnation: that may have
    /// died before its robot obeyed it, and on a host whose clock was ahead.
    const msg::AgentStatus* speaks() const;
  };

  Watched* find(RobotId robot);
  bool has_arrived(const Watched& robot) const;
  double to_go_m(const Watched& robot) const;

  const Scenario& scenario_;
  const Auditor* auditor_ = nullptr;
  std::vector<Watched> robots_;               ///< ascending by id
  std::vector<msg::GroundTruth> simulators_;  ///< the last counters of each life, without robots
  struct CoordinatorLife {
    std::uint64_t message_number = 0;
    std::uint64_t invalid = 0;
  };
  std::map<std::pair<std::uint32_t, Incarnation>, CoordinatorLife> coordinators_;  ///< by number and life
  std::optional<msg::CoordinatorState> active_;  ///< the latest state of the highest epoch
  std::set<std::pair<RobotId, RobotId>> conflicts_;
  std::optional<Time> granting_since_;
  std::optional<Time> truth_at_;
  double max_reference_error_m_ = 0;
  std::uint64_t dropped_ = 0;
  std::vector<Death> deaths_;
};

/// The names under which everybody who starts and watches processes knows a robot's agent, and a coordinator:
/// "agent 3", "coordinator", "coordinator 1".
std::string agent_process(RobotId robot);
std::string coordinator_process(int number);

/// The shortest time from the start over all goals for a robot alone: straight lines, at rest at each goal,
/// acceleration F, deceleration D, at most v_max.
double straight_time_s(const RobotSpec& robot, const MotionLimits& limits);

}  // namespace sidestep
