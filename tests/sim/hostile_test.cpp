// SPDX-License-Identifier: Apache-2.0
#include <functional>
#include <limits>

#include "common/config/scenario_loader.hpp"
#include "common/messaging/process_names.hpp"
#include "deploy/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"

namespace sidestep::hostile_test {

using namespace std::chrono_literals;

constexpr RobotId kVictim = 3;
constexpr std::uint64_t kHuge = std::uint64_t{1} << 61;
constexpr auto kFirstCoordinator = static_cast<std::uint32_t>(Sender::kCoordinator);

Scenario crossing() {
  return load_scenario(std::string(SIDESTEP_SOURCE_DIR) + "/deploy/scenarios/crossing.yaml");
}

/// A process that knows the scenario's rules, repeats what it has received from others, and changes it.
class Forger {
 public:
  explicit Forger(SimSystem& system)
      : bus_(system.network()),
        rules_(bus_, static_cast<std::uint32_t>(Sender::kOperator), SharedRules(crossing()),
               [](const RulesMismatch&) {}),
        feedback_writer_(bus_.advertise(topics::kFeedback, kVictim)),
        command_writer_(bus_.advertise(topics::kCommand, kVictim)),
        registration_writer_(bus_.advertise(topics::kRegistration)),
        proposal_writer_(bus_.advertise(topics::kProposal)),
        state_writer_(bus_.advertise(topics::kCoordinator)),
        verdict_writer_(bus_.advertise(topics::kVerdict, kVictim)),
        page_writer_(bus_.advertise(topics::kLedger)),
        world_writer_(bus_.advertise(topics::kWorld)),
        obstacle_writer_(bus_.advertise(topics::kObstacles)) {
    keep(topics::kFeedback, feedback);
    keep(topics::kCommand, command);
    keep(topics::kRegistration, registration);
    keep(topics::kProposal, proposal);
    keep(topics::kCoordinator, state);
    keep(topics::kVerdict, verdict);
    keep(topics::kLedger, page);
    keep(topics::kWorld, world);
    keep(topics::kObstacles, obstacles);
  }
  /// Sends all messages that it has been given.
  void send() {
    publish(feedback_writer_, feedback);
    publish(command_writer_, command);
    publish(registration_writer_, registration);
    publish(proposal_writer_, proposal);
    publish(state_writer_, state);
    publish(verdict_writer_, verdict);
    publish(page_writer_, page);
    publish(world_writer_, world);
    publish(obstacle_writer_, obstacles);
  }
  void stop_listening() { is_listening_ = false; }

  template <typename Message>
  struct Forged {
    Message message;
    bool is_to_be_sent = false;

    Message& operator()() {
      is_to_be_sent = true;
      return message;
    }
  };
  Forged<msg::Feedback> feedback;
  Forged<msg::Command> command;
  Forged<msg::Registration> registration;
  Forged<msg::Proposal> proposal;
  Forged<msg::CoordinatorState> state;
  Forged<msg::Verdict> verdict;
  Forged<msg::LedgerPage> page;
  Forged<msg::WorldState> world;
  Forged<msg::ObstacleList> obstacles;

 private:
  template <typename Message>
  void keep(const Topic<Message>& topic, Forged<Message>& forged) {
    bus_.subscribe(topic, kVictim, [this, &forged](const Message& message) {
      if constexpr (requires { message.robot(); }) {
        if (message.robot() != kVictim) return;
      }
      if (is_listening_) forged.message = message;
    });
  }
  template <typename Message>
  void publish(Writer<Message>& writer, Forged<Message>& forged) {
    if (forged.is_to_be_sent) writer.publish(forged.message, bus_.now());
  }

  SimBus bus_;
  RulesExchange rules_;
  bool is_listening_ = true;
  Writer<msg::Feedback> feedback_writer_;
  Writer<msg::Command> command_writer_;
  Writer<msg::Registration> registration_writer_;
  Writer<msg::Proposal> proposal_writer_;
  Writer<msg::CoordinatorState> state_writer_;
  Writer<msg::Verdict> verdict_writer_;
  Writer<msg::LedgerPage> page_writer_;
  Writer<msg::WorldState> world_writer_;
  Writer<msg::ObstacleList> obstacle_writer_;
};

struct Forgery {
  std::string name;
  std::function<void(Forger&)> change;
};

const std::vector<Forgery> kForgeries{
    {"feedback: lifted at a time far ahead",
     [](Forger& f) {
       f.feedback().is_lifted(true);
       f.feedback().executing() = {};
       f.feedback().executing().robot(kVictim);
       f.feedback().valid_at_ns(static_cast<std::int64_t>(kHuge));
     }},
    {"feedback: epoch", [](Forger& f) { f.feedback().obeyed_epoch(kHuge); }},
    {"feedback: the highest epoch", [](Forger& f) { f.feedback().obeyed_epoch(std::uint64_t{1} << 62); }},
    {"feedback: obeyed incarnation", [](Forger& f) { f.feedback().obeyed_incarnation(kHuge); }},
    {"feedback: obeyed incarnation slightly ahead",
     [](Forger& f) { f.feedback().obeyed_incarnation(f.feedback().obeyed_incarnation() + 1); }},
    {"feedback: the robot's incarnation", [](Forger& f) { f.feedback().header().incarnation(kHuge); }},
    {"feedback: own stop with a huge number",
     [](Forger& f) {
       f.feedback().is_off_reference(true);
       f.feedback().executing().version_number(kHuge);
     }},
    {"feedback: version that starts far ahead",
     [](Forger& f) { f.feedback().executing().start_ns(static_cast<std::int64_t>(kHuge)); }},
    {"feedback: echo of a time far ahead",
     [](Forger& f) {
       f.feedback().command_stamp_ns(static_cast<std::int64_t>(kHuge));
       f.feedback().command_received_at_ns(static_cast<std::int64_t>(kHuge));
     }},
    {"command: epoch", [](Forger& f) { f.command().epoch(kHuge); }},
    {"command: incarnation", [](Forger& f) { f.command().header().incarnation(kHuge); }},
    {"registration: incarnation", [](Forger& f) { f.registration().header().incarnation(kHuge); }},
    {"registration: epoch", [](Forger& f) { f.registration().epoch(kHuge); }},
    {"proposal: epoch", [](Forger& f) { f.proposal().epoch(kHuge); }},
    {"proposal: version numbers",
     [](Forger& f) {
       for (auto& candidate : f.proposal().candidates()) candidate.version_number(kHuge);
     }},
    {"coordinator state: epoch",
     [](Forger& f) {
       f.state().epoch(kHuge);
       f.state().coordinator_mode(msg::CoordinatorMode::COORDINATOR_GRANTING);
     }},
    {"coordinator state: from an agent",
     [](Forger& f) {
       f.state().header().sender(kVictim);
       f.state().epoch(f.state().epoch() + 1);
     }},
    {"coordinator state: number out of range", [](Forger& f) { f.state().coordinator(1u << 31); }},
    {"verdict: from an agent", [](Forger& f) { f.verdict().header().sender(kVictim); }},
    {"ledger page: epoch", [](Forger& f) { f.page().epoch(kHuge); }},
    {"ledger page: from an agent",
     [](Forger& f) {
       f.page().header().sender(kVictim);
       f.page().header().message_number(kHuge);
     }},
    {"world: from an agent",
     [](Forger& f) {
       f.world().header().sender(kVictim);
       for (auto& robot : f.world().robots()) robot.observed_x_m(3);
     }},
    {"world: valid in half an hour",
     [](Forger& f) { f.world().valid_at_ns(f.world().valid_at_ns() + 1'800'000'000'000); }},
    {"world: robots elsewhere, observed in half an hour",
     [](Forger& f) {
       for (auto& robot : f.world().robots()) {
         robot.observed_x_m(robot.observed_x_m() + 1);
         robot.observed_at_ns(robot.observed_at_ns() + 1'800'000'000'000);
       }
     }},
    {"world: robots elsewhere",
     [](Forger& f) {
       for (auto& robot : f.world().robots()) {
         robot.observed_x_m(robot.observed_x_m() + 1);
         robot.observed_at_ns(robot.observed_at_ns() + 1'000'000);
       }
     }},
    {"feedback: a version that was never granted",
     [](Forger& f) {
       f.feedback().executing().version_number(f.feedback().executing().version_number() + 1000);
       f.feedback().executing().x_m(0);
     }},
    {"coordinator state: vision heard in half an hour",
     [](Forger& f) { f.state().watched_until_ns(f.state().watched_until_ns() + 1'800'000'000'000); }},
    {"obstacle list: from an agent, valid soon",
     [](Forger& f) {
       f.obstacles().header().sender(kVictim);
       f.obstacles().valid_at_ns(f.obstacles().valid_at_ns() + 1'000'000'000);
     }},
    {"obstacle list: valid far ahead",
     [](Forger& f) { f.obstacles().valid_at_ns(static_cast<std::int64_t>(kHuge)); }},
    {"obstacle list: valid in a minute",
     [](Forger& f) { f.obstacles().valid_at_ns(f.obstacles().valid_at_ns() + 60'000'000'000); }},
    {"obstacle list: incomplete",
     [](Forger& f) {
       f.obstacles().valid_at_ns(f.obstacles().valid_at_ns() + 5'000'000);
       f.obstacles().complete_within_m(0);
     }},
    {"obstacle list: an obstacle without a position",
     [](Forger& f) {
       f.obstacles().obstacles().resize(1);
       f.obstacles().obstacles()[0].x_m(std::numeric_limits<double>::quiet_NaN());
     }},
    {"obstacle list: an obstacle observed far ahead", [](Forger& f) {
       f.obstacles().obstacles().resize(1);
       f.obstacles().obstacles()[0].observed_at_ns(static_cast<std::int64_t>(kHuge));
     }}};

TEST_CASE("one hostile message of any kind costs no robot more than a moment") {
  for (const Forgery& forgery : kForgeries) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      CAPTURE(forgery.name, seed);
      SimSystem system(crossing(), seed);
      Forger forger(system);
      system.run_for(std::chrono::milliseconds(1200 + 300 * seed));
      forger.stop_listening();
      forgery.change(forger);
      forger.send();
      CHECK(system.run_until_arrived(system.begin() + 20s));
      const Report report = system.metrics().report();
      CHECK(report.arrived == 8);
      CHECK(report.contacts == 0);
      CHECK(report.makespan_s.value_or(99) < 8);
    }
  }
}

}  // namespace sidestep::hostile_test
