// SPDX-License-Identifier: Apache-2.0
#include "agents/perception/sight_rays.hpp"

#include <algorithm>
#include <numbers>

namespace sidestep {
namespace {

/// No rays are dropped between two rays that form a larger angle than this.
constexpr double kMaxAngle_rad = std::numbers::pi / 2;
/// Shorter gaps have no defined direction.
constexpr double kShortestGap_m = 1e-9;

/// For each ray in turn, calls `count_dropped(first)`, which returns how many of the following rays to drop.
/// Dropped rays are marked with the length 0, and removed at the end.
template <typename CountDropped>
void drop_runs(std::vector<SightRay>& rays, const CountDropped& count_dropped) {
  const std::size_t count = rays.size();
  for (std::size_t first = 0; first < count; ++first) {
    const std::size_t dropped = rays[first].free_m > 0 ? count_dropped(first) : 0;
    for (std::size_t i = 1; i <= dropped; ++i) rays[(first + i) % count].free_m = 0;
  }
  std::erase_if(rays, [](const SightRay& ray) { return ray.free_m == 0; });
}

/// Lower bound of the distance between the common origin of two rays of equal length and a disc that crosses
/// neither of them and lies beyond or between them.
double proven_m(double length_m, double angle_rad, double radius_m) {
  const double half_sine = std::sin(angle_rad / 2);
  if (length_m * half_sine >= radius_m) return radius_m / half_sine - radius_m;
  return length_m * std::cos(angle_rad / 2) - sagitta_m(radius_m, 2 * length_m * half_sine);
}

}  // namespace

double sagitta_m(double radius_m, double gap_m) {
  return radius_m - std::sqrt(std::max(0.0, radius_m * radius_m - gap_m * gap_m / 4));
}

double projection_m(double radius_m, double from_m) {
  return std::sqrt(2 * radius_m * sagitta_m(radius_m, 2 * from_m));
}

double angle_between_rad(const SightRay& ray, const SightRay& next) {
  const double angle_rad = next.angle_rad - ray.angle_rad;
  return angle_rad > 0 ? angle_rad : angle_rad + 2 * std::numbers::pi;
}

std::optional<ClosedGap> closed_gap(const SightRay& ray, const SightRay& next, double radius_m) {
  if (!ray.post_m || !next.post_m || angle_between_rad(ray, next) >= std::numbers::pi) return std::nullopt;
  const Vec2 &post = *ray.post_m, &next_post = *next.post_m;
  const Vec2 from = ray.free_m * ray.direction, to = next.free_m * next.direction;
  const double width_m = (to - from).norm();
  if (width_m >= 2 * radius_m || width_m < kShortestGap_m) return std::nullopt;
  // The point of the line that is equally far from both posts. A disc around a post that contains this point
  // and an end of the line also contains everything between the two.
  const double nearer_to_post = (from - next_post).squaredNorm() - (from - post).squaredNorm();
  const double nearer_to_next = (to - post).squaredNorm() - (to - next_post).squaredNorm();
  const double sum = nearer_to_post + nearer_to_next;
  const Vec2 middle = from + (sum > 0 ? std::clamp(nearer_to_post / sum, 0.0, 1.0) : 0.5) * (to - from);
  const double error_m = std::max(ray.post_error_m, next.post_error_m);
  const double ends_m = std::max((from - post).norm(), (to - next_post).norm()) + error_m;
  const double farthest_m =
      std::max({ends_m, (middle - post).norm() + error_m, (middle - next_post).norm() + error_m});
  if (farthest_m >= radius_m) return std::nullopt;
  const double through_m = sagitta_m(radius_m, (next_post - post).norm());
  return ClosedGap{{post, next_post},
                   std::max(through_m, projection_m(radius_m, ends_m)),
                   projection_m(radius_m, farthest_m),
                   sagitta_m(radius_m, width_m)};
}

void drop_narrow_shadows(std::vector<SightRay>& rays, double radius_m) {
  const std::size_t count = rays.size();
  drop_runs(rays, [&](std::size_t first) -> std::size_t {
    const SightRay& left = rays[first];
    double nearer_m = 0;  // length of the longest ray in between
    for (std::size_t last = first + 1; last < first + count; ++last) {
      const SightRay& right = rays[last % count];
      const double angle_rad = angle_between_rad(left, right);
      const double half_sine = std::sin(angle_rad / 2);
      if (angle_rad >= kMaxAngle_rad || nearer_m >= left.free_m || nearer_m * half_sine >= radius_m) return 0;
      const double length_m = std::min(left.free_m, right.free_m);
      if (last > first + 1 && length_m > nearer_m && proven_m(length_m, angle_rad, radius_m) > nearer_m)
        return last - first - 1;
      nearer_m = std::max(nearer_m, right.free_m);
    }
    return 0;
  });
}

void drop_rays_within_gaps(std::vector<SightRay>& rays, double radius_m) {
  const std::size_t count = rays.size();
  drop_runs(rays, [&](std::size_t first) -> std::size_t {
    const SightRay& from = rays[first];
    if (!from.post_m || closed_gap(from, rays[(first + 1) % count], radius_m)) return 0;
    for (std::size_t last = first + 2; last < first + count; ++last) {
      const SightRay& to = rays[last % count];
      const double angle_rad = angle_between_rad(from, to);
      if (angle_rad >= kMaxAngle_rad || from.free_m * std::sin(angle_rad) >= 2 * radius_m) return 0;
      if (to.free_m > 0 && closed_gap(from, to, radius_m)) return last - first - 1;
    }
    return 0;
  });
}

}  // namespace sidestep
