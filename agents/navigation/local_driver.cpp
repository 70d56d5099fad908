// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/local_driver.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace sidestep {
namespace {

// On a polyline or band, the robot steers to the point at the first of these distances that it can reach in a
// straight line.
constexpr std::array<double, 4> kLookAhead_m{0.8, 0.4, 0.2, 0.1};
/// Nearer to the goal than this, a window's grid of velocities is too coarse.
constexpr double kFinalApproach_m = 0.25;
constexpr std::size_t kRays = 64;     ///< number of rays along which the window sees the nearest obstacles
constexpr double kRay_m = 1.6;        ///< length of the rays
constexpr double kReaction_s = 0.35;  ///< velocities that can be reached in this time are considered
constexpr double kMinProgress_mps = 0.3;  ///< minimum speed towards the target of a useful velocity
constexpr std::size_t kMaxPreferred = 4;  ///< velocities offered besides the best one
// A band is restarted if it is longer than this factor times the path's length plus this length.
constexpr double kMaxDetour = 1.2, kMaxDetour_m = 0.3;
constexpr double kBand_m = 10;  ///< only the beginning of a longer path becomes a band
/// On a path chosen by a planner, the heading matters most. The table would only round times down.
constexpr DiscWindowSettings kDrivingWindow{.method = CollisionMethod::kExact,
                                            .weights = {.distance = 0.2, .heading = 0.5, .speed = 0.3}};
/// Turns right around obstacles ahead: robots that meet must not push each other back and forth.
constexpr PotentialFieldSettings kDrivingField{.reach_m = 0.4, .rotation = 0.6};

// Paths may touch the obstacles that they lead around.
constexpr double kTolerance_m = 0.002;
// The end of a band is on the path if it is within this distance.
constexpr double kOnPath_m = 1e-6;

double length_m(const Vec2& from_m, std::span<const Vec2> path_m) {
  double length = 0;
  Vec2 last = from_m;
  for (const Vec2& point : path_m) {
    length += (point - last).norm();
    last = point;
  }
  return length;
}

}  // namespace

LocalDriver::LocalDriver(const LocalMethods& methods, const Field& field, double radius_m,
                         double separation_m, const MotionLimits& limits)
    : methods_(methods),
      field_(field),
      radius_m_(radius_m),
      separation_m_(separation_m - kTolerance_m),
      band_(separation_m - kTolerance_m),
      field_force_(separation_m - kTolerance_m, kDrivingField),
      max_speed_mps_(limits.speed_mps) {
  if (methods.uses_window) window_.emplace(separation_m - kTolerance_m, limits, kDrivingWindow);
  points_m_.reserve(kRays + 1);
  preferred_mps_.reserve(kMaxPreferred);
}

std::span<const Bubble> LocalDriver::bubbles() const {
  return methods_.uses_band && !band_.is_broken() ? band_.bubbles() : std::span<const Bubble>();
}

LocalChoice LocalDriver::choose(const LocalQuery& query) {
  if (methods_.uses_band) update_band(query);
  LocalChoice choice{methods_.ignores_path ? query.path_m.back() : target_m(query)};
  const double length = length_m(query.at.position_m, query.path_m);
  if (length <= kFinalApproach_m) return choice;
  if (window_) choose_velocity(query, length, choice);
  if (methods_.uses_field) follow_force(query, choice);
  return choice;
}

double LocalDriver::distance_m(const LocalQuery& query, const Vec2& at) const {
  // The robot's centre only keeps its radius from the border.
  const double beyond_m = separation_m_ - radius_m_;
  const double border_m =
      beyond_m + std::min(field_.length_m / 2 - std::abs(at.x()), field_.width_m / 2 - std::abs(at.y()));
  double distance = std::min(border_m, query.world->nearest(at).distance_m);
  for (const Circle& other : query.others)
    distance = std::min(distance, (at - other.centre_m).norm() - other.radius_m);
  return distance;
}

bool LocalDriver::is_line_free(const LocalQuery& query, const Vec2& to) const {
  constexpr double kStep_m = 0.01;
  const Vec2 from = query.at.position_m;
  const double length = (to - from).norm();
  const Vec2 direction = (to - from).stableNormalized();
  for (double at = 0; at < length;) {
    const double spare_m = distance_m(query, from + at * direction) - separation_m_;
    if (spare_m < 0) return false;
    at += std::max(kStep_m, spare_m);
  }
  return distance_m(query, to) >= separation_m_;
}

void LocalDriver::update_band(const LocalQuery& query) {
  const auto distance = [&](const Vec2& at) { return distance_m(query, at); };
  const DistanceFunction free(distance);
  if (fits_path(query)) {
    band_.update(query.at.position_m, free);
    if (!band_.is_broken()) return;
  }
  path_m_.assign(1, query.at.position_m);
  double length = 0;
  for (const Vec2& next : query.path_m) {
    const Vec2 leg = next - path_m_.back();
    const double left_m = kBand_m - length;
    if (leg.norm() > left_m) {
      path_m_.emplace_back(path_m_.back() + left_m * leg.stableNormalized());
      break;
    }
    length += leg.norm();
    path_m_.push_back(next);
  }
  band_.start(path_m_, free);
}

bool LocalDriver::fits_path(const LocalQuery& query) const {
  const std::span<const Bubble> bubbles = band_.bubbles();
  if (bubbles.empty() || band_.is_broken()) return false;
  const Vec2 end = bubbles.back().centre_m;
  if (end != query.path_m.back() && band_.length_m() < kBand_m / 2) return false;
  double length = 0;
  Vec2 last = query.at.position_m;
  for (const Vec2& next : query.path_m) {
    if (squared_distance(end, Segment{last, next}) < kOnPath_m * kOnPath_m) {
      length += (end - last).norm();
      return band_.length_m() <= kMaxDetour * length + kMaxDetour_m;
    }
    length += (next - last).norm();
    last = next;
  }
  return false;
}

Vec2 LocalDriver::target_m(const LocalQuery& query) const {
  if (bubbles().empty()) return query.path_m.front();
  for (const double ahead_m : kLookAhead_m) {
    const Vec2 target = band_.position_m(ahead_m);
    if (is_line_free(query, target)) return target;
  }
  return band_.position_m(kLookAhead_m.back());
}

void LocalDriver::cast_rays(const LocalQuery& query) {
  constexpr double kHit_m = 0.005;
  points_m_.clear();
  for (std::size_t i = 0; i < kRays; ++i) {
    const double angle_rad = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(kRays);
    const Vec2 direction(std::cos(angle_rad), std::sin(angle_rad));
    double along_m = 0;
    while (along_m < kRay_m) {
      const double distance = distance_m(query, query.at.position_m + along_m * direction);
      if (distance < kHit_m) break;
      along_m += distance;
    }
    if (along_m < kRay_m) points_m_.emplace_back(along_m * direction);
  }
}

void LocalDriver::choose_velocity(const LocalQuery& query, double length, LocalChoice& choice) {
  cast_rays(query);
  const Vec2 direction = (choice.target_m - query.at.position_m).stableNormalized();
  const DiscWindowChoice& found = window_->choose({.points_m = points_m_,
                                                   .velocity_mps = query.at.velocity_mps,
                                                   .goal_m = length * direction,
                                                   .cycle_s = query.cycle_s,
                                                   .window_s = kReaction_s});
  if (found.admissible.empty()) return;
  const Vec2& best = found.admissible.front().velocity_mps;
  if (best.dot(direction) < kMinProgress_mps) return;
  choice.velocity_mps = best;
  preferred_mps_.clear();
  for (std::size_t i = 1; i < found.admissible.size() && i <= kMaxPreferred; ++i)
    preferred_mps_.push_back(found.admissible[i].velocity_mps);
  choice.preferred_mps = preferred_mps_;
}

void LocalDriver::follow_force(const LocalQuery& query, LocalChoice& choice) const {
  const DistanceFunction free([&](const Vec2& at) { return distance_m(query, at); });
  const Vec2& at = query.at.position_m;
  const FreeDistance nearest = free(at, 0);
  if (nearest.distance_m <= separation_m_) return;
  const Vec2 force = field_force_.force(at, choice.target_m, nearest);
  const Vec2 velocity = max_speed_mps_ * force.stableNormalized();
  if (velocity.dot((choice.target_m - at).stableNormalized()) < kMinProgress_mps) return;
  choice.velocity_mps = velocity;
}

}  // namespace sidestep
