// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/forger.hpp"

#include <limits>

#include "common/protocol/process_names.hpp"

namespace sidestep {
namespace {

constexpr std::uint64_t kHuge = std::uint64_t{1} << 61;

}  // namespace

Forger::Forger(SimNetwork& network, const Scenario& scenario, RobotId victim)
    : bus_(network),
      rules_(bus_, static_cast<std::uint32_t>(Sender::kOperator), SharedRules(scenario),
             [](const RulesMismatch&) {}),
      victim_(victim) {
  bus_.hide_from_observers();
}

void Forger::send() {
  for (const auto& publish : publish_) publish();
}

const std::vector<Forgery>& forgeries() {
  static const std::vector<Forgery> all{
      {"feedback: lifted at a time far ahead",
       [](Forger& f) {
         f.feedback().is_lifted(true);
         f.feedback().executing() = {};
         f.feedback().executing().robot(f.victim());
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
         f.state().header().sender(f.victim());
         f.state().epoch(f.state().epoch() + 1);
       }},
      {"coordinator state: number out of range", [](Forger& f) { f.state().coordinator(1u << 31); }},
      {"verdict: from an agent", [](Forger& f) { f.verdict().header().sender(f.victim()); }},
      {"ledger page: epoch", [](Forger& f) { f.page().epoch(kHuge); }},
      {"ledger page: from an agent",
       [](Forger& f) {
         f.page().header().sender(f.victim());
         f.page().header().message_number(kHuge);
       }},
      {"world: from an agent",
       [](Forger& f) {
         f.world().header().sender(f.victim());
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
       },
       true},
      {"coordinator state: vision heard in half an hour",
       [](Forger& f) { f.state().watched_until_ns(f.state().watched_until_ns() + 1'800'000'000'000); }},
      {"obstacle list: from an agent, valid soon",
       [](Forger& f) {
         f.obstacles().header().sender(f.victim());
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
      {"obstacle list: an obstacle observed far ahead",
       [](Forger& f) {
         f.obstacles().obstacles().resize(1);
         f.obstacles().obstacles()[0].observed_at_ns(static_cast<std::int64_t>(kHuge));
       }},
      {"course: from another robot's agent",
       [](Forger& f) {
         f.course().header().sender(f.victim() + 1);
         f.course().points().clear();
       }},
      {"course: planned far ahead",
       [](Forger& f) { f.course().planned_at_ns(static_cast<std::int64_t>(kHuge)); }},
      {"course: planned in half an hour",
       [](Forger& f) { f.course().planned_at_ns(f.course().planned_at_ns() + 1'800'000'000'000); }},
      {"course: the robot has none",
       [](Forger& f) {
         f.course().planned_at_ns(f.course().planned_at_ns() + 1);
         f.course().points().clear();
       }},
      {"course: a point without a position",
       [](Forger& f) {
         f.course().points().resize(1);
         f.course().points()[0].x_m(std::numeric_limits<float>::quiet_NaN());
       }},
      {"course: elsewhere, before all others",
       [](Forger& f) {
         f.course().planned_at_ns(f.course().planned_at_ns() + 1);
         f.course().due_ns(0);
         for (auto& point : f.course().points()) point.x_m(point.x_m() + 1);
       }},
      {"course offer: from a coordinator",
       [](Forger& f) { f.course_offer().header().sender(static_cast<std::uint32_t>(Sender::kCoordinator)); }},
      {"course offer: by another robot's agent",
       [](Forger& f) { f.course_offer().by(f.course_offer().by() + 1); }},
      {"course offer: no points", [](Forger& f) { f.course_offer().points().clear(); }},
      {"course offer: elsewhere, before all others",
       [](Forger& f) {
         f.course_offer().planned_at_ns(f.course_offer().planned_at_ns() + 1);
         f.course_offer().due_ns(0);
         for (auto& point : f.course_offer().points()) point.x_m(point.x_m() + 1);
       }},
      {"shared course: from an agent",
       [](Forger& f) {
         f.shared_course().header().sender(f.victim());
         f.shared_course().points().clear();
       }},
      {"shared course: planned far ahead",
       [](Forger& f) { f.shared_course().planned_at_ns(static_cast<std::int64_t>(kHuge)); }},
      {"shared course: planned in half an hour",
       [](Forger& f) {
         f.shared_course().planned_at_ns(f.shared_course().planned_at_ns() + 1'800'000'000'000);
       }},
      {"shared course: the robot has none",
       [](Forger& f) {
         f.shared_course().planned_at_ns(f.shared_course().planned_at_ns() + 1);
         f.shared_course().points().clear();
       }},
      {"shared course: elsewhere, before all others",
       [](Forger& f) {
         f.shared_course().planned_at_ns(f.shared_course().planned_at_ns() + 1);
         f.shared_course().due_ns(0);
         for (auto& point : f.shared_course().points()) point.x_m(point.x_m() + 1);
       }},
      {"shared course offer: by no robot", [](Forger& f) { f.shared_offer().by(kMaxRobots); }},
      {"shared course offer: elsewhere, before all others", [](Forger& f) {
         f.shared_offer().planned_at_ns(f.shared_offer().planned_at_ns() + 1);
         f.shared_offer().due_ns(0);
         for (auto& point : f.shared_offer().points()) point.x_m(point.x_m() + 1);
       }}};
  return all;
}

}  // namespace sidestep
