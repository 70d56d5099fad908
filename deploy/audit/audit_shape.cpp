// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/audit_shape.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

constexpr double kShortestStep_s = 0.00025;

}  // namespace

AuditShape::AuditShape(const Shape& shape) {
  const auto add = [this](double x, double y) { corners_.push_back({x, y}); };
  if (const auto* circle = std::get_if<Circle>(&shape)) {
    add(circle->centre_m.x(), circle->centre_m.y());
    radius_m_ = circle->radius_m;
  } else if (const auto* box = std::get_if<Box>(&shape)) {
    add(box->min_m.x(), box->min_m.y());
    add(box->max_m.x(), box->min_m.y());
    add(box->max_m.x(), box->max_m.y());
    add(box->min_m.x(), box->max_m.y());
  } else if (const auto* segment = std::get_if<Segment>(&shape)) {
    add(segment->from_m.x(), segment->from_m.y());
    add(segment->to_m.x(), segment->to_m.y());
  } else {
    for (const Vec2& corner : std::get<ConvexPolygon>(shape).corners_m) add(corner.x(), corner.y());
  }
}

double AuditShape::distance_m(double x, double y) const {
  double nearest = std::numeric_limits<double>::infinity();
  bool is_inside = corners_.size() > 2;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const Corner &a = corners_[i], &b = corners_[(i + 1) % corners_.size()];
    const double ex = b.x - a.x, ey = b.y - a.y, px = x - a.x, py = y - a.y;
    const double square = ex * ex + ey * ey;
    const double along = square > 0 ? std::min(1.0, std::max(0.0, (px * ex + py * ey) / square)) : 0;
    nearest = std::min(nearest, std::hypot(px - along * ex, py - along * ey));
    is_inside = is_inside && ex * py - ey * px >= 0;
  }
  return is_inside ? 0 : std::max(0.0, nearest - radius_m_);
}

ClosestApproach closest_approach(const AuditPath& path, const AuditShape& obstacle, double cutoff_m) {
  double best = std::numeric_limits<double>::infinity(), best_s = 0;
  const auto sample = [&](double s) {
    const AuditPath::Node p = path.at_s(s);
    const double d = obstacle.distance_m(p.x, p.y);
    if (d < best) best = d, best_s = s;
    return d;
  };
  const double end = path.duration_s(), speed = path.max_speed_mps() + 1e-9;
  // A step cannot skip a point nearer than the cutoff, unless it is the shortest step.
  for (double s = 0, d = sample(0); s < end; d = sample(s))
    s = std::min(end, s + std::max(kShortestStep_s, (d - cutoff_m) / speed));
  if (best < cutoff_m + speed * kShortestStep_s) {
    for (double step = kShortestStep_s / 16; step > 1e-8; step /= 16) {
      const double centre = best_s;
      for (int i = -16; i <= 16; ++i) sample(std::clamp(centre + i * step, 0.0, end));
    }
  }
  return {best, path.start_ns() + static_cast<std::int64_t>(best_s * 1e9)};
}

}  // namespace sidestep
