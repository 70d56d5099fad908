// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/topic/unmatched_readers.hpp"

#include "tests/catch.hpp"

namespace sidestep::unmatched_readers_test {

DiscoveredEndpoint reader(const std::string& participant) {
  DiscoveredEndpoint result;
  result.guid = "guid of " + participant;
  result.participant = participant;
  result.topic = "disturbance";
  result.type = "Disturbance";
  return result;
}

TEST_CASE("a publisher waits for each known reader that does not match yet") {
  const std::vector<DiscoveredEndpoint> endpoints{reader("simulator"), reader("agent-1"), reader("agent-0")};
  const auto missing = [&](const std::set<std::string>& matched) {
    return unmatched_readers(endpoints, "disturbance", {"Disturbance", false}, matched);
  };
  using Names = std::vector<std::string>;
  CHECK(missing({}) == Names{"agent-0", "agent-1", "simulator"});
  CHECK(missing({"guid of agent-1"}) == Names{"agent-0", "simulator"});
  CHECK(missing({"guid of agent-0", "guid of agent-1", "guid of simulator"}).empty());
}

TEST_CASE(
    "a publisher does not wait for writers, readers of other topics, or readers that it never matches") {
  DiscoveredEndpoint writer = reader("vision"), elsewhere = reader("agent-0"), typed = reader("agent-1"),
                     keyed = reader("agent-2"), apart = reader("agent-3"), persistent = reader("agent-4");
  writer.is_writer = true;
  elsewhere.topic = "world";
  typed.type = "Other";
  keyed.is_keyed = true;
  apart.partitions = {"blue"};
  persistent.durability = DiscoveredEndpoint::Durability::kPersistent;
  CHECK(unmatched_readers({writer, elsewhere, typed, keyed, apart, persistent}, "disturbance",
                          {"Disturbance", false}, {})
            .empty());
}

TEST_CASE("a reader of a process without a name is named by its GUID") {
  DiscoveredEndpoint nameless = reader("");
  nameless.is_reliable = true;
  nameless.durability = DiscoveredEndpoint::Durability::kTransientLocal;
  CHECK(unmatched_readers({nameless}, "disturbance", {"Disturbance", false}, {}) ==
        std::vector<std::string>{"guid of "});
}

}  // namespace sidestep::unmatched_readers_test
