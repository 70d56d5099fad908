// SPDX-License-Identifier: Apache-2.0
// Messages of `topic pub` whose header the user leaves out are accepted by the processes that they are for.
#include "deploy/inspect/topic/omitted_header.hpp"

#include "common/config/scenario_loader.hpp"
#include "common/json/json_text.hpp"
#include "common/messaging/message_schema.hpp"
#include "common/messaging/operator_header.hpp"
#include "common/messaging/sim/bus.hpp"
#include "deploy/inspect/topic/idl/idl_encoder.hpp"
#include "deploy/inspect/topic/idl/idl_parser.hpp"
#include "simulator/world/simulator_node.hpp"
#include "tests/catch.hpp"
#include "tests/drops.hpp"

namespace sidestep::omitted_header_test {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;

const Time kBegin = time_from_ns(1'700'000'000'000'000'000);

IdlTypePtr type_of(const TopicInfo& topic) {
  static const IdlTypes types = parse_idl(kIdlText, "idl");
  return types.at(topic.type.name);
}

Json completed(const TopicInfo& topic, const std::string& message) {
  return with_header(*type_of(topic), parse_ordered_json(message), operator_header(kBegin, 4, kBegin + 1s));
}

/// Writes the bytes that `topic pub` sends for this message.
void publish(RawWriter& writer, const TopicInfo& topic, const std::string& message) {
  const std::vector<std::uint8_t> bytes = encode_by_idl(*type_of(topic), completed(topic, message));
  constexpr std::size_t kEncapsulation = 4;
  REQUIRE(read_cdr(topic, std::span(bytes).subspan(kEncapsulation),
                   [&](const void* decoded) { writer.write(decoded); }));
}

TEST_CASE("a published message without a header is accepted on all topics that an operator may write") {
  int tried = 0;
  for_each_topic([&]<typename Message>(const Topic<Message>& topic) {
    if (!topic.writers.has(Role::kOperator)) return;
    CAPTURE(topic.name);
    ++tried;
    SimNetwork network(1, kBegin, {});
    SimBus sender(network), receiver(network);
    std::vector<msg::Header> accepted;
    receiver.subscribe<Message>(topic, 0,
                                [&](const Message& message) { accepted.push_back(message.header()); });
    const auto writer = sender.relay(topic, channel_name(topic, 0));
    publish(*writer, topic, "{}");
    network.run_until(kBegin + 1s);
    CHECK(drops_of(receiver).total(DropReason::kForgedSender) == 0);
    REQUIRE(accepted.size() == 1);
    CHECK(accepted[0] == operator_header(kBegin, 4, kBegin + 1s));
    CHECK(sender_problem(*type_of(topic), Json::object(), channel_name(topic, 0)).empty());
  });
  CHECK(tried >= 5);
}

TEST_CASE("the disturbance that inspect's README publishes lifts the robot") {
  const Scenario scenario = parse_scenario("robots:\n  - {id: 3, start_m: [-2, 0]}\n", "one.yaml");
  SimNetwork network(1, kBegin, scenario.network);
  SimBus bus(network), outside(network);
  SimulatorNode simulator(bus, scenario, 77, 1);
  // The simulator must find the writer before it can receive anything.
  const auto writer = outside.relay(topics::kDisturbance, topics::kDisturbance.name);
  bool is_lifted = false;
  outside.subscribe<msg::Feedback>(topics::kFeedback, 3,
                                   [&](const msg::Feedback& feedback) { is_lifted = feedback.is_lifted(); });
  network.run_until(kBegin + 100ms);
  CHECK_FALSE(is_lifted);
  publish(*writer, topics::kDisturbance, R"({"robot": 3, "disturbance_kind": "DISTURBANCE_LIFT"})");
  network.run_until(kBegin + 1s);
  CHECK(is_lifted);
  CHECK(drops_of(bus).total(DropReason::kForgedSender) == 0);
}

TEST_CASE("what the user gives of a header is kept, and other programs' messages are unchanged") {
  const Json header = completed(topics::kOrder, R"({"header": {"sender": 0, "stamp_ns": 12}})")["header"];
  CHECK(header["sender"] == 0);
  CHECK(header["stamp_ns"] == 12);
  CHECK(header["incarnation"] == to_ns(kBegin));
  CHECK(header["message_number"] == 4);
  CHECK_FALSE(header.contains("rules"));
  CHECK(completed(topics::kOrder, R"({"header": 3})") == parse_ordered_json(R"({"header": 3})"));
  CHECK(completed(topics::kOrder, "[]") == Json::array());
  const IdlTypes others =
      parse_idl("struct Header { long sender; }; struct Battery { Header header; long id; };", "battery.idl");
  CHECK(with_header(*others.at("Battery"), Json::object(), operator_header(kBegin, 1, kBegin)) ==
        Json::object());
  CHECK(sender_problem(*others.at("Battery"), Json::object(), "world").empty());
}

TEST_CASE("a message in whose sender's name an operator may not speak needs an explicit sender") {
  const auto problem = [](const TopicInfo& topic, const char* message, const char* channel) {
    return sender_problem(*type_of(topic), parse_ordered_json(message), channel);
  };
  CHECK_THAT(problem(topics::kVerdict, "{}", "verdict/3"),
             ContainsSubstring("header.sender: is missing") && ContainsSubstring("'verdict/3'"));
  CHECK_FALSE(problem(topics::kWorld, R"({"header": {"stamp_ns": 1}})", "world").empty());
  CHECK(problem(topics::kWorld, R"({"header": {"sender": 20000}})", "world").empty());
  CHECK(problem(topics::kWorld, "{}", "their_world").empty());
}

}  // namespace sidestep::omitted_header_test
