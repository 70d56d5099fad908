// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/motion/driving_course.hpp"
#include "common/motion/floor_rules.hpp"

namespace sidestep {

/// The courses that the agents of other robots have published, and the offers of new courses. Inputs: the
/// decoded messages. Courses that are not repeated are forgotten, because their agents may have ended.
class CourseBook {
 public:
  CourseBook(RobotId self, const FloorRules& rules);

  /// From now on, courses of robots that are far from this place are ignored: fleets are large, and courses
  /// are repeated before their robots come near.
  void set_place(const Vec2& place_m) { place_m_ = place_m; }
  /// Stores another robot's course, unless a later one is known; an empty course removes it. Ignores courses
  /// that no robot can drive on this floor, and those that start too long before or after `now`, because
  /// everybody has to compare its own course with them.
  void on_course(std::shared_ptr<const DrivingCourse> course, Time now);
  void on_offer(std::shared_ptr<const CourseOffer> offer, Time now);

  /// The courses of robots that are now within `horizon_m`, in the order of their numbers. Valid until the
  /// next call, whatever is heard meanwhile.
  std::span<const DrivingCourse* const> nearby(const Vec2& centre_m, double horizon_m, Time now);
  /// The offers that are recent enough to be taken. Valid until the next call, whatever is heard meanwhile.
  std::span<const CourseOffer* const> offers(Time now);

 private:
  struct Heard {
    RobotId robot = 0;
    Time heard_at{};
    Vec2 place_m{0, 0};  ///< where the robot was then
    std::shared_ptr<const DrivingCourse> course;
  };
  struct HeardOffer {
    std::shared_ptr<const CourseOffer> offer;
    Time heard_at{};
  };

  /// Whether a robot can drive the course, and it is about the present.
  bool is_of_use(const DrivingCourse& course, Time now) const;
  /// Whether the robot is far from this robot's place.
  bool is_far(const DrivingCourse& course, Time now) const;
  /// The place of the robot's course in courses_, or where it belongs.
  std::vector<Heard>::iterator find(RobotId robot);
  /// Forgets courses that are not repeated or are far, from time to time.
  void forget_old(Time now);

  const RobotId self_;
  const Field field_;
  const double max_speed_mps_;
  std::optional<Vec2> place_m_;
  Time forgot_at_{};
  std::vector<Heard> courses_;  // in the order of the robots' numbers
  std::vector<HeardOffer> heard_offers_;
  // What the last calls of nearby() and offers() have returned, and its owners.
  std::vector<std::shared_ptr<const DrivingCourse>> nearby_;
  std::vector<std::shared_ptr<const CourseOffer>> offers_;
  std::vector<const DrivingCourse*> nearby_pointers_;
  std::vector<const CourseOffer*> offer_pointers_;
};

}  // namespace sidestep
