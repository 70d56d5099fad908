// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/listener.hpp"

#include <algorithm>

#include "common/process/host_name.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/messaging/dds/test_support.hpp"

namespace sidestep::listener_test {

DiscoveredEndpoint endpoint(bool is_writer) {
  DiscoveredEndpoint result;
  result.topic = "topic";
  result.type = "Type";
  result.is_writer = is_writer;
  return result;
}

const DiscoveredEndpoint* find(const std::vector<DiscoveredEndpoint>& endpoints, const std::string& topic,
                               bool is_writer) {
  const auto found = std::find_if(endpoints.begin(), endpoints.end(), [&](const DiscoveredEndpoint& e) {
    return e.topic == topic && e.is_writer == is_writer;
  });
  return found == endpoints.end() ? nullptr : &*found;
}

TEST_CASE("a listener lists writers and readers, and notices when they leave") {
  constexpr Topic<msg::Verdict> kEvent{{"test/event",
                                        {},
                                        {},
                                        Qos::kEvent,
                                        false,
                                        false,
                                        message_type<msg::Verdict>("sidestep::msg::Verdict")}};
  DdsListener listener(test_settings("listener"));
  {
    DdsBus bus(test_settings("other"));
    const auto state = bus.advertise(topics::kFeedback, 3);
    bus.subscribe<msg::Verdict>(kEvent, [](const msg::Verdict&) {});
    REQUIRE(run_until([&] { return listener.endpoints().size() == 2; }, listener));
    const std::vector<DiscoveredEndpoint> endpoints = listener.endpoints();
    const DiscoveredEndpoint* writer = find(endpoints, "feedback/3", true);
    const DiscoveredEndpoint* reader = find(endpoints, "test/event", false);
    REQUIRE(writer != nullptr);
    REQUIRE(reader != nullptr);
    CHECK(writer->participant == "other");
    CHECK(writer->host == host_name());
    CHECK(writer->type == "sidestep::msg::Feedback");
    CHECK(writer->is_keyed);
    CHECK_FALSE(writer->is_reliable);
    CHECK(reader->is_reliable);
    CHECK(reader->type == "sidestep::msg::Verdict");
  }
  CHECK(run_until([&] { return listener.endpoints().empty(); }, listener));
}

TEST_CASE("a host's name is what comes before the number that Fast DDS appends") {
  CHECK(announced_host("kitchen:17164142299256324096") == "kitchen");
  CHECK(announced_host("a:b:7") == "a:b");
  CHECK(announced_host("kitchen") == "kitchen");
  CHECK(announced_host("") == "");
  CHECK(announced_host("kit\nchen\x1b[2J:7").find_first_of("\n\x1b") == std::string::npos);
}

TEST_CASE("an operator's process announces its host, too") {
  DdsListener listener(test_settings("listener"));
  DdsSettings settings = test_settings("operator");
  settings.is_operator = true;
  DdsBus bus(settings);
  const auto state = bus.advertise(topics::kFeedback, 4);
  REQUIRE(run_until([&] { return find(listener.endpoints(), "feedback/4", true) != nullptr; }, listener));
  CHECK(find(listener.endpoints(), "feedback/4", true)->host == host_name());
}

TEST_CASE("a listener receives the raw bytes of a topic of unknown type") {
  DdsBus bus(test_settings("vision"));
  auto writer = bus.advertise(topics::kWorld);
  msg::WorldState world;
  world.header().sender(static_cast<std::uint32_t>(Sender::kVision));
  world.robots().resize(1000);
  DdsListener listener(test_settings("listener"));
  const auto is_announced = [&] { return find(listener.endpoints(), "world", true) != nullptr; };
  REQUIRE(run_until(is_announced, listener));
  std::size_t size = 0;
  Time received{};
  listener.listen(*find(listener.endpoints(), "world", true), [&](const RawSample& sample) {
    size = sample.bytes.size();
    received = sample.received;
  });
  const Time begin = bus.now();
  const auto has_arrived = [&] {
    writer.publish(world, bus.now());
    return size > 0;
  };
  REQUIRE(run_until(has_arrived, listener));
  CHECK(size == 4 + fast_dds::cdr_size(world));
  CHECK(received >= begin);
  CHECK(received <= bus.now());
}

TEST_CASE("a writer that offers a stronger QoS than the reader requests causes no mismatch") {
  DiscoveredEndpoint writer = endpoint(true);
  DiscoveredEndpoint reader = endpoint(false);
  CHECK(qos_mismatches(writer, reader).empty());
  writer.is_reliable = true;
  writer.durability = DiscoveredEndpoint::Durability::kTransientLocal;
  writer.deadline = Duration{1};
  writer.liveliness = DiscoveredEndpoint::Liveliness::kByTopic;
  writer.lease = Duration{1};
  CHECK(qos_mismatches(writer, reader).empty());
}

TEST_CASE("each QoS policy that prevents a match is named in plain words") {
  const DiscoveredEndpoint writer = endpoint(true);
  const auto words_for = [&](auto change) {
    DiscoveredEndpoint reader = endpoint(false);
    change(reader);
    const std::vector<std::string> words = qos_mismatches(writer, reader);
    return words.size() == 1 ? words[0] : std::to_string(words.size()) + " mismatches";
  };
  CHECK(words_for([](DiscoveredEndpoint& r) { r.is_reliable = true; }) ==
        "reliability: the reader requests reliable, the writer offers best effort");
  CHECK(words_for([](DiscoveredEndpoint& r) { r.type = "Other"; }) ==
        "type: the reader requests Other, the writer offers Type");
  CHECK(words_for([](DiscoveredEndpoint& r) { r.is_keyed = true; }) ==
        "key: the reader requests a key, the writer offers none");
  CHECK(words_for([](DiscoveredEndpoint& r) {
          r.durability = DiscoveredEndpoint::Durability::kPersistent;
        }) == "durability: the reader requests persistent, the writer offers volatile");
  CHECK(words_for([](DiscoveredEndpoint& r) { r.deadline = Duration{500'000'000}; }) ==
        "deadline: the reader requests 0.5 s, the writer offers no limit");
  CHECK(words_for([](DiscoveredEndpoint& r) { r.lease = Duration{2'000'000'000}; }) ==
        "liveliness lease: the reader requests 2 s, the writer offers no limit");
  CHECK(words_for([](DiscoveredEndpoint& r) { r.liveliness = DiscoveredEndpoint::Liveliness::kByTopic; }) ==
        "liveliness: the reader requests manual by topic, the writer offers automatic");
  CHECK(words_for([](DiscoveredEndpoint& r) { r.is_exclusive = true; }) ==
        "ownership: the reader requests exclusive, the writer offers shared");
  CHECK(words_for([](DiscoveredEndpoint& r) { r.partitions = {"blue"}; }) == "partition: no name in common");
  CHECK(words_for([](DiscoveredEndpoint& r) { r.partitions = {"*"}; }) == "0 mismatches");
}

}  // namespace sidestep::listener_test
