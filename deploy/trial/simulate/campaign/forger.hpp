// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "common/messaging/rules_exchange.hpp"
#include "common/messaging/sim/bus.hpp"
#include "common/messaging/topics.hpp"

namespace sidestep {

/// A hostile process that knows the scenario's rules. It resends altered copies of the messages that it has
/// received about one robot, its victim. Observers do not receive its messages: they judge only the other
/// processes.
class Forger {
 private:
  SimBus bus_;
  RulesExchange rules_;
  RobotId victim_;
  std::vector<std::function<void()>> publish_;

 public:
  Forger(SimNetwork& network, const Scenario& scenario, RobotId victim);
  Forger(const Forger&) = delete;
  Forger& operator=(const Forger&) = delete;

  RobotId victim() const { return victim_; }
  /// Sends the messages that were changed since the last call. If no message of a topic was received, none is
  /// sent.
  void send();

  /// The latest message of a topic, as last changed. Calling this marks the message for sending.
  template <typename Message>
  class Forged {
   public:
    Forged(Forger& forger, const Topic<Message>& topic)
        : writer_(forger.bus_.advertise(topic, forger.victim_)) {
      forger.bus_.subscribe(topic, forger.victim_, [this, &forger](const Message& message) {
        if constexpr (requires { message.robot(); }) {
          if (message.robot() != forger.victim_) return;
        }
        message_ = message;
        is_known_ = true;
      });
      forger.publish_.push_back([this, &forger] {
        if (!std::exchange(is_changed_, false) || !is_known_) return;
        Message copy = message_;
        writer_.publish(copy, forger.bus_.now());
      });
    }
    Message& operator()() {
      is_changed_ = true;
      return message_;
    }

   private:
    Writer<Message> writer_;
    Message message_;
    bool is_known_ = false, is_changed_ = false;
  };
  Forged<msg::Feedback> feedback{*this, topics::kFeedback};
  Forged<msg::Command> command{*this, topics::kCommand};
  Forged<msg::Registration> registration{*this, topics::kRegistration};
  Forged<msg::Proposal> proposal{*this, topics::kProposal};
  Forged<msg::CoordinatorState> state{*this, topics::kCoordinator};
  Forged<msg::Verdict> verdict{*this, topics::kVerdict};
  Forged<msg::LedgerPage> page{*this, topics::kLedger};
  Forged<msg::WorldState> world{*this, topics::kWorld};
  Forged<msg::ObstacleList> obstacles{*this, topics::kObstacles};
  Forged<msg::Course> course{*this, topics::kCourse};
  Forged<msg::CourseOffer> course_offer{*this, topics::kCourseOffer};
  Forged<msg::Course> shared_course{*this, topics::kSharedCourse};
  Forged<msg::CourseOffer> shared_offer{*this, topics::kSharedCourseOffer};
};

/// A false message that must not disturb any robot for more than a moment (PROTOCOL.md, "Hostile messages").
struct Forgery {
  std::string name;
  std::function<void(Forger&)> change;
  /// Whether the forged robot report could be true, so that for a while a ledger contains a version that no
  /// observer knows.
  bool is_plausible_report = false;
};

[[nodiscard]] const std::vector<Forgery>& forgeries();

}  // namespace sidestep
