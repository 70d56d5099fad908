// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>
#include <vector>

#include "deploy/trial/simulate/campaign/fault_plan.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"

namespace sidestep {

/// A person on the floor who sees the robots and does what the protocol requires of operators: puts robots
/// down, carries them, and attests that a robot without power is absent.
class FloorOperator {
 public:
  /// System and scenario must outlive the operator.
  FloorOperator(SimSystem& system, const Scenario& scenario);

  /// Carries a robot that is on the floor; it arrives by `limit`.
  void carry(const Carry& carry, Time limit);
  void place(const Place& place);
  void take_away(RobotId robot);
  /// From now on, resumes all robots whenever any is held, because coordinators that have all been restarted
  /// hold all robots until an operator resumes them. The robots' orders are then lost, so the operator sends
  /// robots without an order to the scenario's goals again.
  void resume_held_robots() { resumes_ = true; }

  /// When the operator acts next; nullopt if there is nothing to do.
  std::optional<Time> due() const;
  /// Acts if it is time.
  void update();

 private:
  struct Placing {
    Place request;
    std::size_t requests = 0;  ///< number of requests made so far
    bool is_off_floor =
        false;  ///< the robot has been seen off the floor, which may be long after the lifting was requested
  };
  const Vec2* position_of(RobotId robot) const;
  void resume_if_held();
  void send_to_goals();
  void give(msg::OrderKind kind, RobotId robot, std::vector<Goal> goals = {});

  SimSystem& system_;
  const Scenario& scenario_;
  SimBus bus_;
  Writer<msg::AbsenceAttestation> attestation_writer_;
  std::map<RobotId, Vec2> on_floor_;
  std::vector<Placing> placings_;
  std::set<RobotId> taken_away_;
  bool resumes_ = false;
  bool are_orders_lost_ = false;  ///< a coordinator has held all robots in its own name
  Time resumed_at_{}, sent_at_{};
  Time due_{};
};

}  // namespace sidestep
