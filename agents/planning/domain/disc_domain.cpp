// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/domain/disc_domain.hpp"

#include <algorithm>

#include "agents/planning/domain/free_positions.hpp"

namespace sidestep {
namespace {

/// Uniformly distributed unit vector (Marsaglia 1972).
Vec2 random_direction(Rng& rng) {
  for (;;) {
    const double x = rng.uniform(-1, 1), y = rng.uniform(-1, 1), length2 = x * x + y * y;
    if (length2 > 1 || length2 < 1e-6) continue;
    const double scale = 1 / std::sqrt(length2);
    return {x * scale, y * scale};
  }
}

/// Samples one of three positions at distance `offset_m` from a corner: perpendicular to either adjacent
/// edge, or between these two. `in_along` and `out_along` are the unit directions of the incoming and the
/// outgoing edge, counter-clockwise.
Vec2 sample_near_corner(const Vec2& corner, const Vec2& in_along, const Vec2& out_along, double offset_m,
                        Rng& rng) {
  const Vec2 first = -left_of(in_along), last = -left_of(out_along);
  const auto which = rng.below(3);
  if (which == 0) return corner + offset_m * first;
  if (which == 1) return corner + offset_m * last;
  return corner + offset_m * (first + last).normalized();
}

Vec2 sample_near(const Circle& circle, double offset_m, Rng& rng) {
  return circle.centre_m + (circle.radius_m + offset_m) * random_direction(rng);
}

Vec2 sample_near(const Box& box, double offset_m, Rng& rng) {
  const auto which = rng.below(4);
  static const Vec2 kAlong[4] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}};
  const Vec2 corner(which == 1 || which == 2 ? box.max_m.x() : box.min_m.x(),
                    which >= 2 ? box.max_m.y() : box.min_m.y());
  return sample_near_corner(corner, kAlong[which], kAlong[(which + 1) % 4], offset_m, rng);
}

Vec2 sample_near(const ConvexPolygon& polygon, double offset_m, Rng& rng) {
  const std::size_t count = polygon.corners_m.size(), i = rng.below(count);
  const Vec2& corner = polygon.corners_m[i];
  const Vec2 in = corner - polygon.corners_m[(i + count - 1) % count];
  const Vec2 out = polygon.corners_m[(i + 1) % count] - corner;
  return sample_near_corner(corner, in.normalized(), out.normalized(), offset_m, rng);
}

Vec2 sample_near(const Segment& segment, double offset_m, Rng& rng) {
  const Vec2 along = segment.to_m - segment.from_m;
  const double length = along.norm();
  if (length == 0) return segment.from_m + offset_m * random_direction(rng);
  const bool at_end = rng.chance(0.5);
  const Vec2 outwards = (at_end ? 1 : -1) / length * along;
  const Vec2& end = at_end ? segment.to_m : segment.from_m;
  const auto which = rng.below(3);
  if (which == 0) return end + offset_m * outwards;
  return end + offset_m * (which == 1 ? left_of(outwards) : Vec2(-left_of(outwards)));
}

}  // namespace

DiscDomain::DiscDomain(const ObstacleWorld& world, const Field& field, double radius_m, const Vec2& start_m,
                       const Vec2& goal_m, const DiscDomainSettings& settings)
    : world_(&world),
      field_(field),
      radius_m_(radius_m),
      start_m_(start_m),
      requested_goal_m_(goal_m),
      goal_m_(goal_m),
      start_is_blocked_(!is_free(start_m)),
      goal_is_blocked_(!is_free(goal_m)),
      settings_(settings) {
  measure_from_start();
  if (!goal_is_blocked_) return;
  if (const std::optional<Vec2> projected = projected_out(goal_m)) {
    goal_m_ = *projected;
    return;
  }
  if (const std::optional<Vec2> nearest = free_position_near(goal_m)) goal_m_ = *nearest;
}

DiscDomain::DiscDomain(WithoutGoal, const ObstacleWorld& world, const Field& field, double radius_m,
                       const Vec2& start_m, const DiscDomainSettings& settings)
    : world_(&world),
      field_(field),
      radius_m_(radius_m),
      start_m_(start_m),
      requested_goal_m_(start_m),
      goal_m_(start_m),
      start_is_blocked_(!is_free(start_m)),
      goal_is_blocked_(start_is_blocked_),
      settings_(settings) {
  measure_from_start();
}

void DiscDomain::measure_from_start() {
  if (!start_is_blocked_) return;
  start_distances_m_.reserve(world_->size());
  for (std::size_t i = 0; i < world_->size(); ++i)
    start_distances_m_.push_back(signed_distance(start_m_, world_->shape(world_->obstacle(i))));
}

std::optional<Vec2> DiscDomain::projected_out(const Vec2& position) const {
  const Nearest nearest = world_->nearest(position);
  if (nearest.obstacle == kNoObstacle) return std::nullopt;
  // The disc must move at least this far to leave the deepest obstacle, so the projection, if free, is the
  // nearest free position.
  const Shape& shape = world_->shape(nearest.obstacle);
  constexpr double kStep_m = 1e-6, kClearance_m = 1e-6;
  const auto slope = [&](const Vec2& step) {
    return (signed_distance(position + step, shape) - signed_distance(position - step, shape)) /
           (2 * kStep_m);
  };
  const Vec2 away(slope({kStep_m, 0}), slope({0, kStep_m}));
  if (std::abs(away.norm() - 1) > 1e-3) return std::nullopt;
  const Vec2 projected = position + (radius_m_ + kClearance_m - nearest.distance_m) * away.normalized();
  return is_free(projected) ? std::optional(projected) : std::nullopt;
}

std::optional<Vec2> DiscDomain::extend(const Vec2& from, const Vec2& to) const {
  const double x = field_.length_m / 2 - radius_m_, y = field_.width_m / 2 - radius_m_;
  Vec2 end(std::clamp(to.x(), -x, x), std::clamp(to.y(), -y, y));
  const double length = distance(from, end);
  if (length == 0) return std::nullopt;
  if (length > settings_.step_m) end = from + settings_.step_m / length * (end - from);
  if (!world_->touches(from, end, radius_m_)) return end;
  return start_is_blocked_ && is_escape(from, end) ? std::optional(end) : std::nullopt;
}

bool DiscDomain::is_escape(const Vec2& from, const Vec2& to) const {
  if (from == to) return false;
  return to == start_m_ ? escapes(to, from) : !is_free(from) && escapes(from, to);
}

bool DiscDomain::escapes(const Vec2& from, const Vec2& to) const {
  const double x = field_.length_m / 2 - radius_m_, y = field_.width_m / 2 - radius_m_;
  if (std::abs(to.x()) > std::max(x, std::abs(from.x())) ||
      std::abs(to.y()) > std::max(y, std::abs(from.y())))
    return false;
  constexpr double kStep_m = 1e-6, kRounding_m = 1e-12;
  const double length_m = distance(from, to), reach_m = radius_m_ + length_m + kStep_m;
  const Vec2 step = kStep_m / length_m * (to - from);
  const bool is_start = from == start_m_ && start_is_blocked_;
  for (std::size_t i = 0; i < world_->size(); ++i) {
    const Shape& shape = world_->shape(world_->obstacle(i));
    const double from_m = is_start ? start_distances_m_[i] : signed_distance(from, shape);
    if (from_m > reach_m) continue;
    if (from_m > radius_m_) {
      if (squared_distance(Segment{from, to}, shape) <= radius_m_ * radius_m_) return false;
    } else if (signed_distance(from + step, shape) < from_m - kRounding_m) {
      // Along a line, the distance from a convex shape is a convex function: if it does not decrease at
      // first, it never does.
      return false;
    }
  }
  return true;
}

std::optional<Vec2> DiscDomain::exit() const {
  if (const std::optional<Vec2> projected = projected_out(start_m_);
      projected && escapes(start_m_, *projected))
    return projected;
  return free_position_near(start_m_, [&](const Vec2& position) { return escapes(start_m_, position); });
}

std::optional<Vec2> DiscDomain::free_position_near(const Vec2& position,
                                                   const std::function<bool(const Vec2&)>& can_reach) const {
  return nearest_free_position(
      position, radius_m_ / 8, std::hypot(field_.length_m, field_.width_m),
      [&](const Vec2& other) { return is_free(other); }, can_reach);
}

std::vector<Vec2> DiscDomain::free_positions_near_goal() const {
  return free_positions_near(requested_goal_m_, radius_m_ / 8, std::hypot(field_.length_m, field_.width_m),
                             [&](const Vec2& position) { return is_free(position); });
}

DiscDomain DiscDomain::with_goal_at(const Vec2& position) const {
  DiscDomain domain = *this;
  domain.goal_m_ = position;
  return domain;
}

Vec2 DiscDomain::sample(Rng& rng) const {
  if (world_->size() > 0 && rng.chance(settings_.contact_probability)) return sample_contact(rng);
  return sample_uniform(rng);
}

Vec2 DiscDomain::sample_uniform(Rng& rng) const {
  const double x = field_.length_m / 2 - radius_m_, y = field_.width_m / 2 - radius_m_;
  return {rng.uniform(-x, x), rng.uniform(-y, y)};
}

Vec2 DiscDomain::sample_contact(Rng& rng) const {
  const Shape& shape = world_->shape(world_->obstacle(rng.below(world_->size())));
  // Most samples are almost in contact; some have clearance.
  const double fraction = rng.uniform(),
               offset_m = radius_m_ * (1 + 1e-6 + 0.5 * fraction * fraction * fraction);
  return std::visit([&](const auto& obstacle) { return sample_near(obstacle, offset_m, rng); }, shape);
}

}  // namespace sidestep
