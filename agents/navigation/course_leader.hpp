// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "agents/navigation/course_conflicts.hpp"
#include "agents/navigation/course_search.hpp"

namespace sidestep {

/// Plans courses for robots whose courses conflict, because they did not know each other's courses or did not
/// have to avoid them when they planned. A robot leads the robots that are connected to it by conflicts if
/// its own course precedes theirs. It plans new courses for them one after another, in the order given by
/// precedes() and around the courses that precede theirs, a few in each cycle, and offers them.
class CourseLeader {
 public:
  struct Query {
    Time start{};              ///< of the robot's next motion
    const DrivingCourse& own;  ///< the course of this robot
    std::span<const DrivingCourse* const> others{};
    std::span<const Vec2> leaving_m{}, staying_m{};  ///< robots without a course
    MotionLimits limits{};
  };

  /// Offers of a robot that precedes another one are recent for this long. In this time the other robot
  /// neither leads nor plans a course of its own.
  static constexpr Duration kRecent{80'000'000};
  /// Offered courses start this long after the cycle in which they are planned, so that they arrive before.
  static constexpr Duration kOfferLead{50'000'000};

  /// Both must outlive this object.
  CourseLeader(CourseSearch& search, CourseConflicts& conflicts) : search_(search), conflicts_(conflicts) {}

  /// Returns the new offers; none if this robot leads nobody. Valid until the next call.
  std::span<const CourseOffer> plan(const Query& query, Rng& rng);
  /// Forgets the group and the offers: the robot has no course any more, or its clock was set back.
  void give_up();

 private:
  /// The course of another robot.
  struct Other {
    const DrivingCourse* known;   // as its robot has published it
    const DrivingCourse* course;  // the same, or what this robot has offered instead
  };
  struct Made {
    CourseOffer offer;
    Time made_at{};
  };
  void collect_others(const Query& query);
  /// The robots that this one leads, as numbers in others_, in the order given by precedes().
  std::vector<std::size_t> find_group(const Query& query);
  void remember_group(const Query& query, std::span<const std::size_t> group);
  void offer_courses(const Query& query, std::span<const std::size_t> group, Rng& rng);

  CourseSearch& search_;
  CourseConflicts& conflicts_;
  std::vector<RobotId> led_;  // until leads_until_
  Time leads_until_{};
  std::vector<Other> others_;
  std::vector<Made> made_;  // offers that may still be taken
  std::vector<CourseOffer> offers_;
};

}  // namespace sidestep
