// SPDX-License-Identifier: Apache-2.0
#include "common/client/disturbance_client.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <vector>

#include "common/messaging/disturbance_answer.hpp"
#include "common/messaging/sim/bus.hpp"
#include "tests/catch.hpp"

namespace sidestep::disturbance_client_test {

using namespace std::chrono_literals;
using Result = msg::DisturbanceResult;

constexpr auto kSimulator = static_cast<std::uint32_t>(Sender::kSimulator);

/// An operator, and a process that answers like a simulator.
struct System {
  SimNetwork network{1, time_from_ns(1'000'000'000'000), NetworkSpec{}};
  SimBus operator_bus{network}, simulator_bus{network};
  std::unique_ptr<RawWriter> writer{operator_bus.relay(topics::kDisturbance, topics::kDisturbance.name)};
  DisturbanceClient client{operator_bus, *writer};
  Writer<msg::DisturbanceAnswer> answers = simulator_bus.advertise(topics::kDisturbanceAnswer);
  std::vector<msg::Disturbance> received;
  std::optional<Result> answers_with = Result::FAULT_APPLIED;
  std::vector<std::optional<Result>> results;  ///< results that the client has reported

  System() {
    simulator_bus.subscribe(topics::kDisturbance, [this](const msg::Disturbance& disturbance) {
      received.push_back(disturbance);
      if (answers_with) answer(disturbance, *answers_with);
    });
  }
  void answer(const msg::Disturbance& disturbance, Result result,
              const std::function<void(msg::DisturbanceAnswer&)>& change = {}) {
    msg::DisturbanceAnswer answer;
    answer.simulator(kSimulator);
    answer.header().sender(kSimulator);
    answer.robot(disturbance.robot());
    answer.disturbance_incarnation(disturbance.header().incarnation());
    answer.disturbance_number(disturbance.header().message_number());
    answer.result(result);
    if (change) change(answer);
    answers.publish(answer, simulator_bus.now());
  }
  void send(RobotId robot) {
    msg::Disturbance disturbance;
    disturbance.robot(robot);
    client.send(disturbance, [this](const std::optional<Result>& result) { results.push_back(result); });
  }
  void run_for(Duration duration) { network.run_until(network.now() + duration); }
};

TEST_CASE("the operator learns whether the simulator has applied a disturbance") {
  System system;
  system.send(3);
  CHECK(system.results.empty());
  system.run_for(100ms);
  CHECK(system.results == std::vector{std::optional(Result::FAULT_APPLIED)});
  system.answers_with = Result::FAULT_ON_FLOOR;
  system.send(3);
  system.run_for(100ms);
  CHECK(system.results.back() == Result::FAULT_ON_FLOOR);
  REQUIRE(system.received.size() == 2);
  const msg::Header &first = system.received[0].header(), &second = system.received[1].header();
  CHECK(first.sender() == static_cast<std::uint32_t>(Sender::kOperator));
  CHECK(first.incarnation() == second.incarnation());
  CHECK(second.message_number() == first.message_number() + 1);
  system.run_for(10s);
  CHECK(system.received.size() == 2);
  CHECK(system.results.size() == 2);
}

TEST_CASE("a disturbance is repeated unchanged until it is answered") {
  System system;
  system.answers_with.reset();
  system.send(3);
  system.run_for(1200ms);
  CHECK(system.results.empty());
  REQUIRE(system.received.size() == 3);
  CHECK(system.received[0] == system.received[2]);
  system.answer(system.received[0], Result::FAULT_APPLIED);
  system.run_for(5s);
  CHECK(system.received.size() == 3);
  CHECK(system.results == std::vector{std::optional(Result::FAULT_APPLIED)});
}

TEST_CASE("an operator without a simulator learns that nobody has answered") {
  System system;
  system.answers_with.reset();
  system.send(3);
  system.run_for(DisturbanceClient::kTimeout - 100ms);
  CHECK(system.results.empty());
  system.run_for(1s);
  CHECK(system.results == std::vector<std::optional<Result>>{std::nullopt});
  const std::size_t count = system.received.size();
  system.run_for(5s);
  CHECK(system.received.size() == count);
}

TEST_CASE("an operator that gives up learns of each open disturbance that nobody has answered") {
  System system;
  system.send(3);
  system.run_for(100ms);
  system.answers_with.reset();
  system.send(4);
  system.send(5);
  system.client.give_up();
  CHECK(system.results ==
        std::vector<std::optional<Result>>{Result::FAULT_APPLIED, std::nullopt, std::nullopt});
  system.run_for(1s);
  REQUIRE(system.received.size() == 3);  // none is repeated
  system.answer(system.received.back(), Result::FAULT_APPLIED);
  system.run_for(10s);
  CHECK(system.received.size() == 3);
  CHECK(system.results.size() == 3);
}

TEST_CASE("answers to others, and malformed ones, are ignored") {
  System system;
  system.answers_with.reset();
  system.send(3);
  system.send(4);
  system.run_for(100ms);
  REQUIRE(system.received.size() == 2);
  const msg::Disturbance& of_4 = system.received[1];
  const std::vector<std::function<void(msg::DisturbanceAnswer&)>> changes{
      [](auto& answer) { answer.robot(5); },
      [](auto& answer) { answer.disturbance_incarnation(answer.disturbance_incarnation() + 1); },
      [](auto& answer) { answer.disturbance_number(77); },
      [](auto& answer) { answer.result(static_cast<Result>(99)); },
      [](auto& answer) { answer.header().sender(3); }};
  for (const auto& change : changes) system.answer(of_4, Result::FAULT_APPLIED, change);
  system.run_for(100ms);
  CHECK(system.results.empty());
  system.answer(of_4, Result::FAULT_OFF_FLOOR);
  system.run_for(100ms);
  CHECK(system.results == std::vector{std::optional(Result::FAULT_OFF_FLOOR)});
}

TEST_CASE("a callback may send the next disturbance") {
  System system;
  int answered = 0;
  std::function<void(const std::optional<Result>&)> next = [&](const std::optional<Result>&) {
    if (++answered < 3) system.client.send(msg::Disturbance(), next);
  };
  system.client.send(msg::Disturbance(), next);
  system.run_for(1s);
  CHECK(answered == 3);
}

TEST_CASE("each reason for a refusal has its own text, which names the robot") {
  std::vector<std::string> texts;
  for (const Result result :
       {Result::FAULT_UNKNOWN_ROBOT, Result::FAULT_ON_FLOOR, Result::FAULT_OFF_FLOOR,
        Result::FAULT_SWITCHED_OFF, Result::FAULT_SWITCHED_ON, Result::FAULT_NOT_CONFUSABLE}) {
    const std::string text = refusal_text(5, result);
    CHECK_THAT(text, ContainsSubstring("robot 5"));
    CHECK(std::ranges::find(texts, text) == texts.end());
    texts.push_back(text);
  }
  CHECK_THAT(refusal_text(5, Result::FAULT_INVALID), ContainsSubstring("out of range"));
}

}  // namespace sidestep::disturbance_client_test
