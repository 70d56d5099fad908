// SPDX-License-Identifier: Apache-2.0
#include "common/process/process_identity.hpp"

#include "common/config/scenario_loader.hpp"
#include "common/protocol/process_names.hpp"
#include "tests/catch.hpp"

namespace sidestep::process_identity_test {

TEST_CASE("the identity of each process of a run follows from its process id") {
  const Scenario scenario = load_scenario(SIDESTEP_SCENARIO);
  for (const char* name : {"agent 0", "agent 7", "coordinator 1", "vision", "simulator"}) {
    CAPTURE(name);
    CHECK(to_text(identity_of_process(process_id(name).value(), scenario)) == name);
  }
  CHECK(to_text(identity_of_process(static_cast<std::uint32_t>(Sender::kCoordinator), scenario)) ==
        "coordinator 0");
  CHECK(to_text(identity_of_process(static_cast<std::uint32_t>(Sender::kReferee), scenario)) == "referee");
  CHECK(to_text(identity_of_process(static_cast<std::uint32_t>(Sender::kRobots), scenario)) == "robot 0-7");
  CHECK_THROWS_AS(identity_of_process(static_cast<std::uint32_t>(Sender::kOperator), scenario),
                  std::logic_error);
}

}  // namespace sidestep::process_identity_test
