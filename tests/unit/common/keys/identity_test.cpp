// SPDX-License-Identifier: Apache-2.0
#include "common/keys/identity.hpp"

#include <set>

#include "common/motion/version.hpp"
#include "common/protocol/senders.hpp"
#include "tests/catch.hpp"

namespace sidestep::identity_test {

Identity identity(const std::string& text) { return parse_identity(text).value(); }

TEST_CASE("an identity survives writing as text and parsing") {
  for (const char* text :
       {"agent 0", "agent 3", "coordinator 1", "vision", "simulator", "robot 3", "robot 0-10", "referee",
        "client forklift", "client a_b-C9", "operator", "viewer", "judge"}) {
    CAPTURE(text);
    CHECK(to_text(identity(text)) == text);
  }
  CHECK(identity("coordinator") == identity("coordinator 0"));
  CHECK(folder_name(identity("robot 0-10")) == "robot-0-10");
}

TEST_CASE("the form that is expected instead of a text depends on its first word, and names the limits") {
  CHECK(expected_identity("agent 5000") == "'agent N' with a number from 0 to 1023");
  CHECK(expected_identity("robot") == "'robot N' with a number from 0 to 1023");
  CHECK(expected_identity("coordinator 8") == "'coordinator N' with a number from 0 to 7");
  CHECK_THAT(expected_identity("client a b"), StartsWith("'client NAME' with a name of 1 to 32 letters"));
  CHECK(expected_identity("vision 1") == identity_forms());
  CHECK(expected_identity("agnet 3") == identity_forms());
}

TEST_CASE("each identity has exactly one text form, and other texts are rejected") {
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

TEST_CASE("no identity may use the sender id of another process") {
  std::set<std::uint32_t> senders{1, 2, 3, kMaxRobots - 1, client_id("a"), client_id("b")};
  for (const Sender sender : {Sender::kVision, Sender::kSimulator, Sender::kRobots, Sender::kOperator,
                              Sender::kReferee, Sender::kScenario})
    senders.insert(static_cast<std::uint32_t>(sender));
  for (std::uint32_t number = 0; number < 3; ++number)
    senders.insert(static_cast<std::uint32_t>(Sender::kCoordinator) + number);
  const auto allowed_senders = [&](const char* text) {
    std::set<std::uint32_t> result;
    for (const std::uint32_t sender : senders)
      if (may_use_sender(identity(text), sender)) result.insert(sender);
    return result;
  };
  const auto number = [](Sender sender) { return static_cast<std::uint32_t>(sender); };
  CHECK(allowed_senders("agent 3") == std::set<std::uint32_t>{3});
  CHECK(allowed_senders("coordinator 1") == std::set<std::uint32_t>{number(Sender::kCoordinator) + 1});
  CHECK(allowed_senders("vision") == std::set<std::uint32_t>{number(Sender::kVision)});
  CHECK(allowed_senders("referee") == std::set<std::uint32_t>{number(Sender::kReferee)});
  CHECK(allowed_senders("robot 2-3") == std::set<std::uint32_t>{2, 3, number(Sender::kRobots)});
  CHECK(allowed_senders("client a") == std::set<std::uint32_t>{client_id("a")});
  CHECK(allowed_senders("operator") ==
        std::set<std::uint32_t>{number(Sender::kOperator), client_id("a"), client_id("b")});
  CHECK(allowed_senders("viewer").empty());
  CHECK(allowed_senders("judge").empty());
  // The simulator also runs the robot side of every robot.
  CHECK(allowed_senders("simulator") ==
        std::set<std::uint32_t>{1, 2, 3, kMaxRobots - 1, number(Sender::kSimulator)});
}

}  // namespace sidestep::identity_test
