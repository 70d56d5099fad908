// SPDX-License-Identifier: Apache-2.0
#include "agents/perception/sight_border.hpp"

#include <limits>
#include <numbers>

namespace sidestep {
namespace {

constexpr double kInside_m = 1e-9;    // larger than rounding errors
constexpr double kShortest_m = 1e-9;  // minimum length of frontiers
/// Two rays that form a larger angle prove nothing about the space between them.
constexpr double kHalfTurn_rad = std::numbers::pi - 1e-6;

}  // namespace

void SightBorder::build(std::span<const SightRay> rays, const Vec2& at, double radius_m,
                        double min_contact_m) {
  at_m_ = at;
  wedges_.clear();
  frontiers_.clear();
  closed_.clear();
  if (rays.empty()) {
    frontiers_.push_back({{at, at}, 0});
    return;
  }
  first_direction_ = rays.front().direction;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const SightRay &ray = rays[i], &next = rays[(i + 1) % rays.size()];
    const std::optional<ClosedGap> gap = closed_gap(ray, next, radius_m);
    wedges_.push_back(gap ? closed_wedge(ray, next, *gap, min_contact_m) : open_wedge(ray, next, radius_m));
    wedges_.back().angle_rad = ray.angle_rad - rays.front().angle_rad;
  }
}

SightBorder::Wedge SightBorder::closed_wedge(const SightRay& ray, const SightRay& next, const ClosedGap& gap,
                                             double min_contact_m) {
  const double bulge_m = gap.reach_m < min_contact_m ? 0 : gap.bulge_m;
  closed_.push_back({{at_m_ + gap.posts.from_m, at_m_ + gap.posts.to_m}, bulge_m});
  const Vec2 from = ray.free_m * ray.direction, to = next.free_m * next.direction;
  const Vec2 normal = left_of(from - to).normalized();
  return {0, normal, normal.dot(from) - gap.unseen_bulge_m};
}

SightBorder::Wedge SightBorder::open_wedge(const SightRay& ray, const SightRay& next, double radius_m) {
  const double angle_rad = angle_between_rad(ray, next);
  const double sine = std::sin(angle_rad / 2), cosine = std::cos(angle_rad / 2);
  // The floor was seen up to this distance along both rays, minus the bulge.
  double cut_m = 0, bulge_m = 0, height_m = -std::numeric_limits<double>::infinity();
  if (angle_rad < kHalfTurn_rad) {
    cut_m = std::min(ray.free_m, next.free_m);
    if (cut_m * sine >= radius_m * cosine)
      cut_m = radius_m * (1 / sine - 1) / cosine;
    else
      bulge_m = sagitta_m(radius_m, 2 * cut_m * sine);
    height_m = cut_m * cosine - bulge_m;
  }
  add_frontier(ray.free_m * ray.direction, cut_m * ray.direction, 0);
  add_frontier(cut_m * ray.direction, cut_m * next.direction, bulge_m);
  add_frontier(cut_m * next.direction, next.free_m * next.direction, 0);
  return {0, rotated(ray.direction, angle_rad / 2), height_m};
}

void SightBorder::add_frontier(const Vec2& from, const Vec2& to, double bulge_m) {
  if ((to - from).squaredNorm() > kShortest_m * kShortest_m)
    frontiers_.push_back({{at_m_ + from, at_m_ + to}, bulge_m});
}

bool SightBorder::contains(const Vec2& p) const {
  if (wedges_.empty() || !p.allFinite()) return false;
  const Vec2 offset = p - at_m_;
  double angle_rad = std::atan2(cross(first_direction_, offset), first_direction_.dot(offset));
  if (angle_rad < 0) angle_rad += 2 * std::numbers::pi;
  const auto after = std::ranges::upper_bound(wedges_, angle_rad, {}, &Wedge::angle_rad);
  const Wedge& wedge = after == wedges_.begin() ? *after : *(after - 1);
  return wedge.normal.dot(offset) < wedge.height_m - kInside_m;
}

}  // namespace sidestep
