// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/domain/free_places.hpp"

#include <algorithm>
#include <optional>

namespace sidestep {
namespace {

constexpr int kDirections = 64;
constexpr double kBetween_rad = 2 * 3.14159265358979323846 / kDirections;
constexpr int kHalvings = 20;

struct Found {
  Vec2 place_m;
  double distance_m;
  double angle_rad;
};

class Search {
 public:
  Search(const Vec2& place_m, double step_m, const std::function<bool(const Vec2&)>& is_free)
      : place_m_(place_m), step_m_(step_m), is_free_(is_free) {}

  std::optional<Found> look(double angle_rad, double reach_m) const {
    const Vec2 direction(std::cos(angle_rad), std::sin(angle_rad));
    double blocked_m = 0, free_m = step_m_;
    while (!is_free_(place_m_ + free_m * direction)) {
      if (free_m >= reach_m) return std::nullopt;
      blocked_m = free_m;
      free_m = std::min(free_m * 1.1 + step_m_, reach_m);
    }
    for (int i = 0; i < kHalvings; ++i) {
      const double middle_m = (blocked_m + free_m) / 2;
      (is_free_(place_m_ + middle_m * direction) ? free_m : blocked_m) = middle_m;
    }
    return Found{place_m_ + free_m * direction, free_m, angle_rad};
  }

  /// Looks between the direction and its neighbours.
  void refine(Found& found) const {
    for (double step_rad = kBetween_rad / 2; step_rad > kBetween_rad / 64; step_rad /= 2) {
      const double middle_rad = found.angle_rad;
      for (const double angle : {middle_rad - step_rad, middle_rad + step_rad}) {
        const auto nearer = look(angle, found.distance_m);
        if (nearer && nearer->distance_m < found.distance_m) found = *nearer;
      }
    }
  }

 private:
  Vec2 place_m_;
  double step_m_;
  const std::function<bool(const Vec2&)>& is_free_;
};

}  // namespace

std::vector<Vec2> free_places_near(const Vec2& place_m, double step_m, double reach_m,
                                   const std::function<bool(const Vec2&)>& is_free) {
  const Search search(place_m, step_m, is_free);
  std::vector<Found> found;
  for (int i = 0; i < kDirections; ++i)
    if (const auto one = search.look(i * kBetween_rad, reach_m)) found.push_back(*one);
  std::sort(found.begin(), found.end(),
            [](const Found& a, const Found& b) { return a.distance_m < b.distance_m; });
  if (!found.empty()) search.refine(found.front());
  std::vector<Vec2> places;
  for (const Found& one : found) places.push_back(one.place_m);
  return places;
}

}  // namespace sidestep
