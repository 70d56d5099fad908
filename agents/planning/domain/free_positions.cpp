// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/domain/free_positions.hpp"

#include <algorithm>
#include <numbers>
#include <optional>

namespace sidestep {
namespace {

constexpr int kDirections = 64;
constexpr double kSpacing_rad = 2 * std::numbers::pi / kDirections;
constexpr int kBisections = 20;

struct FreePosition {
  Vec2 position_m;
  double distance_m;
  double angle_rad;
};

class DirectionalSearch {
 public:
  DirectionalSearch(const Vec2& position_m, double step_m, const std::function<bool(const Vec2&)>& is_free)
      : position_m_(position_m), step_m_(step_m), is_free_(is_free) {}

  std::optional<FreePosition> search(double angle_rad, double max_distance_m) const {
    const Vec2 direction(std::cos(angle_rad), std::sin(angle_rad));
    double blocked_m = 0, free_m = step_m_;
    while (!is_free_(position_m_ + free_m * direction)) {
      if (free_m >= max_distance_m) return std::nullopt;
      blocked_m = free_m;
      free_m = std::min(free_m * 1.1 + step_m_, max_distance_m);
    }
    for (int i = 0; i < kBisections; ++i) {
      const double middle_m = (blocked_m + free_m) / 2;
      (is_free_(position_m_ + middle_m * direction) ? free_m : blocked_m) = middle_m;
    }
    return FreePosition{position_m_ + free_m * direction, free_m, angle_rad};
  }

  /// Searches between the direction and its neighbours.
  void refine(FreePosition& found) const {
    for (double step_rad = kSpacing_rad / 2; step_rad > kSpacing_rad / 64; step_rad /= 2) {
      const double middle_rad = found.angle_rad;
      for (const double angle : {middle_rad - step_rad, middle_rad + step_rad}) {
        const auto nearer = search(angle, found.distance_m);
        if (nearer && nearer->distance_m < found.distance_m) found = *nearer;
      }
    }
  }

 private:
  Vec2 position_m_;
  double step_m_;
  const std::function<bool(const Vec2&)>& is_free_;
};

}  // namespace

std::optional<Vec2> nearest_free_position(const Vec2& position_m, double step_m, double max_distance_m,
                                          const std::function<bool(const Vec2&)>& is_free,
                                          const std::function<bool(const Vec2&)>& can_reach) {
  const DirectionalSearch direction_search(position_m, step_m, is_free);
  std::optional<FreePosition> best;
  const auto look = [&](double angle_rad) {
    const double limit_m = best ? best->distance_m : max_distance_m;
    const Vec2 first = position_m + step_m * Vec2(std::cos(angle_rad), std::sin(angle_rad));
    if (can_reach && step_m < limit_m && !can_reach(first)) return;
    const auto found = direction_search.search(angle_rad, limit_m);
    if (!found || (best && found->distance_m >= limit_m)) return;
    if (!can_reach || can_reach(found->position_m)) best = found;
  };
  for (int i = 0; i < kDirections; ++i) look(i * kSpacing_rad);
  for (double step_rad = kSpacing_rad / 2; best && step_rad > kSpacing_rad / 64; step_rad /= 2) {
    const double middle_rad = best->angle_rad;
    look(middle_rad - step_rad);
    look(middle_rad + step_rad);
  }
  if (!best) return std::nullopt;
  return best->position_m;
}

std::vector<Vec2> free_positions_near(const Vec2& position_m, double step_m, double max_distance_m,
                                      const std::function<bool(const Vec2&)>& is_free) {
  const DirectionalSearch direction_search(position_m, step_m, is_free);
  std::vector<FreePosition> found;
  for (int i = 0; i < kDirections; ++i)
    if (const auto one = direction_search.search(i * kSpacing_rad, max_distance_m)) found.push_back(*one);
  std::sort(found.begin(), found.end(),
            [](const FreePosition& a, const FreePosition& b) { return a.distance_m < b.distance_m; });
  if (!found.empty()) direction_search.refine(found.front());
  std::vector<Vec2> positions;
  positions.reserve(found.size());
  for (const FreePosition& one : found) positions.push_back(one.position_m);
  return positions;
}

}  // namespace sidestep
