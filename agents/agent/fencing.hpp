// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>

#include "common/protocol/robot_messages.hpp"

namespace sidestep {

/// Determines from the robot's reports which agent the robot obeys. An agent may register and propose only
/// for a robot that obeys it (coordinator/PROTOCOL.md, "Robots fence epochs").
class Fencing {
 public:
  /// The consequences of a robot's report for the agent.
  struct ReportUse {
    bool is_acknowledged = false;     ///< the robot obeys this agent
    bool is_first = false;            ///< this is the first report that acknowledges this agent
    bool is_current = false;          ///< the report belongs to the robot's current incarnation
    bool is_new_incarnation = false;  ///< the report is the first of the robot's current incarnation
  };

  explicit Fencing(Incarnation incarnation) : incarnation_(incarnation) {}

  ReportUse on_robot_report(const RobotReport& robot_report);
  void close_cycle();

  /// The incarnation sent with commands. It changes only before the robot has acknowledged this agent.
  Incarnation incarnation() const { return incarnation_; }
  /// The robot's current incarnation. 0: it has not reported yet.
  Incarnation robot_incarnation() const { return robot_incarnation_; }
  /// The highest epoch that the robot has acknowledged.
  Epoch robot_epoch() const { return robot_epoch_; }
  /// The epoch that the robot obeyed when it acknowledged this agent. 0: it obeyed no epoch, or has not
  /// acknowledged this agent yet.
  Epoch former_epoch() const { return former_epoch_; }
  bool is_fenced() const { return fenced_at_.has_value(); }
  /// When the robot acknowledged this agent, by the robot's clock.
  std::optional<Time> fenced_at() const { return fenced_at_; }
  /// Whether the robot obeys a later agent. If so, this agent stays silent.
  bool is_superseded() const { return superseded_at_.has_value(); }
  /// Whether the robot's last report acknowledged a later agent, and the robot has been silent for half a
  /// second since. Commands continue in this case, because they carry the pose fixes without which a robot
  /// cannot report which agent it obeys. If the robot does obey a later agent, it refuses the commands.
  bool must_query_robot(Duration cycle) const;
  /// Number of cycles since the last report that acknowledges this agent.
  int cycles_since_acknowledgement() const { return cycles_since_acknowledgement_; }

 private:
  void update_incarnation(const RobotReport& robot_report, ReportUse& use);
  void on_later_agent(const RobotReport& robot_report, bool is_current);

  Incarnation incarnation_;
  std::optional<Time> fenced_at_;
  std::optional<Time> superseded_at_;  // time of the latest report that acknowledges a later agent
  Epoch robot_epoch_ = 0, former_epoch_ = 0;
  Incarnation robot_incarnation_ = 0;       // report times of different incarnations are not compared
  int reports_of_earlier_incarnation_ = 0;  // number of consecutive reports
  int cycles_since_report_ = 0;             // number of cycles since the last report about any agent
  int cycles_since_acknowledgement_ = 0;
};

}  // namespace sidestep
