// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>
#include <vector>

#include "deploy/simulate/campaign/fault_plan.hpp"
#include "deploy/simulate/system/sim_system.hpp"

namespace sidestep {

/// A person at the floor, who sees where robots are and does what the protocol asks of operators: puts robots
/// down, carries them, and attests that a robot without power is absent.
class FloorOperator {
 public:
  /// The system must outlive the operator.
  explicit FloorOperator(SimSystem& system);

  /// Carries a robot that is on the floor; it arrives no later than `limit`.
  void carry(const Carry& carry, Time limit);
  void place(const Place& place);
  void take_away(RobotId robot);
  /// From now on, resumes all robots while any is held: after a restart of everything, coordinators hold all
  /// robots for an operator.
  void resume_held() { resumes_ = true; }

  /// When the operator acts next; nullopt: has nothing to do.
  std::optional<Time> due() const;
  /// Acts if it is time.
  void update();

 private:
  struct Placing {
    Place request;
    std::size_t requests = 0;   ///< made so far
    bool is_off_floor = false;  ///< has been seen off the floor; the lifting may take effect late
  };
  const Vec2* position_of(RobotId robot) const;
  void resume_if_held();
  void publish(const RobotDisturbance& disturbance);

  SimSystem& system_;
  SimBus bus_;
  Writer<msg::AbsenceAttestation> attestation_writer_;
  std::map<RobotId, Vec2> on_floor_;
  std::vector<Placing> placings_;
  std::set<RobotId> taken_away_;
  bool resumes_ = false;
  Time resumed_at_{};
  Time due_{};
};

}  // namespace sidestep
