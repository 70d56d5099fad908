// SPDX-License-Identifier: Apache-2.0
#include "common/protocol/role_cause.hpp"

#include "tests/catch.hpp"

namespace sidestep::role_cause_test {

TEST_CASE("the reason for an epoch is described with the silence in milliseconds") {
  const RoleCause lost{msg::RoleReason::ROLE_HEARTBEATS_LOST, 3, std::chrono::milliseconds(120), 0};
  CHECK(describe(lost) == "no heartbeat of coordinator 3 for 120 ms");
  const RoleCause first{msg::RoleReason::ROLE_NO_COORDINATOR, 0, std::chrono::milliseconds(1500), 0};
  CHECK(describe(first) == "no coordinator was active for 1500 ms after the start");
  const RoleCause returned{msg::RoleReason::ROLE_RETURNED, 0, std::chrono::milliseconds(400), 0};
  CHECK(describe(returned) == "no heartbeat of a higher epoch for 400 ms after yielding to it");
}

TEST_CASE("the reason for an epoch names the process that knew a higher epoch or shared it") {
  CHECK(describe({msg::RoleReason::ROLE_EPOCH_OF_COORDINATOR, 1, Duration{0}, 77}) ==
        "coordinator 1 has the higher epoch 77");
  CHECK(describe({msg::RoleReason::ROLE_EPOCH_OF_AGENT, 5, Duration{0}, 77}) ==
        "the agent of robot 5 knows the higher epoch 77");
  CHECK(describe({msg::RoleReason::ROLE_EPOCH_OF_AGENT, 5, Duration{0}, 0}) ==
        "the agent of robot 5 asks for another coordinator");
  CHECK(describe({msg::RoleReason::ROLE_EPOCH_OF_ROBOT, 5, Duration{0}, 77}) ==
        "robot 5 obeys the higher epoch 77");
  CHECK(describe({msg::RoleReason::ROLE_SHARED_EPOCH, 2, Duration{0}, 0}) ==
        "another process with number 2 started the same epoch");
}

}  // namespace sidestep::role_cause_test
