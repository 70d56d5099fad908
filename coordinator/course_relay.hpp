// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>

#include "common/messaging/bus.hpp"
#include "coordinator/coordinator.hpp"
#include "coordinator/failover.hpp"

namespace sidestep {

/// Sends the courses and offers of agents on to all agents while the coordinator grants. Agents do not read
/// each other's topics, because with many robots the discovery and the handshakes of all pairs take too long.
/// Keeps no course: agents repeat their courses, so a coordinator that takes over knows nothing of them.
/// Relays of each agent no more than it sends if it plans anew in each cycle.
class CourseRelay {
 public:
  CourseRelay(Bus& bus, const CoordinatorIdentity& self, const Coordinator& coordinator, Duration cycle);
  CourseRelay(const CourseRelay&) = delete;
  CourseRelay& operator=(const CourseRelay&) = delete;

  const DropCounters& drops() const { return drops_; }

 private:
  void on_course(const msg::Course& message);
  void on_offer(const msg::CourseOffer& message);
  bool has_robot(RobotId robot) const { return coordinator_.ledger().has_robot(robot); }

  /// What an agent has sent since a time.
  struct Sent {
    Time since{};
    std::int64_t courses = 0, offers = 0;
  };
  /// The counts of the robot's agent in the present window of time.
  Sent& sent_by(RobotId robot);

  Bus& bus_;
  const CoordinatorIdentity self_;
  const Coordinator& coordinator_;
  const std::int64_t max_courses_;  // of an agent in a window
  std::map<RobotId, Sent> sent_;
  Writer<msg::Course> course_writer_;
  Writer<msg::CourseOffer> offer_writer_;
  DropCounters drops_;
};

}  // namespace sidestep
