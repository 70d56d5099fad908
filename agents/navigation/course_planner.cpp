// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/course_planner.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "agents/navigation/motion_control.hpp"
#include "agents/navigation/right_of_way.hpp"
#include "agents/navigation/trapezoidal_profile.hpp"

namespace sidestep {
namespace {

/// A robot that is farther from its course needs another one.
constexpr double kMaxDeviation_m = 0.05;
/// A target that is nearer to the last one is the same.
constexpr double kSameTarget_m = 0.02;
/// Courses are kept while they come no closer than the required separation less this. Versions keep the
/// required separation in any case.
constexpr double kKeptTolerance_m = 0.004;
/// A conflict that is nearer cannot be left to others. One that is farther away than the horizon is ignored,
/// because much will change until then.
constexpr Duration kNear{350'000'000}, kHorizon{3'000'000'000};
/// If no course is found, the robot keeps its course while it is free for kFree, and otherwise drives without
/// one until it tries again.
constexpr Duration kFree{200'000'000}, kRetry{200'000'000}, kRetryWithCourse{50'000'000};
/// The time until the next attempt doubles after each failure, up to this.
constexpr Duration kMaxRetry{6'400'000'000};
/// All robots know a course after this time.
constexpr Duration kKnown{50'000'000};
/// How long a robot waits for an offer, and for how long at most while offers to others are recent. A
/// conflict this long after the last one is a new one.
constexpr Duration kWait{120'000'000}, kMaxWait{400'000'000}, kNewConflict{1'000'000'000};
/// A robot that will arrive later than alone by more than kLate_s, and that will drive for longer than
/// kWorthwhile_s, looks for a course that is faster by kFaster after kImprove_s on average.
constexpr double kLate_s = 0.1, kWorthwhile_s = 0.5;
constexpr Duration kFaster{40'000'000};
constexpr double kImprove_s = 0.1, kMaxImprove_s = 3.2;  // doubled after each failure
/// A course that ends before the target is continued when this time is left.
constexpr Duration kContinue{1'000'000'000};
/// The frequency of the critically damped controller that follows courses, and its bound with an acceleration
/// that is held for some time.
constexpr double kFrequency_radps = 15, kFrequencyTimesHold_rad = 0.75;
/// Delays of a course: the step in which they are searched, the largest one in a cycle, and of a course.
constexpr Duration kDelayStep{2'000'000}, kMaxDelayPerCycle{100'000'000}, kMaxDelay{300'000'000};
/// An error of the velocity counts like the error of the position that it causes in this time.
constexpr double kVelocityWeight_s = 0.1;
constexpr double kNegligibleLag_m = 0.002;
/// A course is straight if it is nowhere farther from the straight line, and no slower than by this time.
/// Courses end at a sample, after the robot has come to rest.
constexpr double kStraight_m = 0.003, kStraight_s = 0.03 + to_seconds(DrivingCourse::kSample);
/// A robot is due within a time that messages may contain, however slow it is.
constexpr double kMaxWay_s = 1800;

/// The effort that searches may spend per second on average, how much the robot may save up, and how much it
/// may owe because a search has taken longer than its effort says.
constexpr double kEffort_perS = 1'000, kMaxEffort = 10'000, kMaxDebt = 500;
/// The effort of a search that takes a second on an idle core.
constexpr double kEffortOfSecond = 300'000;
/// What is left for necessary searches before others begin.
constexpr double kReserve = 1'000;
/// After this many courses that it has lost within a small distance, the robot drives without one for kLost,
/// longer after each further one.
constexpr int kMaxLosses = 3;
constexpr double kSamePlace_m = 0.1;
constexpr Duration kLost{500'000'000}, kMaxLost{5'000'000'000};
/// An offered course that ends later than the present one by more than this is not taken.
constexpr Duration kMaxOfferedDelay{4'000'000'000};

double time_alone_s(const Vec2& way_m, const Vec2& velocity_mps, const MotionLimits& limits) {
  const double length_m = way_m.norm();
  const double speed_mps = length_m > 0 ? std::max(0.0, velocity_mps.dot(way_m) / length_m) : 0;
  return TrapezoidalProfile::duration_s(length_m, speed_mps, limits);
}

}  // namespace

CoursePlanner::CoursePlanner(RobotId robot, const FloorRules& rules, ObstacleWorld world)
    : robot_(robot),
      limits_(rules.limits),
      separation_m_(rules.min_separation_m() - kKeptTolerance_m),
      conflicts_(rules.min_separation_m() - kKeptTolerance_m),
      search_(rules, std::move(world)) {}

void CoursePlanner::give_up() {
  own_.reset();
  due_.reset();
  needs_course_ = false;
  offers_ = {};
  waiting_since_ = {};
  improve_at_ = {};
  last_planned_at_ = {};
  leader_.give_up();
}

void CoursePlanner::start_anew(const Query& query) {
  own_.reset();
  first_target_m_ = query.target_m;
  losses_ = 0;
  // The present speed limit may be lower for a moment only.
  const double alone_s = time_alone_s(query.target_m - query.at_start.position_m, {0, 0}, limits_);
  due_ = query.start + from_seconds(std::min(alone_s, kMaxWay_s));
  retry_at_ = query.start;
  improve_s_ = kImprove_s;
  retry_ = kRetry;
}

const DrivingCourse* CoursePlanner::follow(const Query& query) {
  const bool is_same_trip = due_ && query.start - *due_ <= kMaxOverdue &&
                            (query.target_m - first_target_m_).norm() <= kSameTarget_m;
  if (!is_same_trip) start_anew(query);
  target_m_ = query.target_m;
  conflict_.reset();
  brakes_ = false;
  needs_course_ = query.goal_m.has_value();
  if (!needs_course_) own_.reset();
  if (!own_ || query.start < own_->start) return nullptr;
  take_offer(query);
  delay_by_lag(query);
  if (!can_follow(query)) {
    lose_course(query);
    return nullptr;
  }
  needs_course_ = own_->continues && own_->end() - query.start < kContinue;
  conflict_ = find_conflict(query);
  if (conflict_) handle_conflict(query);
  return &*own_;
}

void CoursePlanner::lose_course(const Query& query) {
  own_.reset();  // others must not rely on it
  const bool is_same_place = losses_ > 0 && (query.at_start.position_m - lost_m_).norm() < kSamePlace_m;
  losses_ = is_same_place ? losses_ + 1 : 1;
  lost_m_ = query.at_start.position_m;
  // Something that courses do not know is in the way.
  if (losses_ > kMaxLosses) retry_at_ = query.start + std::min(kLost * (losses_ - kMaxLosses), kMaxLost);
}

void CoursePlanner::take_offer(const Query& query) {
  const CourseOffer* best = nullptr;
  const DrivingCourse* leader = nullptr;  // that made the best offer
  for (const CourseOffer* offer : query.around.offers) {
    const DrivingCourse& course = offer->course;
    if (course.robot != robot_ || offer->replaces != own_->planned_at || course.start > query.start) continue;
    const auto by = std::ranges::find(query.around.others, offer->by,
                                      [](const DrivingCourse* other) { return other->robot; });
    const bool is_leader = by != query.around.others.end() && precedes(**by, *own_) &&
                           course.end() - own_->end() <= kMaxOfferedDelay;
    if (!is_leader) continue;
    const double deviation_m = (course.state_at(query.start).position_m - query.at_start.position_m).norm();
    const Vec2 goal_m = own_->continues ? own_->goal_m() : target_m_;
    const bool fits = (course.goal_m() - goal_m).norm() <= kSameTarget_m &&
                      course.continues == own_->continues && deviation_m <= kMaxDeviation_m;
    if (!fits || (best && !precedes(**by, *leader))) continue;
    best = offer;
    leader = *by;
  }
  if (!best) return;
  own_ = best->course;
  own_->planned_at = query.start;  // two robots may have planned theirs at the same time
  last_planned_at_ = query.start;
  own_->due = *due_;
  delay_ = {};
}

void CoursePlanner::delay_by_lag(const Query& query) {
  const auto squared_error = [&](Duration delay) {
    const State expected = own_->state_at(query.start - delay);
    const Vec2 velocity_error = expected.velocity_mps - query.at_start.velocity_mps;
    return (expected.position_m - query.at_start.position_m).squaredNorm() +
           kVelocityWeight_s * kVelocityWeight_s * velocity_error.squaredNorm();
  };
  Duration best{0};
  double least = squared_error(best) - kNegligibleLag_m * kNegligibleLag_m;
  const Duration longest = std::min(kMaxDelayPerCycle, query.start - own_->start);
  for (Duration delay = kDelayStep; least > 0 && delay <= longest; delay += kDelayStep) {
    const double error = squared_error(delay);
    if (error >= least) continue;
    least = error;
    best = delay;
  }
  own_->start += best;
  delay_ += best;
}

bool CoursePlanner::can_follow(const Query& query) const {
  const bool misses_target = !own_->continues && (own_->goal_m() - target_m_).norm() > kSameTarget_m;
  return !misses_target && delay_ <= kMaxDelay &&
         (own_->state_at(query.start).position_m - query.at_start.position_m).norm() <= kMaxDeviation_m;
}

bool CoursePlanner::is_settled(const Query& query, const DrivingCourse& course) {
  return std::ranges::none_of(query.around.others, [&](const DrivingCourse* other) {
    return other->robot != course.robot && precedes(*other, course) &&
           conflicts_.first_after(*other, course, query.start);
  });
}

std::optional<Time> CoursePlanner::find_conflict(const Query& query) {
  std::optional<Time> earliest;
  for (const DrivingCourse* other : query.around.others) {
    if (!precedes(*other, *own_)) continue;
    const std::optional<Time> first = conflicts_.first_after(*other, *own_, query.start);
    if (!first || *first - query.start > kHorizon || (earliest && *first >= *earliest)) continue;
    // A course that will change itself is no reason to change this one, unless it comes close soon.
    if (*first - query.start <= kNear || is_settled(query, *other)) earliest = first;
  }
  const Time end = std::min({own_->end(), query.start + kHorizon, earliest.value_or(Time::max())});
  for (Time t = query.start; t < end && !query.around.staying_m.empty(); t += DrivingCourse::kSample) {
    const Vec2 at_m = own_->position_at(t);
    const auto is_near = [&](const Vec2& place_m) {
      return (place_m - at_m).squaredNorm() < separation_m_ * separation_m_;
    };
    if (std::ranges::any_of(query.around.staying_m, is_near)) return t;
  }
  return earliest;
}

void CoursePlanner::handle_conflict(const Query& query) {
  if (query.start - waiting_since_ > kNewConflict) waiting_since_ = query.start;
  const bool led = is_led(query);
  const bool waits = query.start - waiting_since_ < (led ? kMaxWait : kWait);
  const bool is_near = *conflict_ - query.start <= kNear;
  brakes_ = waits && is_near && led;
  needs_course_ = needs_course_ || !waits || (is_near && !brakes_);
}

bool CoursePlanner::is_led(const Query& query) const {
  return std::ranges::any_of(query.around.offers, [&](const CourseOffer* offer) {
    const Time made_at = offer->course.start - CourseLeader::kOfferLead;
    if (std::chrono::abs(query.start - made_at) > CourseLeader::kRecent) return false;
    const auto leader = std::ranges::find(query.around.others, offer->by,
                                          [](const DrivingCourse* course) { return course->robot; });
    return leader != query.around.others.end() && precedes(**leader, *own_);
  });
}

bool CoursePlanner::drives_straight(const Query& query) const {
  const Vec2 at_m = query.at_start.position_m, way_m = target_m_ - at_m;
  if ((own_->goal_m() - target_m_).norm() > kSameTarget_m) return false;
  const double alone_s = time_alone_s(way_m, query.at_start.velocity_mps, query.limits);
  if (to_seconds(own_->end() - query.start) > alone_s + kStraight_s) return false;
  for (Time t = query.start; t < own_->end(); t += DrivingCourse::kSample) {
    const Vec2 passed_m = own_->position_at(t) - at_m;
    const double cross = passed_m.x() * way_m.y() - passed_m.y() * way_m.x();
    if (std::abs(cross) > kStraight_m * way_m.norm()) return false;
  }
  return true;
}

Vec2 CoursePlanner::acceleration_mps2(const Query& query, Duration hold) const {
  const State& at = query.at_start;
  if (brakes_) return -at.velocity_mps / to_seconds(hold);
  // Trapezoidal motion ends exactly at the target.
  if (drives_straight(query))
    return desired_acceleration(target_m_ - at.position_m, at.velocity_mps, query.limits, hold, hold)
        .acceleration_mps2;
  const State from = own_->state_at(query.start), to = own_->state_at(query.start + hold);
  const double frequency_radps = std::min(kFrequency_radps, kFrequencyTimesHold_rad / to_seconds(hold));
  return (to.velocity_mps - from.velocity_mps) / to_seconds(hold) +
         2 * frequency_radps * (from.velocity_mps - at.velocity_mps) +
         frequency_radps * frequency_radps * (from.position_m - at.position_m);
}

void CoursePlanner::plan(const Query& query, Rng& rng) {
  offers_ = {};
  if (!due_ || !query.goal_m) return;
  // A time in the future was recorded before the clock was set back.
  const double passed_s = to_seconds(std::chrono::abs(query.start - effort_at_));
  effort_ = std::min(kMaxEffort, effort_ + kEffort_perS * passed_s);
  effort_at_ = query.start;
  last_effort_ = 0;
  if (effort_ <= 0) {
    if (needs_course_) keep_while_free(query);
    return;
  }
  const std::size_t before = search_.effort();
  plan_within_effort(query, rng);
  last_effort_ = static_cast<double>(search_.effort() - before);
  effort_ -= last_effort_;
}

void CoursePlanner::charge(Duration taken) {
  const double more = kEffortOfSecond * to_seconds(taken) - last_effort_;
  if (more > 0) effort_ = std::min(effort_, std::max(-kMaxDebt, effort_ - more));
}

void CoursePlanner::plan_within_effort(const Query& query, Rng& rng) {
  if (needs_course_) {
    if (query.start >= retry_at_) plan_own(query, rng);
    return;
  }
  // What is not necessary must leave enough effort for what is.
  if (effort_ < kReserve) return;
  const CourseSurroundings& around = query.around;
  if (query.start - own_->planned_at > kKnown && !is_led(query))
    offers_ = leader_.plan(
        {query.start, *own_, around.others, around.leaving_m, around.staying_m, query.limits}, rng);
  if (offers_.empty() && !conflict_ && query.start > own_->start) improve(query, rng);
}

std::optional<DrivingCourse> CoursePlanner::find_course(const Query& query, std::optional<Time> before,
                                                        Rng& rng) {
  CourseObstruction obstruction(query.start);
  obstruction.add_staying(query.around.staying_m);
  obstruction.add_leaving(query.around.leaving_m);
  // Robots that go later will avoid this one, even if they have planned before.
  const DueRobot self{robot_, *due_};
  for (const DrivingCourse* other : query.around.others) {
    if (goes_first(self, {other->robot, other->due}) && other->end() > query.start)
      obstruction.add_leaving(other->position_at(query.start));
    else
      obstruction.add(*other);
  }
  CourseTask task{robot_, query.at_start, query.target_m, query.limits, before};
  std::optional<DrivingCourse> course = search_.find_straight(task, obstruction);
  if (!course) {
    task.goal_m = *query.goal_m;
    course = search_.find(task, obstruction, rng);
    if (course) course->continues = *query.goal_m != query.target_m;
  }
  if (course) course->due = *due_;
  return course;
}

void CoursePlanner::plan_own(const Query& query, Rng& rng) {
  if (std::optional<DrivingCourse> course = find_course(query, std::nullopt, rng)) {
    set_course(*std::move(course));
    retry_ = kRetry;
    return;
  }
  const bool keeps = keep_while_free(query);
  retry_at_ = query.start + (keeps ? kRetryWithCourse : retry_);
  if (!keeps) retry_ = std::min(2 * retry_, kMaxRetry);
}

bool CoursePlanner::keep_while_free(const Query& query) {
  // The others may change their courses.
  const bool keeps = own_ && can_follow(query) &&
                     std::min(conflict_.value_or(own_->end()), own_->end()) - query.start > kFree;
  if (!keeps) own_.reset();
  return keeps;
}

void CoursePlanner::improve(const Query& query, Rng& rng) {
  if (query.start < improve_at_) return;
  improve_at_ = query.start + from_seconds(improve_s_ * rng.uniform(0.5, 1.5));
  const double alone_s =
      time_alone_s(target_m_ - query.at_start.position_m, query.at_start.velocity_mps, query.limits);
  const double left_s = to_seconds(own_->end() - query.start);
  if (own_->continues || left_s < alone_s + kLate_s || left_s < kWorthwhile_s) return;
  std::optional<DrivingCourse> course = find_course(query, own_->end() - kFaster, rng);
  if (!course || course->continues) {
    improve_s_ = std::min(2 * improve_s_, kMaxImprove_s);
    return;
  }
  set_course(*std::move(course));
  improve_s_ = kImprove_s;
}

void CoursePlanner::set_course(DrivingCourse course) {
  own_ = std::move(course);
  // The same start may have been planned for before.
  own_->planned_at = std::max(own_->planned_at, last_planned_at_ + Duration{1});
  last_planned_at_ = own_->planned_at;
  delay_ = {};
}

}  // namespace sidestep
