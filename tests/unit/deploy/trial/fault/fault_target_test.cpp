// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/fault/fault_target.hpp"

#include "tests/catch.hpp"

namespace sidestep::fault_target_test {

TEST_CASE("fault targets have the same names as in reports, and other names are rejected") {
  const auto number = [](const std::string& text) { return parse_fault_target(text)->number; };
  CHECK(number("all") == kEveryProcess);
  CHECK(parse_fault_target("all")->participant.empty());
  CHECK(number("agent 3") == 3);
  CHECK(parse_fault_target("agent 3")->participant == "agent-3");
  CHECK(number("agent 1023") == 1023);
  CHECK(number("coordinator") == 10000);
  CHECK(parse_fault_target("coordinator")->participant == "sidestep-coordinator");
  CHECK(number("coordinator 1") == 10001);
  CHECK(parse_fault_target("coordinator 1")->participant == "coordinator-1");
  CHECK(number("vision") == 20000);
  CHECK(number("simulator") == 30000);
  CHECK(number("robots") == 35000);
  CHECK(parse_fault_target("robots")->participant == "robots");
  for (const char* text : {"", "agent", "agent ", "agent 1024", "agent -1", "agent 3 4", "agent 3x",
                           "robot 3", "coordinator 8", "vision 1", "everybody"}) {
    INFO(text);
    CHECK_FALSE(parse_fault_target(text));
  }
}

TEST_CASE("observers that read faults do not apply them") {
  const std::vector<std::string> processes{
      "agent-0",          "agent-1023",         "coordinator-1",  "robots", "sidestep-coordinator",
      "sidestep-referee", "sidestep-simulator", "sidestep-vision"};
  std::vector<std::string> subscribers = processes;
  for (const char* observer : {"sidestep-monitor", "sidestep-record", "sidestep-run", "sidestep-test",
                               "sidestep-topic", "sidestep-audit", "sidestep-graph", "agent", ""})
    subscribers.emplace_back(observer);
  CHECK(without_observers(subscribers) == processes);
  CHECK(without_observers({"sidestep-monitor"}).empty());
  for (const char* target : {"agent 3", "coordinator", "coordinator 1", "vision", "simulator", "robots"}) {
    const std::string participant = parse_fault_target(target)->participant;
    CHECK(without_observers({participant}) == std::vector{participant});
  }
}

}  // namespace sidestep::fault_target_test
