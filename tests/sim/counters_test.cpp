// SPDX-License-Identifier: Apache-2.0
// Makes each process of a system drop messages for each reason of the table.
#include <functional>
#include <limits>
#include <set>

#include "common/config/scenario_loader.hpp"
#include "common/messaging/course_codec.hpp"
#include "common/messaging/order_codec.hpp"
#include "common/messaging/version_codec.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"

namespace sidestep::counters_test {

using namespace std::chrono_literals;

constexpr RobotId kRobot = 0;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Scenario crossing() {
  return load_scenario(std::string(SIDESTEP_SOURCE_DIR) + "/deploy/scenarios/crossing.yaml");
}

/// A process outside the system that sends faulty messages. It knows the latest messages about robot 0, and
/// the scenario's rules if it is given them.
class FaultySender {
 public:
  FaultySender(SimSystem& system, const std::optional<Scenario>& rules)
      : system_(system), bus_(system.network()) {
    if (rules) bus_.use_rules(SharedRules(*rules).fingerprint(), [](const auto&, const auto&) {});
    bus_.subscribe(topics::kCommand, kRobot, [this](const msg::Command& message) { command = message; });
    bus_.subscribe(topics::kFeedback, kRobot, [this](const msg::Feedback& message) { feedback = message; });
    bus_.subscribe(topics::kCoordinator, [this](const msg::CoordinatorState& message) { state = message; });
    bus_.subscribe(topics::kProposal, [this](const msg::Proposal& message) {
      if (message.robot() != kRobot) return;
      proposal = message;
      if (on_proposal) on_proposal();
    });
    system.run_for(1s);
  }
  template <typename Message>
  void send(const Topic<Message>& topic, Message message, std::optional<Time> stamp = {}) {
    auto writer = bus_.advertise(topic, kRobot);
    // Waits until all readers have found the writer.
    if (topic.qos == Qos::kEvent) system_.run_for(200ms);
    writer.publish(message, stamp.value_or(now()));
  }
  Time now() const { return system_.now(); }

  msg::Command command;
  msg::Feedback feedback;
  msg::CoordinatorState state;
  msg::Proposal proposal;
  std::function<void()> on_proposal;

 private:
  SimSystem& system_;
  SimBus bus_;
};

template <typename Message>
Message from(std::uint32_t sender) {
  Message message;
  message.header().sender(sender);
  return message;
}
template <typename Message>
Message from(Sender sender) {
  return from<Message>(static_cast<std::uint32_t>(sender));
}

msg::WorldState world_of(const FaultySender& stranger, double x_m, Duration ahead = 0s) {
  auto world = from<msg::WorldState>(Sender::kVision);
  world.valid_at_ns(to_ns(stranger.now()));
  auto& robot = world.robots().emplace_back();
  robot.robot(kRobot);
  robot.observed_at_ns(to_ns(stranger.now() + ahead));
  robot.observed_x_m(x_m);
  return world;
}

msg::DetectionFrame frame_of(const FaultySender& stranger) {
  msg::DetectionFrame frame;
  frame.header() = stranger.feedback.header();  // the simulator's incarnation
  frame.captured_at_ns(to_ns(stranger.now()));
  frame.obstacles_complete_within_m(1e9);
  return frame;
}

/// A command in the name of the obeyed agent, with a version that the agent has not sent.
msg::Command with_version(const FaultySender& stranger, VersionNumber base, Duration until_start) {
  msg::Command command = stranger.command;
  command.epoch(stranger.feedback.obeyed_epoch());
  command.has_version(true);
  const Version version{kRobot, command.header().incarnation(),
                        stranger.feedback.executing().version_number() + 1000, base,
                        Trajectory::resting(stranger.now() + until_start, {0, 0})};
  command.version(encode(version));
  return command;
}

/// Answers the next proposals of robot 0 before the coordinator does.
void answer_proposals(FaultySender& stranger, bool is_grant, std::optional<Time> stamp = {}) {
  stranger.on_proposal = [&stranger, is_grant, stamp] {
    auto verdict = from<msg::Verdict>(Sender::kCoordinator);
    verdict.robot(kRobot);
    verdict.epoch(stranger.proposal.epoch());
    verdict.request_stamp_ns(stranger.proposal.header().stamp_ns());
    verdict.proposal_number(stranger.proposal.candidates()[0].version_number());
    verdict.granted_version(is_grant ? 12345 : 0);
    stranger.send(topics::kVerdict, verdict, stamp);
  };
}

/// A reason to drop a message, the process that drops it, and how to cause it.
struct Cause {
  DropReason reason;
  const char* process;
  std::function<void(FaultySender&, SimSystem&)> act;
  std::function<void(Scenario&)> change = nullptr;
};

const std::vector<Cause> kCauses{
    {DropReason::kOtherRules, "coordinator",
     [](FaultySender&, SimSystem& system) {
       FaultySender other(system, std::nullopt);
       other.send(topics::kProposal, msg::Proposal());
     }},
    {DropReason::kInjectedLoss, "coordinator",
     [](FaultySender&, SimSystem& system) {
       system.set_link("agent 0", "coordinator", {0.5, 1, 0, 100us, 100us, 200us, false});
     }},
    {DropReason::kQueueFull, "coordinator",
     [](FaultySender&, SimSystem& system) { system.pause("coordinator", 200ms, 1); }},
    {DropReason::kContestedSender, "agent 0",
     [](FaultySender& s, SimSystem&) {
       s.feedback.header().incarnation(s.feedback.header().incarnation() + 1);
       s.send(topics::kFeedback, s.feedback);
     }},
    {DropReason::kMalformedFeedback, "agent 0",
     [](FaultySender& s, SimSystem&) {
       s.feedback.x_m(kNan);
       s.send(topics::kFeedback, s.feedback);
     }},
    {DropReason::kMalformedVerdict, "agent 0",
     [](FaultySender& s, SimSystem&) {
       auto verdict = from<msg::Verdict>(Sender::kCoordinator);
       verdict.robot(5);
       s.send(topics::kVerdict, verdict);
     }},
    {DropReason::kForgedSender, "agent 0",
     [](FaultySender& s, SimSystem&) { s.send(topics::kWorld, from<msg::WorldState>(Sender::kSimulator)); }},
    {DropReason::kMalformedObservation, "agent 0",
     [](FaultySender& s, SimSystem&) { s.send(topics::kWorld, world_of(s, kNan)); }},
    {DropReason::kMalformedObstacles, "agent 0",
     [](FaultySender& s, SimSystem&) {
       auto list = from<msg::ObstacleList>(Sender::kVision);
       list.complete_within_m(kNan);
       s.send(topics::kObstacles, list);
     }},
    {DropReason::kMalformedScan, "agent 0",
     [](FaultySender& s, SimSystem&) {
       auto scan = from<msg::LaserScan>(0);
       scan.header().incarnation(s.feedback.header().incarnation());
       s.send(topics::kScan, scan);
     },
     [](Scenario& scenario) { scenario.laser.emplace(); }},
    {DropReason::kMalformedLedgerPage, "agent 0",
     [](FaultySender& s, SimSystem&) {
       auto page = from<msg::LedgerPage>(Sender::kCoordinator);
       page.page_index(kMaxRobots);
       s.send(topics::kLedger, page);
     }},
    {DropReason::kMalformedVersion, "agent 0",
     [](FaultySender& s, SimSystem&) {
       auto page = from<msg::LedgerPage>(Sender::kCoordinator);
       page.page_index(77);
       page.epoch(s.state.epoch());
       page.min_x_m(-9), page.min_y_m(-9), page.max_x_m(9), page.max_y_m(9);
       page.versions().push_back(s.feedback.executing());
       page.versions()[0].robot(5);
       page.versions()[0].x_m(s.feedback.x_m());
       page.versions()[0].y_m(s.feedback.y_m());
       page.versions()[0].vx_mps(kNan);
       s.send(topics::kLedger, page);
     }},
    {DropReason::kMalformedCourse, "coordinator",
     [](FaultySender& s, SimSystem&) { s.send(topics::kCourse, from<msg::Course>(5)); }},
    {DropReason::kMalformedCourseOffer, "coordinator",
     [](FaultySender& s, SimSystem&) { s.send(topics::kCourseOffer, from<msg::CourseOffer>(5)); }},
    {DropReason::kMalformedCourse, "agent 0",
     [](FaultySender& s, SimSystem&) {
       s.send(topics::kSharedCourse, from<msg::Course>(Sender::kCoordinator));
     }},
    {DropReason::kMalformedCourseOffer, "agent 0",
     [](FaultySender& s, SimSystem&) {
       s.send(topics::kSharedCourseOffer, from<msg::CourseOffer>(Sender::kCoordinator));
     }},
    {DropReason::kMalformedCoordinatorState, "agent 0",
     [](FaultySender& s, SimSystem&) {
       s.state.coordinator_mode(static_cast<msg::CoordinatorMode>(99));
       s.send(topics::kCoordinator, s.state);
     }},
    {DropReason::kMalformedRegistration, "coordinator",
     [](FaultySender& s, SimSystem&) { s.send(topics::kRegistration, from<msg::Registration>(5)); }},
    {DropReason::kMalformedProposal, "coordinator",
     [](FaultySender& s, SimSystem&) { s.send(topics::kProposal, from<msg::Proposal>(5)); }},
    {DropReason::kMalformedCommand, "simulator",
     [](FaultySender& s, SimSystem&) {
       s.command.desired_heading_rad(kNan);
       s.send(topics::kCommand, s.command);
     }},
    {DropReason::kMalformedPlacement, "agent 0",
     [](FaultySender& s, SimSystem&) {
       auto place = from<msg::Disturbance>(Sender::kOperator);
       place.disturbance_kind(msg::DisturbanceKind::DISTURBANCE_PLACE);
       place.x_m(kNan);
       s.send(topics::kDisturbance, place);
     }},
    {DropReason::kMalformedRules, "vision",
     [](FaultySender& s, SimSystem&) {
       msg::SharedRules rules;
       rules.text().assign({'?', '\n'});
       s.send(topics::kRules, rules);
     }},
    {DropReason::kMalformedFrame, "vision",
     [](FaultySender& s, SimSystem&) {
       auto frame = frame_of(s);
       frame.ball_count(msg::MAX_DETECTED_BALLS + 1);
       s.send(topics::kDetections, frame);
     }},
    {DropReason::kMalformedDetection, "vision",
     [](FaultySender& s, SimSystem&) {
       auto frame = frame_of(s);
       frame.robots().emplace_back().x_m(kNan);
       s.send(topics::kDetections, frame);
     }},
    {DropReason::kMalformedImage, "vision",
     [](FaultySender& s, SimSystem&) {
       msg::CameraImage image;
       image.header() = s.feedback.header();  // the simulator's incarnation
       s.send(topics::kImages, image);
     },
     [](Scenario& scenario) {
       scenario.vision.images = ImageSpec{};
       scenario.robots.resize(1);
     }},
    {DropReason::kFutureWorld, "coordinator",
     [](FaultySender& s, SimSystem&) {
       auto world = from<msg::WorldState>(Sender::kVision);
       world.valid_at_ns(to_ns(s.now() + 1s));
       s.send(topics::kWorld, world);
     }},
    {DropReason::kFutureObservation, "agent 0",
     [](FaultySender& s, SimSystem&) { s.send(topics::kWorld, world_of(s, 0, 1s)); }},
    {DropReason::kFutureObstacles, "agent 0",
     [](FaultySender& s, SimSystem&) {
       auto list = from<msg::ObstacleList>(Sender::kVision);
       list.valid_at_ns(to_ns(s.now() + 10s));
       s.send(topics::kObstacles, list);
     }},
    {DropReason::kImplausibleClock, "agent 0",
     [](FaultySender& s, SimSystem&) { answer_proposals(s, false, Time{}); }},
    {DropReason::kFrequentEpoch, "coordinator",
     [](FaultySender& s, SimSystem& system) {
       for (int i = 1; i <= 5; ++i) {
         s.proposal.epoch(static_cast<Epoch>(to_ns(s.now() + i * 10s)));
         s.send(topics::kProposal, s.proposal);
         system.run_for(10ms);
       }
     }},
    {DropReason::kFrequentCourse, "coordinator",
     [](FaultySender& s, SimSystem&) {
       DrivingCourse none;
       none.robot = 0;
       none.planned_at = s.now();
       for (int i = 0; i < 20; ++i) s.send(topics::kCourse, encode(none));
     }},
    {DropReason::kUnknownRobot, "coordinator",
     [](FaultySender& s, SimSystem&) {
       s.proposal.robot(900);
       s.proposal.header().sender(900);
       s.send(topics::kProposal, s.proposal);
     }},
    {DropReason::kUnproposedGrant, "agent 0", [](FaultySender& s, SimSystem&) { answer_proposals(s, true); }},
    {DropReason::kUnexpectedVerdict, "agent 0", [](FaultySender&, SimSystem&) {},
     [](Scenario& scenario) { scenario.network.duplicate = 0.5; }},
    {DropReason::kLateFact, "coordinator", [](FaultySender&, SimSystem&) {},
     [](Scenario& scenario) { scenario.network.delay_max = 60ms; }},
    {DropReason::kLatePage, "agent 0", [](FaultySender&, SimSystem&) {},
     [](Scenario& scenario) { scenario.network.delay_max = 60ms; }},
    {DropReason::kOldEpoch, "agent 0",
     [](FaultySender& s, SimSystem&) {
       s.state.epoch(8);
       s.send(topics::kCoordinator, s.state);
     }},
    {DropReason::kContradictoryFact, "coordinator",
     [](FaultySender& s, SimSystem&) {
       s.feedback.executing().version_number(s.feedback.executing().version_number() + 5000);
       s.send(topics::kFeedback, s.feedback);
     }},
    {DropReason::kFactOfHigherEpoch, "coordinator",
     [](FaultySender& s, SimSystem& system) {
       // The coordinator no longer acts on reports of higher epochs.
       for (int i = 1; i <= 4; ++i) {
         s.proposal.epoch(static_cast<Epoch>(to_ns(s.now() + i * 10s)));
         s.send(topics::kProposal, s.proposal);
         system.run_for(10ms);
       }
       system.run_for(1s);
       s.feedback.obeyed_epoch(static_cast<Epoch>(to_ns(s.now() + 60s)));
       s.feedback.executing().version_number(s.feedback.executing().version_number() + 5000);
       s.send(topics::kFeedback, s.feedback);
     }},
    {DropReason::kRefusedProposal, "coordinator",
     [](FaultySender& s, SimSystem&) {
       s.proposal.epoch(1);
       s.send(topics::kProposal, s.proposal);
     }},
    {DropReason::kRefusedRegistration, "coordinator",
     [](FaultySender& s, SimSystem&) {
       auto registration = from<msg::Registration>(kRobot);
       registration.epoch(1);
       registration.is_absent(true);
       s.send(topics::kRegistration, registration);
     }},
    {DropReason::kRefusedAttestation, "coordinator",
     [](FaultySender& s, SimSystem&) {
       s.send(topics::kAttestation, from<msg::AbsenceAttestation>(Sender::kOperator));
     }},
    {DropReason::kMalformedOrder, "coordinator",
     [](FaultySender& s, SimSystem&) {
       auto order = from<msg::Order>(Sender::kOperator);
       order.terms().order_kind(static_cast<msg::OrderKind>(99));
       s.send(topics::kOrder, order);
     }},
    {DropReason::kRefusedOrder, "coordinator",
     [](FaultySender& s, SimSystem&) {
       s.send(topics::kOrder,
              encode(Order{msg::OrderKind::ORDER_CANCEL, 900, static_cast<ClientId>(Sender::kOperator), 1}));
     }},
    {DropReason::kUntimelyFrame, "vision",
     [](FaultySender& s, SimSystem&) {
       auto frame = frame_of(s);
       frame.captured_at_ns(to_ns(s.now() - 1s));
       s.send(topics::kDetections, frame);
     }},
    {DropReason::kFalseDetection, "vision",
     [](FaultySender& s, SimSystem&) {
       auto frame = frame_of(s);
       auto& robot = frame.robots().emplace_back();
       robot.x_m(-s.feedback.x_m() + 1);
       robot.confidence(1);
       s.send(topics::kDetections, frame);
     }},
    {DropReason::kTooManyObstacles, "vision",
     [](FaultySender& s, SimSystem&) {
       for (std::uint32_t row = 0; row < 8; ++row) {
         auto frame = frame_of(s);
         frame.obstacle_count(msg::MAX_OBSTACLES);
         for (std::size_t i = 0; i < msg::MAX_OBSTACLES; ++i) {
           frame.obstacles()[i].x_m(-50 + 0.39 * static_cast<double>(i));
           frame.obstacles()[i].y_m(10 + 5 * row);
           frame.obstacles()[i].radius_m(0.1);
         }
         s.send(topics::kDetections, frame);
       }
     }},
    {DropReason::kCommandLost, "simulator", [](FaultySender&, SimSystem&) {},
     [](Scenario& scenario) { scenario.command_loss = 0.2; }},
    {DropReason::kFencedCommand, "simulator",
     [](FaultySender& s, SimSystem&) {
       s.command.header().incarnation(1);
       s.command.has_version(false);
       s.send(topics::kCommand, s.command);
     }},
    {DropReason::kLateVersion, "simulator",
     [](FaultySender& s, SimSystem&) { s.send(topics::kCommand, with_version(s, 0, -100ms)); }},
    {DropReason::kWrongBase, "simulator",
     [](FaultySender& s, SimSystem&) { s.send(topics::kCommand, with_version(s, 1, 50ms)); }},
    {DropReason::kRefusedDisturbance, "simulator",
     [](FaultySender& s, SimSystem&) {
       auto push = from<msg::Disturbance>(Sender::kOperator);
       push.robot(99);
       s.send(topics::kDisturbance, push);
     }},
    {DropReason::kUnusedByMonitor, "monitor",
     [](FaultySender& s, SimSystem&) {
       msg::GroundTruth truth;
       truth.header() = s.feedback.header();
       truth.penetration_m_s(kNan);
       s.send(topics::kTruth, truth);
     }},
};

/// Reasons that no message on SimBus can cause, and the tests that cause them.
const std::set<DropReason> kCoveredByOtherTests{
    DropReason::kUnreadable,          // dds/robustness_test
    DropReason::kMalformedDatagram,   // dds/robustness_test
    DropReason::kForgottenPeer,       // dds/presence_test
    DropReason::kUnknownParticipant,  // dds/participant_filter_test, like the next
                                      // one
    DropReason::kRefusedParticipant,
    DropReason::kMalformedNetworkFault,  // process/network_faults_test
    DropReason::kMalformedLeaguePacket,  // league/league_source_test, like the next four
    DropReason::kRepeatedLeagueFrame, DropReason::kUndatedLeagueFrame, DropReason::kUnusedLeagueDetection,
    DropReason::kOtherLeagueSender,
    DropReason::kUnsentLeaguePacket,  // needs a broken network
    DropReason::kUnstoredCommand,     // adapters/robot_driver_node_test
    DropReason::kMalformedOdometry,   // adapters/velocity_driver_test
    DropReason::kMisdatedOdometry,    // adapters/robot_driver_node_test
    DropReason::kRejectedByBase,      // adapters/league_driver_test
    DropReason::kImplausibleEpoch,    // failover_test; codecs refuse such messages before it
};

TEST_CASE("the process that drops a message counts it under the reason for the drop") {
  std::set<DropReason> covered = kCoveredByOtherTests;
  for (const Cause& cause : kCauses) {
    covered.insert(cause.reason);
    CAPTURE(cause.process, info_of(cause.reason).name);
    const auto count = [&](bool is_caused) -> std::uint64_t {
      Scenario scenario = crossing();
      if (cause.change && is_caused) cause.change(scenario);
      SimSystem system(scenario, 1);
      FaultySender stranger(system, scenario);
      if (is_caused) cause.act(stranger, system);
      system.run_for(1500ms);
      const Report report = system.metrics().report();
      const auto process = report.counters.find(cause.process);
      if (process == report.counters.end() || !process->second.contains(cause.reason)) return 0;
      return process->second.at(cause.reason);
    };
    CHECK(count(true) > count(false));
  }
  for (const DropReasonInfo& info : kDropReasons) {
    CAPTURE(info.name);
    CHECK(covered.contains(info.reason));
  }
}

TEST_CASE("a run without faults drops messages only for expected reasons") {
  SimSystem system(crossing(), 1);
  CHECK(system.run_until_arrived(system.begin() + 20s));
  for (const auto& [process, counts] : system.metrics().report().counters) {
    for (const auto& [reason, times] : counts) {
      CAPTURE(process, info_of(reason).name, times);
      CHECK_FALSE(info_of(reason).is_unusual);
    }
  }
}

}  // namespace sidestep::counters_test
