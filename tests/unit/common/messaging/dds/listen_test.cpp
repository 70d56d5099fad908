// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/listen.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/unit/common/messaging/dds/dds_test_support.hpp"

namespace sidestep {
namespace {

DdsEndpoint endpoint(bool is_writer) {
  DdsEndpoint result;
  result.topic = "topic";
  result.type = "Type";
  result.is_writer = is_writer;
  return result;
}

const DdsEndpoint* find(const std::vector<DdsEndpoint>& endpoints, const std::string& topic, bool is_writer) {
  const auto found = std::find_if(endpoints.begin(), endpoints.end(), [&](const DdsEndpoint& e) {
    return e.topic == topic && e.is_writer == is_writer;
  });
  return found == endpoints.end() ? nullptr : &*found;
}

}  // namespace

TEST_CASE("a listener sees who writes and reads what, and when they leave") {
  constexpr Topic<msg::Verdict> kEvent{
      {"test/event", "test", Qos::kEvent, false, message_type<msg::Verdict>("sidestep::msg::Verdict")}};
  DdsListener listener(test_settings("listener"));
  {
    DdsBus bus(test_settings("somebody"));
    const auto state = bus.advertise(topics::kFeedback, 3);
    bus.subscribe<msg::Verdict>(kEvent, [](const msg::Verdict&) {});
    REQUIRE(run_until([&] { return listener.endpoints().size() == 2; }, listener));
    const std::vector<DdsEndpoint> endpoints = listener.endpoints();
    const DdsEndpoint* writer = find(endpoints, "feedback/3", true);
    const DdsEndpoint* reader = find(endpoints, "test/event", false);
    REQUIRE(writer != nullptr);
    REQUIRE(reader != nullptr);
    CHECK(writer->participant == "somebody");
    CHECK(writer->type == "sidestep::msg::Feedback");
    CHECK(writer->is_keyed);
    CHECK_FALSE(writer->is_reliable);
    CHECK(reader->is_reliable);
    CHECK(reader->type == "sidestep::msg::Verdict");
  }
  CHECK(run_until([&] { return listener.endpoints().empty(); }, listener));
}

TEST_CASE("a listener gets the bytes of a topic whose type it does not know") {
  DdsBus bus(test_settings("vision"));
  auto writer = bus.advertise(topics::kWorld);
  msg::WorldState world;
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
  const auto has_come = [&] {
    writer.publish(world, bus.now());
    return size > 0;
  };
  REQUIRE(run_until(has_come, listener));
  CHECK(size == 4 + msg::WorldState::getCdrSerializedSize(world));
  CHECK(received >= begin);
  CHECK(received <= bus.now());
}

TEST_CASE("endpoints that fit have no mismatch, whatever the reader could do without") {
  DdsEndpoint writer = endpoint(true);
  DdsEndpoint reader = endpoint(false);
  CHECK(dds_mismatches(writer, reader).empty());
  writer.is_reliable = true;
  writer.durability = DdsEndpoint::Durability::kTransientLocal;
  writer.deadline = Duration{1};
  writer.liveliness = DdsEndpoint::Liveliness::kByTopic;
  writer.lease = Duration{1};
  CHECK(dds_mismatches(writer, reader).empty());
}

TEST_CASE("each policy that keeps a writer and a reader apart is named in plain words") {
  const DdsEndpoint writer = endpoint(true);
  const auto words_for = [&](auto change) {
    DdsEndpoint reader = endpoint(false);
    change(reader);
    const std::vector<std::string> words = dds_mismatches(writer, reader);
    return words.size() == 1 ? words[0] : std::to_string(words.size()) + " mismatches";
  };
  CHECK(words_for([](DdsEndpoint& r) { r.is_reliable = true; }) ==
        "reliability: the reader wants reliable, the writer offers best effort");
  CHECK(words_for([](DdsEndpoint& r) { r.type = "Other"; }) ==
        "type: the reader wants Other, the writer offers Type");
  CHECK(words_for([](DdsEndpoint& r) { r.is_keyed = true; }) ==
        "key: the reader wants a key, the writer offers none");
  CHECK(words_for([](DdsEndpoint& r) { r.durability = DdsEndpoint::Durability::kPersistent; }) ==
        "durability: the reader wants persistent, the writer offers volatile");
  CHECK(words_for([](DdsEndpoint& r) { r.deadline = Duration{500'000'000}; }) ==
        "deadline: the reader wants 0.5 s, the writer offers no limit");
  CHECK(words_for([](DdsEndpoint& r) { r.lease = Duration{2'000'000'000}; }) ==
        "liveliness lease: the reader wants 2 s, the writer offers no limit");
  CHECK(words_for([](DdsEndpoint& r) { r.liveliness = DdsEndpoint::Liveliness::kByTopic; }) ==
        "liveliness: the reader wants manual by topic, the writer offers automatic");
  CHECK(words_for([](DdsEndpoint& r) { r.is_exclusive = true; }) ==
        "ownership: the reader wants exclusive, the writer offers shared");
  CHECK(words_for([](DdsEndpoint& r) { r.partitions = {"blue"}; }) == "partition: no name in common");
  CHECK(words_for([](DdsEndpoint& r) { r.partitions = {"*"}; }) == "0 mismatches");
}

}  // namespace sidestep
