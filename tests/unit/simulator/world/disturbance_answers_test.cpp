// SPDX-License-Identifier: Apache-2.0
// What the simulator answers to disturbances.
#include <limits>
#include <memory>
#include <vector>

#include "common/config/scenario_loader.hpp"
#include "common/messaging/operator_header.hpp"
#include "common/messaging/sim/bus.hpp"
#include "simulator/world/simulator_node.hpp"
#include "tests/catch.hpp"
#include "tests/drops.hpp"

namespace sidestep::disturbance_answers_test {

using namespace std::chrono_literals;
using Kind = msg::DisturbanceKind;
using Result = msg::DisturbanceResult;

const Time kBegin = time_from_ns(1'700'000'000'000'000'000);

/// A simulator with robots 3 and 4, and an operator who disturbs them.
struct Floor {
  Scenario scenario =
      parse_scenario("robots:\n  - {id: 3, start_m: [-2, 0]}\n  - {id: 4, start_m: [2, 1]}\n", "two.yaml");
  SimNetwork network{1, kBegin, scenario.network};
  SimBus bus{network};
  SimulatorNode simulator{bus, scenario, 77, 1};
  SimBus outside{network};
  std::unique_ptr<RawWriter> writer{outside.relay(topics::kDisturbance, topics::kDisturbance.name)};
  std::vector<msg::DisturbanceAnswer> answers;
  std::uint64_t sent = 0;

  Floor() {
    outside.subscribe(topics::kDisturbanceAnswer,
                      [this](const msg::DisturbanceAnswer& answer) { answers.push_back(answer); });
    run_for(100ms);
  }
  void run_for(Duration duration) { network.run_until(network.now() + duration); }

  void write(const msg::Disturbance& disturbance) {
    writer->write(&disturbance);
    run_for(20ms);
  }
  /// The simulator's only answer to this disturbance.
  Result answer_to(msg::Disturbance disturbance) {
    disturbance.header(operator_header(kBegin, ++sent, network.now()));
    answers.clear();
    write(disturbance);
    REQUIRE(answers.size() == 1);
    CHECK(answers[0].simulator() == static_cast<std::uint32_t>(Sender::kSimulator));
    CHECK(answers[0].header().sender() == static_cast<std::uint32_t>(Sender::kSimulator));
    CHECK(answers[0].robot() == disturbance.robot());
    CHECK(answers[0].disturbance_incarnation() == disturbance.header().incarnation());
    CHECK(answers[0].disturbance_number() == disturbance.header().message_number());
    return answers[0].result();
  }
  static msg::Disturbance disturbance(RobotId robot, Kind kind) {
    msg::Disturbance result;
    result.robot(robot);
    result.disturbance_kind(kind);
    result.duration_ns(1'000'000);
    return result;
  }
  Result answer_to(RobotId robot, Kind kind) { return answer_to(disturbance(robot, kind)); }
};

TEST_CASE("the simulator's answer says which disturbance a robot's state does not allow") {
  Floor floor;
  CHECK(floor.answer_to(3, Kind::DISTURBANCE_PLACE) == Result::FAULT_ON_FLOOR);
  CHECK(floor.answer_to(3, Kind::DISTURBANCE_SWITCH_ON) == Result::FAULT_SWITCHED_ON);
  CHECK(floor.answer_to(3, Kind::DISTURBANCE_LIFT) == Result::FAULT_APPLIED);
  CHECK(floor.answer_to(3, Kind::DISTURBANCE_LIFT) == Result::FAULT_APPLIED);
  CHECK(floor.answer_to(3, Kind::DISTURBANCE_PUSH) == Result::FAULT_OFF_FLOOR);
  CHECK(floor.answer_to(3, Kind::DISTURBANCE_CARRY) == Result::FAULT_OFF_FLOOR);
  CHECK(floor.answer_to(3, Kind::DISTURBANCE_FORGET_POSE) == Result::FAULT_OFF_FLOOR);
  CHECK(floor.answer_to(3, Kind::DISTURBANCE_PLACE) == Result::FAULT_APPLIED);
  CHECK(floor.answer_to(4, Kind::DISTURBANCE_SWITCH_OFF) == Result::FAULT_APPLIED);
  CHECK(floor.answer_to(4, Kind::DISTURBANCE_SWITCH_OFF) == Result::FAULT_SWITCHED_OFF);
  CHECK(floor.answer_to(4, Kind::DISTURBANCE_REBOOT) == Result::FAULT_SWITCHED_OFF);
  CHECK(floor.answer_to(4, Kind::DISTURBANCE_FORGET_POSE) == Result::FAULT_SWITCHED_OFF);
  CHECK(floor.answer_to(4, Kind::DISTURBANCE_SWITCH_ON) == Result::FAULT_APPLIED);
  CHECK(floor.answer_to(4, Kind::DISTURBANCE_SLIP) == Result::FAULT_APPLIED);
  CHECK(floor.answer_to(4, Kind::DISTURBANCE_BLOCK) == Result::FAULT_APPLIED);
  CHECK(floor.answer_to(4, Kind::DISTURBANCE_CLOCK) == Result::FAULT_APPLIED);
  CHECK(drops_of(floor.simulator).total(DropReason::kRefusedDisturbance) == 8);
}

TEST_CASE("the simulator's answer says that a disturbance is invalid or its robot unknown") {
  Floor floor;
  CHECK(floor.answer_to(5, Kind::DISTURBANCE_LIFT) == Result::FAULT_UNKNOWN_ROBOT);
  CHECK(floor.answer_to(msg::ALL_ROBOTS, Kind::DISTURBANCE_LIFT) == Result::FAULT_UNKNOWN_ROBOT);
  CHECK(floor.answer_to(3, static_cast<Kind>(99)) == Result::FAULT_INVALID);
  msg::Disturbance disturbance = Floor::disturbance(3, Kind::DISTURBANCE_PUSH);
  for (const double vx_mps : {1.01 * kMaxPush_mps, std::numeric_limits<double>::quiet_NaN()}) {
    disturbance.vx_mps(vx_mps);
    CHECK(floor.answer_to(disturbance) == Result::FAULT_INVALID);
  }
  disturbance.disturbance_kind(Kind::DISTURBANCE_CARRY);
  disturbance.x_m(100);
  CHECK(floor.answer_to(disturbance) == Result::FAULT_INVALID);
  CHECK(drops_of(floor.simulator).total(DropReason::kRefusedDisturbance) == 6);
}

TEST_CASE("cameras confuse two known robots, each with one other at a time") {
  Floor floor;
  msg::Disturbance confusion = Floor::disturbance(3, Kind::DISTURBANCE_SEEN_AS);
  confusion.duration_ns(1'000'000'000);
  for (const RobotId other : {RobotId{3}, RobotId{9}}) {
    confusion.other_robot(other);
    CHECK(floor.answer_to(confusion) == Result::FAULT_NOT_CONFUSABLE);
  }
  confusion.other_robot(4);
  CHECK(floor.answer_to(confusion) == Result::FAULT_APPLIED);
  CHECK(floor.answer_to(confusion) == Result::FAULT_NOT_CONFUSABLE);
}

TEST_CASE("a repeated disturbance is answered again but applied once") {
  Floor floor;
  msg::Disturbance off = Floor::disturbance(3, Kind::DISTURBANCE_SWITCH_OFF);
  CHECK(floor.answer_to(off) == Result::FAULT_APPLIED);
  off.header(operator_header(kBegin, floor.sent, floor.network.now() - 20ms));
  // If it were applied a second time, the robot would already be switched off.
  for (int i = 0; i < 3; ++i) {
    floor.answers.clear();
    floor.write(off);
    REQUIRE(floor.answers.size() == 1);
    CHECK(floor.answers[0].result() == Result::FAULT_APPLIED);
  }
  CHECK(drops_of(floor.simulator).total(DropReason::kRefusedDisturbance) == 0);
  // Another operator may have used the same number.
  off.header(operator_header(kBegin + 1s, floor.sent, floor.network.now()));
  floor.answers.clear();
  floor.write(off);
  REQUIRE(floor.answers.size() == 1);
  CHECK(floor.answers[0].result() == Result::FAULT_SWITCHED_OFF);
}

TEST_CASE("the simulator forgets the oldest answers and applies a disturbance that it has forgotten again") {
  Floor floor;
  msg::Disturbance on = Floor::disturbance(3, Kind::DISTURBANCE_SWITCH_ON);
  on.header(operator_header(kBegin, 1000, kBegin));
  floor.write(on);
  for (std::size_t i = 0; i + 1 < DisturbanceAnswers::kMaxRemembered; ++i)
    (void)floor.answer_to(4, Kind::DISTURBANCE_LIFT);
  CHECK(floor.answer_to(3, Kind::DISTURBANCE_SWITCH_OFF) == Result::FAULT_APPLIED);
  floor.answers.clear();
  floor.write(on);
  REQUIRE(floor.answers.size() == 1);
  CHECK(floor.answers[0].result() == Result::FAULT_APPLIED);
}

}  // namespace sidestep::disturbance_answers_test
