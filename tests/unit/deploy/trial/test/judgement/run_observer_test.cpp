// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/judgement/run_observer.hpp"

#include "common/messaging/sim/bus.hpp"
#include "tests/catch.hpp"

namespace sidestep::run_observer_test {

using namespace std::chrono_literals;

/// An observer, and a process that sends messages to it.
struct Fixture {
  Fixture() { observer_bus.become_observer(); }

  void send_state(std::uint32_t number, std::uint64_t epoch, msg::CoordinatorMode mode,
                  const std::vector<msg::RobotNotice>& notices = {}) {
    msg::CoordinatorState state;
    state.header().sender(static_cast<std::uint32_t>(Sender::kCoordinator) + number);
    state.coordinator(number);
    state.epoch(epoch);
    state.coordinator_mode(mode);
    for (const msg::RobotNotice& notice : notices) state.notices().push_back(notice);
    states.publish(state, network.now());
    network.run_until(network.now() + 10ms);
  }
  void send_truth(std::uint64_t contacts) {
    msg::GroundTruth truth;
    truth.header().sender(static_cast<std::uint32_t>(Sender::kSimulator));
    truth.contacts(contacts);
    for (std::uint32_t k = 0; k < msg::MAX_CONTACTS; ++k) {
      truth.recent_contacts()[k].first(k);
      truth.recent_contacts()[k].second(k == 1 ? msg::NO_ROBOT : 100 + k);
    }
    for (const std::uint32_t id : {7u, 3u}) {
      msg::TrueRobotState robot;
      robot.robot(id);
      robot.vx_mps(0.3 * id);
      robot.vy_mps(0.4 * id);
      truth.robots().push_back(robot);
    }
    truths.publish(truth, network.now());
    network.run_until(network.now() + 10ms);
  }
  const RunHistory& history() const { return observer.history(); }

  SimNetwork network{1, time_from_ns(1'000'000'000'000), NetworkSpec{}};
  SimBus observer_bus{network}, sender{network};
  RunObserver observer{observer_bus};
  Writer<msg::CoordinatorState> states = sender.advertise(topics::kCoordinator);
  Writer<msg::GroundTruth> truths = sender.advertise(topics::kTruth);
  Writer<msg::AgentStatus> statuses = sender.advertise(topics::kStatus);
};

constexpr auto kGranting = msg::CoordinatorMode::COORDINATOR_GRANTING;
constexpr auto kRegistering = msg::CoordinatorMode::COORDINATOR_REGISTERING;
constexpr auto kStandby = msg::CoordinatorMode::COORDINATOR_STANDBY;

TEST_CASE("times are measured from the first heartbeat of a coordinator that grants") {
  Fixture run;
  run.send_state(1, 0, kStandby);
  run.send_state(0, 40, kRegistering);
  run.send_truth(0);
  CHECK_FALSE(run.observer.begin());
  CHECK(run.history().truths.empty());
  const Time zero = run.network.now();
  run.send_state(0, 40, kGranting);
  CHECK(run.observer.begin() == zero);
  run.send_truth(0);
  REQUIRE(run.history().truths.size() == 1);
  CHECK(run.history().truths[0].at_s == Approx(0.01));
  CHECK(run.history().truths[0].speed_of(3) == Approx(1.5));
  CHECK(run.history().truths[0].speed_of(7) == Approx(3.5));
  CHECK_FALSE(run.history().truths[0].speed_of(5));
  CHECK(run.history().granting_coordinator() == 0);
}

TEST_CASE("states of superseded coordinators and of standbys are ignored") {
  Fixture run;
  run.send_state(0, 40, kGranting);
  run.send_state(1, 49, kGranting);
  run.send_state(0, 40, kGranting);
  run.send_state(0, 0, kStandby);
  REQUIRE(run.history().coordinators.size() == 2);
  CHECK(run.history().coordinators[1].number == 1);
  CHECK(run.history().coordinators[1].epoch == 49);
  CHECK(run.history().granting_coordinator() == 1);
}

TEST_CASE("contacts are recorded once with their robots, and contacts beyond a message's list are counted") {
  Fixture run;
  run.send_truth(1);  // before the first grant
  run.send_state(0, 40, kGranting);
  run.send_truth(2);
  run.send_truth(2);
  REQUIRE(run.history().contacts.size() == 2);
  CHECK(run.history().contacts[0].first == 0);
  CHECK(run.history().contacts[0].second == RobotId{100});
  CHECK(run.history().contacts[1].first == 1);
  CHECK_FALSE(run.history().contacts[1].second);
  run.send_truth(2 + msg::MAX_CONTACTS + 5);
  CHECK(run.history().contacts.size() == 2u + msg::MAX_CONTACTS);
  CHECK(run.history().unidentified_contacts == 5);
}

TEST_CASE("notices of coordinators and agents are recorded, and the last heartbeat lists missing robots") {
  Fixture run;
  msg::RobotNotice notice;
  notice.robot(4);
  notice.is_missing(true);
  notice.is_displaced(true);
  run.send_state(0, 40, kGranting, {notice});
  REQUIRE(run.history().notices.size() == 2);
  CHECK(run.history().notices[0].kind == NoticeKind::kMissing);
  CHECK(run.history().notices[1].kind == NoticeKind::kDisplaced);
  CHECK(run.history().is_missing(4));
  CHECK_FALSE(run.history().is_missing(5));
  run.send_state(0, 40, kGranting);
  CHECK_FALSE(run.history().is_missing(4));
  msg::AgentStatus status;
  status.header().sender(2);
  status.robot(2);
  status.agent_state(msg::AgentState::AGENT_CLOCK_OUT_OF_BOUND);
  run.statuses.publish(status, run.network.now());
  run.network.run_until(run.network.now() + 10ms);
  REQUIRE(run.history().notices.size() == 3);
  CHECK(run.history().notices[2].robot == 2);
  CHECK(run.history().notices[2].kind == NoticeKind::kClockOutOfBound);
}

}  // namespace sidestep::run_observer_test
