// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/course_codec.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>

#include "common/messaging/version_codec.hpp"
#include "common/protocol/senders.hpp"

namespace sidestep {
namespace {

static_assert(DrivingCourse::kMaxStates == msg::MAX_COURSE_POINTS);
/// Maximum distance between two points, one sample apart.
constexpr double kMaxStep_m = kMaxSpeed_mps * to_seconds(DrivingCourse::kSample);

/// False if a component is NaN.
bool is_bounded(const Vec2& v, double bound) { return std::abs(v.x()) <= bound && std::abs(v.y()) <= bound; }

bool is_plausible_ns(std::int64_t ns, Time now) { return is_plausible(time_from_ns(ns), now); }

/// Whether the robot's agent, or a coordinator that relays its message, may have sent a message.
bool is_from(RobotId robot, const msg::Header& header) {
  return header.sender() == robot || is_coordinator(header.sender());
}

State state_of(const msg::CoursePoint& point) {
  return {{point.x_m(), point.y_m()}, {point.vx_mps(), point.vy_mps()}};
}

bool is_drivable(const std::vector<State>& states) {
  const auto is_valid = [](const State& state) {
    return is_bounded(state.position_m, kMaxCoordinate_m) && is_bounded(state.velocity_mps, kMaxSpeed_mps);
  };
  const auto is_gap = [](const State& a, const State& b) {
    return !((b.position_m - a.position_m).norm() <= kMaxStep_m);
  };
  return std::ranges::all_of(states, is_valid) && states.back().velocity_mps == Vec2(0, 0) &&
         std::ranges::adjacent_find(states, is_gap) == states.end();
}

/// Decodes the part that courses and offers have in common. Does not check the sender.
template <typename Message>
std::optional<DrivingCourse> decode_course(const Message& message, Time now) {
  const bool is_valid = message.robot() < kMaxRobots && message.planned_at_ns() > 0 &&
                        is_plausible_ns(message.planned_at_ns(), now) &&
                        message.points().size() <= msg::MAX_COURSE_POINTS;
  if (!is_valid) return std::nullopt;
  std::optional<DrivingCourse> course(std::in_place);
  course->robot = message.robot();
  course->planned_at = time_from_ns(message.planned_at_ns());
  if (message.points().empty()) return course;
  if (!is_plausible_ns(message.due_ns(), now) || !is_plausible_ns(message.start_ns(), now))
    return std::nullopt;
  course->due = time_from_ns(message.due_ns());
  course->start = time_from_ns(message.start_ns());
  course->continues = message.continues();
  course->states.resize(message.points().size());
  std::ranges::transform(message.points(), course->states.begin(), state_of);
  return is_drivable(course->states) ? course : std::nullopt;
}

template <typename Message>
void encode_course(const DrivingCourse& course, Message& message) {
  assert(course.states.size() <= msg::MAX_COURSE_POINTS);
  message.robot(course.robot);
  message.planned_at_ns(to_ns(course.planned_at));
  message.due_ns(to_ns(course.due));
  message.start_ns(to_ns(course.start));
  message.continues(course.continues);
  message.points().resize(course.states.size());
  std::ranges::transform(course.states, message.points().begin(), [](const State& state) {
    msg::CoursePoint point;
    point.x_m(static_cast<float>(state.position_m.x()));
    point.y_m(static_cast<float>(state.position_m.y()));
    point.vx_mps(static_cast<float>(state.velocity_mps.x()));
    point.vy_mps(static_cast<float>(state.velocity_mps.y()));
    return point;
  });
}

}  // namespace

std::optional<DrivingCourse> decode(const msg::Course& message, Time now) {
  return is_from(message.robot(), message.header()) ? decode_course(message, now) : std::nullopt;
}

std::optional<CourseOffer> decode(const msg::CourseOffer& message, Time now) {
  const bool is_valid = message.by() < kMaxRobots && is_from(message.by(), message.header()) &&
                        is_plausible_ns(message.replaces_ns(), now) && !message.points().empty();
  if (!is_valid) return std::nullopt;
  auto course = decode_course(message, now);
  if (!course) return std::nullopt;
  return CourseOffer{*std::move(course), time_from_ns(message.replaces_ns()), message.by()};
}

msg::Course encode(const DrivingCourse& course) {
  msg::Course message;
  message.header().sender(course.robot);
  encode_course(course, message);
  return message;
}

msg::CourseOffer encode(const CourseOffer& offer) {
  msg::CourseOffer message;
  message.header().sender(offer.by);
  message.by(offer.by);
  message.replaces_ns(to_ns(offer.replaces));
  encode_course(offer.course, message);
  return message;
}

}  // namespace sidestep
