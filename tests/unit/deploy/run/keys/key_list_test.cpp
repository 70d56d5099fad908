// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/keys/key_list.hpp"

#include "common/config/scenario_loader.hpp"
#include "common/process/command_line.hpp"
#include "tests/catch.hpp"

namespace sidestep::key_list_test {

std::vector<std::string> texts(const std::vector<std::string>& words) {
  std::vector<std::string> result;
  for (const Identity& identity : parse_key_list(words)) result.push_back(to_text(identity));
  return result;
}

TEST_CASE("a range of numbers gives one key per process, except that a range of robots gives one key") {
  using Texts = std::vector<std::string>;
  CHECK(texts({"agent", "3"}) == Texts{"agent 3"});
  CHECK(texts({"agent 3"}) == Texts{"agent 3"});
  CHECK(texts({"vision", "agent", "0-2", "robot", "0-10", "client", "forklift", "coordinator", "0-1",
               "judge"}) == Texts{"vision", "agent 0", "agent 1", "agent 2", "robot 0-10", "client forklift",
                                  "coordinator 0", "coordinator 1", "judge"});
  CHECK(texts({"coordinator"}) == Texts{"coordinator 0"});
  CHECK(texts({}).empty());
}

TEST_CASE("text that is not an identity is named in the error") {
  for (const std::vector<std::string>& words : {std::vector<std::string>{"agnet", "3"},
                                                {"agent"},
                                                {"agent", "3-1"},
                                                {"agent", "0-9999"},
                                                {"coordinator", "0-8"},
                                                {"agent", "x"},
                                                {"client", "a b"},
                                                {"vision", "3"},
                                                {"3"}}) {
    CAPTURE(words);
    CHECK_THROWS_AS(parse_key_list(words), UsageError);
  }
  CHECK_THROWS_WITH(parse_key_list({"agnet", "3"}),
                    ContainsSubstring("got 'agnet'") && ContainsSubstring("'agent 3', "));
  CHECK_THROWS_WITH(parse_key_list({"agent", "5000"}),
                    ContainsSubstring("expected 'agent N' with a number from 0 to 1023, got 'agent 5000'"));
}

TEST_CASE("a scenario needs keys for its processes, robots, judges, viewers and operators") {
  const auto identities = identities_of(load_scenario(SIDESTEP_SOURCE_DIR "/deploy/scenarios/crossing.yaml"));
  std::vector<std::string> texts;
  for (const Identity& identity : identities) texts.push_back(to_text(identity));
  const auto has = [&](const char* text) { return std::ranges::count(texts, text) == 1; };
  for (const char* text : {"simulator", "vision", "judge", "viewer", "operator", "coordinator 0", "agent 0",
                           "agent 7", "robot 0-7"}) {
    CAPTURE(text);
    CHECK(has(text));
  }
  CHECK(texts.size() == 5 + 1 + 8 + 1);
}

}  // namespace sidestep::key_list_test
