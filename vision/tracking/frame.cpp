// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/frame.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/coordinate_bound.hpp"
#include "common/protocol/obstacle_bounds.hpp"

namespace sidestep {
namespace {

constexpr double kMaxObstacle_m = 10;
constexpr double kMaxHeading_rad = 7;  // a full turn either way: no sender exceeds it
constexpr Duration kMaxAge{500'000'000};

// Comparisons with NaN are false, so both functions reject NaN.
bool is_within(double value, double bound) { return std::abs(value) <= bound; }
bool is_probability(double value) { return value >= 0 && value <= 1; }
bool is_completeness(double value) { return value >= 0 && value <= kCompleteEverywhere_m; }

bool is_valid(const msg::RobotDetection& d) {
  return d.robot() < kMaxRobots && is_within(d.x_m(), kMaxCoordinate_m) &&
         is_within(d.y_m(), kMaxCoordinate_m) && is_within(d.heading_rad(), kMaxHeading_rad) &&
         is_probability(d.confidence());
}

bool is_valid(const msg::BallDetection& d) {
  return is_within(d.x_m(), kMaxCoordinate_m) && is_within(d.y_m(), kMaxCoordinate_m) &&
         is_probability(d.confidence());
}

bool is_valid(const msg::ObstacleDetection& d) {
  return is_within(d.x_m(), kMaxCoordinate_m) && is_within(d.y_m(), kMaxCoordinate_m) && d.radius_m() > 0 &&
         d.radius_m() <= kMaxObstacle_m;
}

}  // namespace

bool is_timely(std::int64_t captured_at_ns, Time now, Duration max_lead) {
  return captured_at_ns >= to_ns(now - kMaxAge) && captured_at_ns <= to_ns(now + max_lead);
}

void Frame::clear(const msg::DetectionFrame& message) {
  camera_ = message.camera();
  captured_at_ = time_from_ns(message.captured_at_ns());
  problem_ = FrameProblem::kNone;
  robot_count_ = ball_count_ = obstacle_count_ = 0;
  obstacles_complete_within_m_ = 0;
  rejected_ = 0;
}

void Frame::assign(const msg::DetectionFrame& message, Time now, Duration max_lead,
                   Duration date_uncertainty) {
  clear(message);
  date_uncertainty_ = date_uncertainty;
  if (!is_timely(message.captured_at_ns(), now, max_lead))
    problem_ = FrameProblem::kTime;
  else if (message.ball_count() > msg::MAX_DETECTED_BALLS || message.obstacle_count() > msg::MAX_OBSTACLES ||
           !is_completeness(message.obstacles_complete_within_m()) || message.robots().size() > kMaxRobots)
    problem_ = FrameProblem::kMalformed;
  if (!is_usable()) {
    rejected_ = std::max<std::uint64_t>(1, message.robots().size());
    return;
  }
  obstacles_complete_within_m_ = message.obstacles_complete_within_m();
  for (const auto& d : message.robots()) {
    if (is_valid(d)) {
      robots_[robot_count_++] = {d.robot(), {d.x_m(), d.y_m()}, wrapped_rad(d.heading_rad())};
    } else {
      ++rejected_;
    }
  }
  for (std::size_t i = 0; i < message.ball_count(); ++i) {
    const auto& d = message.balls()[i];
    if (is_valid(d)) {
      balls_[ball_count_++] = {d.x_m(), d.y_m()};
    } else {
      ++rejected_;
    }
  }
  for (std::size_t i = 0; i < message.obstacle_count(); ++i) {
    const auto& d = message.obstacles()[i];
    if (is_valid(d)) {
      obstacles_[obstacle_count_++] = {{d.x_m(), d.y_m()}, d.radius_m()};
    } else {
      ++rejected_;
      obstacles_complete_within_m_ = 0;
    }
  }
}

void Frame::translate(const Vec2& by_m) {
  for (std::size_t i = 0; i < robot_count_; ++i) robots_[i].position_m += by_m;
  for (std::size_t i = 0; i < ball_count_; ++i) balls_[i] += by_m;
  for (std::size_t i = 0; i < obstacle_count_; ++i) obstacles_[i].position_m += by_m;
}

}  // namespace sidestep
