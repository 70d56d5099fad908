// SPDX-License-Identifier: Apache-2.0
#include "common/file/similar_name.hpp"

#include "tests/catch.hpp"

namespace sidestep::similar_name_test {

using Names = std::vector<std::string>;

const Names kCommands{"run", "simulate", "go", "record", "replay", "resume", "status"};

TEST_CASE("a mistyped name stands for the names with the fewest typing errors") {
  const auto [text, expected] = GENERATE(table<std::string, Names>({{"simulat", {"simulate"}},
                                                                    {"simluate", {"simulate"}},
                                                                    {"STATUS", {"status"}},
                                                                    {"rnu", {"run"}},
                                                                    {"re", {"record", "replay", "resume"}},
                                                                    {"relay", {"replay"}},
                                                                    {"stat", {"status"}},
                                                                    {"explode", {}},
                                                                    {"x", {}},
                                                                    {"", {}}}));
  CAPTURE(text);
  CHECK(similar_names(text, kCommands) == expected);
}

TEST_CASE("a long text stands for nothing and costs no time") {
  CHECK(similar_names(std::string(1'000'000, 'r'), kCommands).empty());
}

TEST_CASE("the question lists the names, and is empty without any") {
  CHECK(did_you_mean("rnu", kCommands) == "; did you mean run?");
  CHECK(did_you_mean("re", kCommands) == "; did you mean record or replay or resume?");
  CHECK(did_you_mean("explode", kCommands).empty());
}

}  // namespace sidestep::similar_name_test
