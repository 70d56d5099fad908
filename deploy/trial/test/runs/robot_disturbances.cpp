// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/runs/robot_disturbances.hpp"

#include <fmt/format.h>

#include "common/messaging/disturbance_answer.hpp"
#include "simulator/world/disturbance_codec.hpp"

namespace sidestep {

void RobotDisturbances::begin(const RobotDisturbance& disturbance, const PlannedFault& planned) {
  const auto add_problem = [this, robot = disturbance.robot, at_s = planned.at_s,
                            text = planned.text](const std::optional<msg::DisturbanceResult>& result) {
    if (result == msg::DisturbanceResult::FAULT_APPLIED) return;
    problems_.push_back(
        {at_s, fmt::format("{}: {}", text,
                           result ? refusal_text(robot, *result) : "the simulator does not answer")});
  };
  client_.send(encode(disturbance), add_problem);
}

const std::vector<FaultProblem>& RobotDisturbances::problems() {
  client_.give_up();
  return problems_;
}

}  // namespace sidestep
