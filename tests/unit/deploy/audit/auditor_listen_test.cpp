// SPDX-License-Identifier: Apache-2.0
// An auditor on a bus hears every message that it audits.
#include <map>

#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/stage.hpp"

namespace sidestep::auditor_listen_test {

using namespace std::chrono_literals;

/// A bus that immediately delivers the messages that a test passes to it.
class ManualBus : public Bus {
 public:
  Time now() const override { return now_; }
  void at(Time when, std::function<void()> callback) override { timers_.emplace(when, std::move(callback)); }
  void advance(Duration duration) {
    const Time end = now_ + duration;
    while (!timers_.empty() && timers_.begin()->first <= end) {
      now_ = timers_.begin()->first;
      const auto callback = timers_.extract(timers_.begin()).mapped();
      callback();
    }
    now_ = end;
  }
  template <typename Message>
  void deliver(const Topic<Message>& topic, const Message& message, RobotId robot = 0) {
    for (const auto& reader : readers_[channel_name(topic, robot)]) reader(&message);
  }

 protected:
  std::unique_ptr<RawWriter> make_writer(const TopicInfo&, const std::string&) override { return nullptr; }
  void make_reader(const TopicInfo&, const std::string& channel,
                   std::function<void(const void*)> callback) override {
    readers_[channel].push_back(std::move(callback));
  }

 private:
  Time now_{1000s};
  std::multimap<Time, std::function<void()>> timers_;
  std::map<std::string, std::vector<std::function<void(const void*)>>> readers_;
};

template <typename Message>
Message from(Sender sender) {
  Message message;
  message.header().sender(static_cast<std::uint32_t>(sender));
  return message;
}

struct AuditorOnBus {
  AuditorOnBus() { listen(bus, scenario, auditor); }
  std::uint64_t invalid() const { return auditor.totals().invalid; }

  Scenario scenario = stage_scenario();
  Auditor auditor{scenario, kComplete};
  ManualBus bus;
};

TEST_CASE("an auditor on a bus hears every topic from every robot on the roster") {
  // Each of these messages is invalid.
  AuditorOnBus run;
  run.bus.deliver(topics::kProposal, msg::Proposal());
  CHECK(run.invalid() == 1);
  run.bus.deliver(topics::kRegistration, msg::Registration());
  CHECK(run.invalid() == 2);
  run.bus.deliver(topics::kLedger, from<msg::LedgerPage>(Sender::kCoordinator));
  CHECK(run.invalid() == 3);
  auto world = from<msg::WorldState>(Sender::kVision);
  world.valid_at_ns(-1);
  run.bus.deliver(topics::kWorld, world);
  CHECK(run.invalid() == 4);
  auto truth = from<msg::GroundTruth>(Sender::kSimulator);
  truth.valid_at_ns(-1);
  run.bus.deliver(topics::kTruth, truth);
  CHECK(run.invalid() == 5);
  auto disturbance = from<msg::Disturbance>(Sender::kOperator);
  disturbance.robot(9);
  run.bus.deliver(topics::kDisturbance, disturbance);
  CHECK(run.invalid() == 6);
  auto attestation = from<msg::AbsenceAttestation>(Sender::kOperator);
  attestation.robot(9);
  run.bus.deliver(topics::kAttestation, attestation);
  CHECK(run.invalid() == 7);
  for (const RobotId robot : {0u, 1u}) {
    auto verdict = from<msg::Verdict>(Sender::kCoordinator);
    verdict.robot(9);
    run.bus.deliver(topics::kVerdict, verdict, robot);
    CHECK(run.invalid() == 8 + 3 * robot);
    msg::Command command;
    command.robot(9);
    run.bus.deliver(topics::kCommand, command, robot);
    CHECK(run.invalid() == 9 + 3 * robot);
    msg::Feedback robot_report;
    robot_report.robot(9);
    run.bus.deliver(topics::kFeedback, robot_report, robot);
    CHECK(run.invalid() == 10 + 3 * robot);
  }
  const std::uint64_t received = run.auditor.totals().received;
  run.bus.deliver(topics::kCoordinator, from<msg::CoordinatorState>(Sender::kCoordinator));
  CHECK(run.auditor.totals().received == received + 1);
}

/// Orders that robot 1's agent announces to the second coordinator.
struct CoordinatorSuccession : AuditorOnBus {
  template <typename Message>
  Message from(std::uint32_t sender) {
    bus.advance(1ms);
    Message message;
    message.header().sender(sender);
    message.header().incarnation(1);
    message.header().message_number(++number);
    message.header().stamp_ns(to_ns(bus.now()));
    return message;
  }
  void confirm() {
    auto hold = from<msg::Order>(1'000'001);
    hold.robot(1);
    hold.terms().order_kind(msg::OrderKind::ORDER_HOLD);
    hold.terms().order_number(100);
    bus.deliver(topics::kOrder, hold);
    auto answer = from<msg::OrderAnswer>(10'000);
    answer.client(1'000'001);
    answer.order_number(100);
    answer.result(msg::OrderResult::RESULT_REMEMBERED);
    bus.deliver(topics::kOrderAnswer, answer);
  }
  void report(bool is_held) {
    auto status = from<msg::OrderStatus>(1);
    status.robot(1);
    status.is_held(is_held);
    bus.deliver(topics::kOrderStatus, status);
  }
  void tell() {
    auto memory = from<msg::OrderMemory>(1);
    memory.process(1);
    memory.order_count(1);
    memory.orders()[0].robot(1);
    memory.orders()[0].client(1'000'001);
    memory.orders()[0].terms().order_kind(msg::OrderKind::ORDER_HOLD);
    memory.orders()[0].terms().order_number(100);
    bus.deliver(topics::kAgentOrders, memory);
  }
  void succeed() {
    auto registration = from<msg::Registration>(1);
    registration.robot(1);
    registration.epoch(7);
    registration.is_absent(true);
    bus.deliver(topics::kRegistration, registration);
    auto proposal = from<msg::Proposal>(0);
    proposal.epoch(7);
    proposal.candidate_count(1);
    proposal.candidates()[0].version_number(3);
    proposal.candidates()[0].base(2);
    bus.deliver(topics::kProposal, proposal);
    auto verdict = from<msg::Verdict>(10'001);
    verdict.epoch(7);
    verdict.proposal_number(3);
    verdict.granted_version(3);
    bus.deliver(topics::kVerdict, verdict, 0);
  }
  std::uint64_t forgotten() {
    auto memory = from<msg::OrderMemory>(10'001);
    memory.process(10'001);
    memory.page_count(1);
    memory.is_complete(true);
    bus.deliver(topics::kOrderMemory, memory);
    return auditor.totals().by_rule[static_cast<std::size_t>(AuditRule::kForgottenOrder)];
  }

  std::uint64_t number = 0;
};

TEST_CASE("an auditor on a bus hears orders and which processes remember them") {
  CoordinatorSuccession run;
  std::uint64_t expected = 1;
  SECTION("an agent reports being held") {
    run.report(false);
    run.confirm();
    run.report(true);
  }
  SECTION("an agent announces the order") {
    run.confirm();
    run.tell();
  }
  SECTION("no agent remembers the order") {
    run.confirm();
    expected = 0;
  }
  run.succeed();
  CHECK(run.forgotten() == expected);
}

TEST_CASE("an auditor on a bus advances its time even without messages") {
  AuditorOnBus run;
  for (const RobotId robot : {0u, 1u}) {
    msg::Feedback robot_report;
    robot_report.robot(robot);
    robot_report.header().sender(robot);
    robot_report.header().message_number(1);
    robot_report.valid_at_ns(to_ns(run.bus.now()));
    robot_report.executing().robot(robot);
    run.bus.deliver(topics::kFeedback, robot_report, robot);
  }
  auto state = from<msg::CoordinatorState>(Sender::kCoordinator);
  state.coordinator_mode(msg::CoordinatorMode::COORDINATOR_GRANTING);
  run.bus.deliver(topics::kCoordinator, state);
  run.bus.advance(3s);
  CHECK(run.auditor.totals().run_s == Approx(3).margin(0.15));
}

}  // namespace sidestep::auditor_listen_test
