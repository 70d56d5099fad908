// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/topic_access.hpp"

#include <set>

#include "tests/catch.hpp"

namespace sidestep::topic_access_test {

constexpr Role kAllRoles[] = {Role::kAgent,  Role::kCoordinator, Role::kVision, Role::kSimulator,
                              Role::kRobot,  Role::kReferee,     Role::kClient, Role::kOperator,
                              Role::kViewer, Role::kJudge};

Identity identity(const std::string& text) { return parse_identity(text).value(); }

/// The names of all topics with a channel that `who` may write or read.
std::set<std::string> topics_of(const Identity& who,
                                bool (*may)(const Identity&, const TopicInfo&, std::uint32_t)) {
  std::set<std::string> result;
  for (const TopicInfo& topic : all_topics())
    for (std::uint32_t robot = 0; robot < 20; ++robot)
      if (may(who, topic, robot)) result.insert(topic.name);
  return result;
}

TEST_CASE("only judges may read the ground truth, and viewers and judges may not write any topic") {
  for (const Role role : kAllRoles) {
    const Identity who{role, 0, 0, "a"};
    CAPTURE(to_text(who));
    CHECK((topics_of(who, may_read).count("truth") > 0) == (role == Role::kJudge));
  }
  CHECK(topics_of({Role::kViewer}, may_write).empty());
  CHECK(topics_of({Role::kJudge}, may_write).empty());
  CHECK(topics_of({Role::kClient, 0, 0, "a"}, may_write) == std::set<std::string>{"order"});
  CHECK(topics_of({Role::kOperator}, may_write) == std::set<std::string>{"attestation", "order",
                                                                         "disturbance", "network_fault",
                                                                         "clock_probe", "rules"});
}

TEST_CASE("agents and robots can access only their own robots' channels") {
  const Identity agent = identity("agent 3"), robots = identity("robot 2-4");
  for (std::uint32_t robot = 0; robot < 8; ++robot) {
    CAPTURE(robot);
    CHECK(may_write(agent, topics::kCommand, robot) == (robot == 3));
    CHECK(may_read(agent, topics::kFeedback, robot) == (robot == 3));
    CHECK(may_read(agent, topics::kVerdict, robot) == (robot == 3));
    CHECK(may_write(robots, topics::kFeedback, robot) == (robot >= 2 && robot <= 4));
    CHECK(may_read(robots, topics::kCommand, robot) == (robot >= 2 && robot <= 4));
    CHECK(may_write({Role::kSimulator}, topics::kFeedback, robot));
    CHECK(may_write({Role::kCoordinator}, topics::kVerdict, robot));
    CHECK_FALSE(may_write(agent, topics::kVerdict, robot));
    CHECK_FALSE(may_write({Role::kCoordinator}, topics::kCommand, robot));
  }
}

TEST_CASE("agents exchange messages with all processes except other agents and other agents' robots") {
  const auto exchange = [](const char* a, const char* b) {
    return exchange_messages(identity(a), identity(b));
  };
  CHECK_FALSE(exchange("agent 1", "agent 2"));
  CHECK_FALSE(exchange("agent 1", "robot 2-4"));
  CHECK_FALSE(exchange("viewer", "judge"));
  CHECK(exchange("agent 3", "robot 2-4"));
  CHECK(exchange("robot 2-4", "agent 3"));
  for (const char* other :
       {"coordinator 0", "vision", "simulator", "viewer", "judge", "operator", "client a", "referee"}) {
    CAPTURE(other);
    CHECK(exchange("agent 1", other));
    CHECK(exchange(other, "agent 1"));
  }
  CHECK(exchange("coordinator 0", "coordinator 1"));
}

}  // namespace sidestep::topic_access_test
