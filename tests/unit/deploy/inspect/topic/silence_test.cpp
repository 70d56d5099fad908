// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/silence.hpp"

#include "tests/catch.hpp"

namespace sidestep::silence_test {

DiscoveredEndpoint endpoint(const std::string& topic, const std::string& participant, bool is_writer) {
  DiscoveredEndpoint result;
  result.topic = topic;
  result.participant = participant;
  result.is_writer = is_writer;
  return result;
}

TEST_CASE("a topic that nobody writes is named with the topics that have a writer") {
  CHECK(silence_text("feedback/9", 7, {}, 0) ==
        "no process in domain 7 writes 'feedback/9' so far; topics that have a writer: none");
  CHECK(silence_text("feedback/9", 7,
                     {endpoint("world", "vision", true), endpoint("feedback/3", "simulator", true),
                      endpoint("feedback/9", "sidestep-topic", false), endpoint("world", "agent-3", false)},
                     0) ==
        "no process in domain 7 writes 'feedback/9' so far; topics that have a writer: feedback/3 world");
}

TEST_CASE("a topic with a writer but without messages is named with its writers") {
  CHECK(silence_text("order", 0, {endpoint("order", "kitchen", true), endpoint("order", "hall", true)}, 0) ==
        "'order' has a writer in domain 0 (hall, kitchen), but no message so far");
}

TEST_CASE("a filter that no message passes is named as the cause") {
  CHECK(silence_text("world", 0, {}, 12) == "none of the 12 messages of 'world' passes --filter so far");
  CHECK(silence_text("world", "run.mcap", {"world"}, 12) ==
        "run.mcap: none of the 12 messages of 'world' passes --filter");
}

TEST_CASE("a topic that a recording lacks is named with the recorded topics") {
  CHECK(silence_text("feedback/9", "run.mcap", {"world", "feedback/0"}, 0) ==
        "run.mcap: no message of 'feedback/9'; topics in this recording: feedback/0 world");
}

}  // namespace sidestep::silence_test
