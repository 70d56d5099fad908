// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/course_book.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace sidestep {
namespace {

/// Offers are taken soon or never.
constexpr Duration kOfferAge{200'000'000};
constexpr std::size_t kMaxNearby = 40;  ///< number of nearest courses that are considered
/// Number of offers that are kept, in total and of one robot.
constexpr std::size_t kMaxOffers = 64, kMaxOffersOfRobot = 16;
constexpr Duration kForgetPeriod{200'000'000};
/// Courses of robots farther away are ignored, those that replace known ones too: a known course is forgotten
/// before its robot can have come near.
constexpr double kFar_m = 8;
/// Courses are rounded, and a robot may be a little faster for a moment.
constexpr double kSpeedTolerance_mps = 0.1;

/// Whether the time since a message is beyond a bound. A time in the future was recorded before the clock was
/// set back.
bool is_older(Time heard_at, Duration bound, Time now) { return std::chrono::abs(now - heard_at) > bound; }

}  // namespace

CourseBook::CourseBook(RobotId self, const FloorRules& rules)
    : self_(self), field_(rules.field), max_speed_mps_(rules.limits.speed_mps + kSpeedTolerance_mps) {}

bool CourseBook::is_of_use(const DrivingCourse& course, Time now) const {
  if (course.is_empty()) return true;
  if (!course.is_about(now)) return false;
  const double max_step_m = max_speed_mps_ * to_seconds(DrivingCourse::kSample);
  const State* last = nullptr;
  for (const State& state : course.states) {
    const bool is_possible = field_.contains(state.position_m, 0) &&
                             state.velocity_mps.norm() <= max_speed_mps_ &&
                             (!last || (state.position_m - last->position_m).norm() <= max_step_m);
    if (!is_possible) return false;
    last = &state;
  }
  return true;
}

bool CourseBook::is_far(const DrivingCourse& course, Time now) const {
  return place_m_ && !course.is_empty() && (course.position_at(now) - *place_m_).norm() > kFar_m;
}

std::vector<CourseBook::Heard>::iterator CourseBook::find(RobotId robot) {
  return std::ranges::lower_bound(courses_, robot, {}, &Heard::robot);
}

void CourseBook::on_course(std::shared_ptr<const DrivingCourse> course, Time now) {
  // Agents of a large fleet hear thousands of courses per second, most of them of robots far away.
  if (course->robot == self_ || is_far(*course, now) || !is_of_use(*course, now)) return;
  auto heard = find(course->robot);
  const bool is_known = heard != courses_.end() && heard->robot == course->robot;
  const bool is_late = is_known && course->planned_at < heard->course->planned_at &&
                       !is_older(heard->heard_at, DrivingCourse::kMaxSilence, now);
  if (is_late) return;
  if (!is_known) heard = courses_.emplace(heard);
  const Vec2 place_m = course->is_empty() ? Vec2(0, 0) : course->position_at(now);
  *heard = {course->robot, now, place_m, std::move(course)};
}

void CourseBook::on_offer(std::shared_ptr<const CourseOffer> offer, Time now) {
  if (offer->by == self_ || !is_of_use(offer->course, now)) return;
  std::erase_if(heard_offers_, [&](const HeardOffer& heard) {
    return is_older(heard.heard_at, kOfferAge, now) ||
           (heard.offer->by == offer->by && heard.offer->course.robot == offer->course.robot);
  });
  const auto of_robot =
      std::ranges::count(heard_offers_, offer->by, [](const HeardOffer& heard) { return heard.offer->by; });
  if (heard_offers_.size() < kMaxOffers && static_cast<std::size_t>(of_robot) < kMaxOffersOfRobot)
    heard_offers_.push_back({std::move(offer), now});
}

void CourseBook::forget_old(Time now) {
  if (std::chrono::abs(now - forgot_at_) < kForgetPeriod) return;
  forgot_at_ = now;
  std::erase_if(courses_, [&](const Heard& heard) {
    return is_older(heard.heard_at, DrivingCourse::kMaxSilence, now) || is_far(*heard.course, now);
  });
}

std::span<const DrivingCourse* const> CourseBook::nearby(const Vec2& centre_m, double horizon_m, Time now) {
  forget_old(now);
  nearby_.clear();
  for (const Heard& heard : courses_) {
    if (is_older(heard.heard_at, DrivingCourse::kMaxSilence, now) || heard.course->is_empty()) continue;
    const double way_m = max_speed_mps_ * to_seconds(std::chrono::abs(now - heard.heard_at));
    if ((heard.place_m - centre_m).squaredNorm() > (horizon_m + way_m) * (horizon_m + way_m)) continue;
    if ((heard.course->position_at(now) - centre_m).norm() <= horizon_m) nearby_.push_back(heard.course);
  }
  if (nearby_.size() > kMaxNearby) {
    const auto distance_m = [&](const auto& course) { return (course->position_at(now) - centre_m).norm(); };
    std::ranges::nth_element(nearby_, nearby_.begin() + kMaxNearby, {}, distance_m);
    nearby_.resize(kMaxNearby);
    std::ranges::sort(nearby_, {}, [](const auto& course) { return course->robot; });
  }
  nearby_pointers_.clear();
  for (const auto& course : nearby_) nearby_pointers_.push_back(course.get());
  return nearby_pointers_;
}

std::span<const CourseOffer* const> CourseBook::offers(Time now) {
  std::erase_if(heard_offers_,
                [&](const HeardOffer& heard) { return is_older(heard.heard_at, kOfferAge, now); });
  offers_.clear();
  offer_pointers_.clear();
  for (const HeardOffer& heard : heard_offers_) {
    offers_.push_back(heard.offer);
    offer_pointers_.push_back(heard.offer.get());
  }
  return offer_pointers_;
}

}  // namespace sidestep
