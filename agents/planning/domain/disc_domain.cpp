// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/domain/disc_domain.hpp"

#include <algorithm>

#include "agents/planning/domain/free_places.hpp"

namespace sidestep {
namespace {

/// Of length 1, in any direction (Marsaglia 1972).
Vec2 random_direction(Rng& rng) {
  for (;;) {
    const double x = rng.uniform(-1, 1), y = rng.uniform(-1, 1), length2 = x * x + y * y;
    if (length2 > 1 || length2 < 1e-6) continue;
    const double scale = 1 / std::sqrt(length2);
    return {x * scale, y * scale};
  }
}

/// A place beside a corner between two edges that leave it along `out_along` and came in along `in_along`,
/// both of length 1 and counter-clockwise: beside its end of one of the edges, or between.
Vec2 beside_corner(const Vec2& corner, const Vec2& in_along, const Vec2& out_along, double off_m, Rng& rng) {
  const Vec2 first = -left_of(in_along), last = -left_of(out_along);
  const auto which = rng.below(3);
  if (which == 0) return corner + off_m * first;
  if (which == 1) return corner + off_m * last;
  return corner + off_m * (first + last).normalized();
}

Vec2 beside(const Circle& circle, double off_m, Rng& rng) {
  return circle.centre_m + (circle.radius_m + off_m) * random_direction(rng);
}

Vec2 beside(const Box& box, double off_m, Rng& rng) {
  const auto which = rng.below(4);
  static const Vec2 kAlong[4] = {{0, -1}, {1, 0}, {0, 1}, {-1, 0}};
  const Vec2 corner(which == 1 || which == 2 ? box.max_m.x() : box.min_m.x(),
                    which >= 2 ? box.max_m.y() : box.min_m.y());
  return beside_corner(corner, kAlong[which], kAlong[(which + 1) % 4], off_m, rng);
}

Vec2 beside(const ConvexPolygon& polygon, double off_m, Rng& rng) {
  const std::size_t count = polygon.corners_m.size(), i = rng.below(count);
  const Vec2& corner = polygon.corners_m[i];
  const Vec2 in = corner - polygon.corners_m[(i + count - 1) % count];
  const Vec2 out = polygon.corners_m[(i + 1) % count] - corner;
  return beside_corner(corner, in.normalized(), out.normalized(), off_m, rng);
}

Vec2 beside(const Segment& segment, double off_m, Rng& rng) {
  const Vec2 along = segment.to_m - segment.from_m;
  const double length = along.norm();
  if (length == 0) return segment.from_m + off_m * random_direction(rng);
  const bool at_end = rng.chance(0.5);
  const Vec2 outwards = (at_end ? 1 : -1) / length * along;
  const Vec2& end = at_end ? segment.to_m : segment.from_m;
  const auto which = rng.below(3);
  if (which == 0) return end + off_m * outwards;
  return end + off_m * (which == 1 ? left_of(outwards) : Vec2(-left_of(outwards)));
}

}  // namespace

DiscDomain::DiscDomain(const ObstacleWorld& world, const Field& field, double radius_m, const Vec2& start_m,
                       const Vec2& goal_m, const DiscDomainSettings& settings)
    : world_(&world),
      field_(field),
      radius_m_(radius_m),
      start_m_(start_m),
      wanted_m_(goal_m),
      goal_m_(goal_m),
      start_is_blocked_(!is_free(start_m)),
      goal_is_blocked_(!is_free(goal_m)),
      settings_(settings) {
  if (!goal_is_blocked_) return;
  if (const std::optional<Vec2> out = pushed_out(goal_m)) {
    goal_m_ = *out;
    return;
  }
  const std::vector<Vec2> places = places_near_goal();
  if (!places.empty()) goal_m_ = places.front();
}

std::optional<Vec2> DiscDomain::pushed_out(const Vec2& place) const {
  const Nearest nearest = world_->nearest(place);
  if (nearest.obstacle == kNoObstacle) return std::nullopt;
  // Nothing that is free is nearer than what is touched most makes it.
  const Shape& shape = world_->shape(nearest.obstacle);
  constexpr double kStep_m = 1e-6, kRoom_m = 1e-6;
  const auto slope = [&](const Vec2& step) {
    return (signed_distance(place + step, shape) - signed_distance(place - step, shape)) / (2 * kStep_m);
  };
  const Vec2 away(slope({kStep_m, 0}), slope({0, kStep_m}));
  if (std::abs(away.norm() - 1) > 1e-3) return std::nullopt;
  const Vec2 out = place + (radius_m_ + kRoom_m - nearest.distance_m) * away.normalized();
  return is_free(out) ? std::optional(out) : std::nullopt;
}

std::optional<Vec2> DiscDomain::extend(const Vec2& from, const Vec2& to) const {
  const double x = field_.length_m / 2 - radius_m_, y = field_.width_m / 2 - radius_m_;
  Vec2 end(std::clamp(to.x(), -x, x), std::clamp(to.y(), -y, y));
  const double length = distance(from, end);
  if (length == 0) return std::nullopt;
  if (length > settings_.step_m) end = from + settings_.step_m / length * (end - from);
  if (!world_->touches(from, end, radius_m_)) return end;
  return start_is_blocked_ && leaves(from, end) ? std::optional(end) : std::nullopt;
}

bool DiscDomain::leaves(const Vec2& from, const Vec2& to) const {
  if (from == to) return false;
  return to == start_m_ ? leads_out(to, from) : !is_free(from) && leads_out(from, to);
}

bool DiscDomain::leads_out(const Vec2& from, const Vec2& to) const {
  const double x = field_.length_m / 2 - radius_m_, y = field_.width_m / 2 - radius_m_;
  if (std::abs(to.x()) > std::max(x, std::abs(from.x())) ||
      std::abs(to.y()) > std::max(y, std::abs(from.y())))
    return false;
  constexpr double kStep_m = 1e-6, kRounding_m = 1e-12;
  const Vec2 step = kStep_m / distance(from, to) * (to - from);
  for (std::size_t i = 0; i < world_->size(); ++i) {
    const Shape& shape = world_->shape(world_->obstacle(i));
    const double from_m = signed_distance(from, shape);
    if (from_m > radius_m_) {
      if (squared_distance(Segment{from, to}, shape) <= radius_m_ * radius_m_) return false;
    } else if (signed_distance(from + step, shape) < from_m - kRounding_m) {
      // The distance from what is convex is a convex function of the way: if it does not shrink at first, it
      // never does.
      return false;
    }
  }
  return true;
}

std::optional<Vec2> DiscDomain::exit() const {
  if (const std::optional<Vec2> out = pushed_out(start_m_); out && leads_out(start_m_, *out)) return out;
  const auto is_exit = [&](const Vec2& place) { return is_free(place) && leads_out(start_m_, place); };
  const std::vector<Vec2> places =
      free_places_near(start_m_, radius_m_ / 8, std::hypot(field_.length_m, field_.width_m), is_exit);
  return places.empty() ? std::nullopt : std::optional(places.front());
}

std::vector<Vec2> DiscDomain::places_near_goal() const {
  return free_places_near(wanted_m_, radius_m_ / 8, std::hypot(field_.length_m, field_.width_m),
                          [&](const Vec2& place) { return is_free(place); });
}

DiscDomain DiscDomain::with_goal_at(const Vec2& place) const {
  DiscDomain domain = *this;
  domain.goal_m_ = place;
  return domain;
}

Vec2 DiscDomain::sample(Rng& rng) const {
  if (world_->size() > 0 && rng.chance(settings_.contact_probability)) return sample_contact(rng);
  return sample_anywhere(rng);
}

Vec2 DiscDomain::sample_anywhere(Rng& rng) const {
  const double x = field_.length_m / 2 - radius_m_, y = field_.width_m / 2 - radius_m_;
  return {rng.uniform(-x, x), rng.uniform(-y, y)};
}

Vec2 DiscDomain::sample_contact(Rng& rng) const {
  const Shape& shape = world_->shape(world_->obstacle(rng.below(world_->size())));
  // Mostly as near as can be, sometimes with room.
  const double part = rng.uniform(), off_m = radius_m_ * (1 + 1e-6 + 0.5 * part * part * part);
  return std::visit([&](const auto& obstacle) { return beside(obstacle, off_m, rng); }, shape);
}

}  // namespace sidestep
