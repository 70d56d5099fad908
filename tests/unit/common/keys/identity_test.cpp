// SPDX-License-Identifier: Apache-2.0
#include "common/keys/identity.hpp"

#include <set>

#include "common/motion/version.hpp"
#include "common/protocol/senders.hpp"
#include "tests/catch.hpp"

namespace sidestep::identity_test {

constexpr Role kAllRoles[] = {Role::kAgent,  Role::kCoordinator, Role::kVision, Role::kSimulator,
                              Role::kRobot,  Role::kReferee,     Role::kClient, Role::kOperator,
                              Role::kViewer, Role::kJudge};

Identity identity(const std::string& text) { return parse_identity(text).value(); }

/// The names of all topics of which it may write, or read, some channel.
std::set<std::string> topics_of(const Identity& who,
                                bool (*may)(const Identity&, const TopicInfo&, std::uint32_t)) {
  std::set<std::string> result;
  for (const TopicInfo& topic : all_topics())
    for (std::uint32_t robot = 0; robot < 20; ++robot)
      if (may(who, topic, robot)) result.insert(topic.name);
  return result;
}

TEST_CASE("identities are parsed from the text that they are written as") {
  for (const char* text :
       {"agent 0", "agent 3", "coordinator 1", "vision", "simulator", "robot 3", "robot 0-10", "referee",
        "client forklift", "client a_b-C9", "operator", "viewer", "judge"}) {
    CAPTURE(text);
    CHECK(to_text(identity(text)) == text);
  }
  CHECK(identity("coordinator") == identity("coordinator 0"));
  CHECK(folder_name(identity("robot 0-10")) == "robot-0-10");
}

TEST_CASE("each identity has one text, and other texts are refused") {
  for (const char* text : {"",
                           "agent",
                           "agent ",
                           "agent 03",
                           "agent -1",
                           "agent 3 ",
                           "agent 0-3",
                           "agent 1024",
                           "agent x",
                           "agent 3x",
                           "Agent 3",
                           "coordinator 8",
                           "coordinator 0-1",
                           "vision 1",
                           "robot",
                           "robot 3-3",
                           "robot 4-3",
                           "robot 3-",
                           "robot -3",
                           "robot 0-1024",
                           "client",
                           "client ",
                           "client a b",
                           "client a/b",
                           "client -a",
                           "client ..",
                           "client 123456789012345678901234567890123",
                           "operator x",
                           "nobody",
                           "viewer\n"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_identity(text));
  }
}

TEST_CASE("only judges read the ground truth, and watchers write nothing that moves a robot") {
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

TEST_CASE("agents and robots have only the channels of their own robots") {
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

TEST_CASE("agents exchange no messages with each other, but all other processes that work together do") {
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

TEST_CASE("nobody speaks for another process") {
  std::set<std::uint32_t> senders{1, 2, 3, kMaxRobots - 1, client_id("a"), client_id("b")};
  for (const Sender sender : {Sender::kVision, Sender::kSimulator, Sender::kRobots, Sender::kOperator,
                              Sender::kReferee, Sender::kScenario})
    senders.insert(static_cast<std::uint32_t>(sender));
  for (std::uint32_t number = 0; number < 3; ++number)
    senders.insert(static_cast<std::uint32_t>(Sender::kCoordinator) + number);
  const auto spoken_for = [&](const char* text) {
    std::set<std::uint32_t> result;
    for (const std::uint32_t sender : senders)
      if (may_speak_as(identity(text), sender)) result.insert(sender);
    return result;
  };
  const auto number = [](Sender sender) { return static_cast<std::uint32_t>(sender); };
  CHECK(spoken_for("agent 3") == std::set<std::uint32_t>{3});
  CHECK(spoken_for("coordinator 1") == std::set<std::uint32_t>{number(Sender::kCoordinator) + 1});
  CHECK(spoken_for("vision") == std::set<std::uint32_t>{number(Sender::kVision)});
  CHECK(spoken_for("referee") == std::set<std::uint32_t>{number(Sender::kReferee)});
  CHECK(spoken_for("robot 2-3") == std::set<std::uint32_t>{2, 3, number(Sender::kRobots)});
  CHECK(spoken_for("client a") == std::set<std::uint32_t>{client_id("a")});
  CHECK(spoken_for("operator") ==
        std::set<std::uint32_t>{number(Sender::kOperator), client_id("a"), client_id("b")});
  CHECK(spoken_for("viewer").empty());
  CHECK(spoken_for("judge").empty());
  // The simulator has the robots' side of all robots.
  CHECK(spoken_for("simulator") ==
        std::set<std::uint32_t>{1, 2, 3, kMaxRobots - 1, number(Sender::kSimulator)});
}

}  // namespace sidestep::identity_test
