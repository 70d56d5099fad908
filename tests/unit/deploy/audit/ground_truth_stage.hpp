// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/unit/deploy/audit/stage.hpp"

namespace sidestep {

/// A stage whose simulator shows both robots in place unless a test changes that.
struct GroundTruthStage : Stage {
  explicit GroundTruthStage(const AuditInput& input = kComplete, double inflation_m = 0)
      : Stage(stage_scenario(), input) {
    truth.robots().resize(2);
    for (RobotId robot = 0; robot < 2; ++robot) {
      truth.robots()[robot].robot(robot);
      robot_reports[robot].executing().inflation_m(inflation_m);
      truth.robots()[robot].x_m(scenario.robots[robot].start_m.x());
      truth.robots()[robot].disturbance_end_ns(-1);
    }
    begin();
  }
  void show() { show(now); }
  void show(Time valid_at) {
    msg::GroundTruth message = truth;
    message.header(header("truth", 30'000, incarnation));
    message.valid_at_ns(to_ns(valid_at));
    auditor.on_truth(message, now);
  }
  /// Sends ground truth and then both robots' reports, which are compared with it.
  void run(Duration duration) {
    for (const Time end = now + duration; now < end;) {
      advance(std::chrono::milliseconds(10));
      show();
      advance(std::chrono::milliseconds(1));
      for (RobotId robot = 0; robot < 2; ++robot) report(robot);
    }
  }
  /// Adds one contact to the simulator's count.
  void touch(RobotId first, RobotId second) {
    msg::ContactPair& contact = truth.recent_contacts()[truth.contacts() % msg::MAX_CONTACTS];
    contact.first(first);
    contact.second(second);
    truth.contacts(truth.contacts() + 1);
  }
  void crash(RobotId robot) {
    truth.recent_moving_crashes()[truth.crashes_while_moving() % msg::MAX_CONTACTS] = robot;
    truth.crashes_while_moving(truth.crashes_while_moving() + 1);
  }
  void push(RobotId robot) { truth.robots()[robot].disturbance_end_ns(to_ns(now)); }
  std::uint64_t position() const { return count(AuditRule::kPosition); }

  msg::GroundTruth truth;
  Incarnation incarnation = 800;
};

}  // namespace sidestep
