// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/visibility_graph.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/geometry/segment.hpp"

namespace sidestep {
namespace {

constexpr int kCornersPerDisc = 12;
constexpr double kPi = 3.14159265358979323846;
// Corners stand off from the disc by this much, so that they see along it.
constexpr double kStandOff_m = 0.005;
// A corner this near is behind the robot.
constexpr double kReached_m = 1e-3;
constexpr double kNoWay = std::numeric_limits<double>::infinity();

}  // namespace

VisibilityGraph::VisibilityGraph(const std::vector<Circle>& obstacles, const Field& field, double radius_m,
                                 double keep_m, const Vec2& goal_m) {
  for (const Circle& obstacle : obstacles)
    discs_.push_back({obstacle.centre_m, obstacle.radius_m + radius_m + keep_m});
  corners_.push_back({goal_m, 0});
  place_corners(field, radius_m);
  measure();
}

void VisibilityGraph::place_corners(const Field& field, double radius_m) {
  for (const Circle& disc : discs_) {
    // The polygon's edges touch the disc that stands off, its corners lie further out.
    const double out = (disc.radius_m + kStandOff_m) / std::cos(kPi / kCornersPerDisc);
    for (int i = 0; i < kCornersPerDisc; ++i) {
      const double angle = 2 * kPi * i / kCornersPerDisc;
      const Vec2 corner = disc.centre_m + out * Vec2(std::cos(angle), std::sin(angle));
      const auto holds = [&](const Circle& other) {
        return (other.centre_m - corner).norm() < other.radius_m;
      };
      if (field.contains(corner, radius_m) && std::none_of(discs_.begin(), discs_.end(), holds)) {
        corners_.push_back({corner, kNoWay});
      }
    }
  }
}

void VisibilityGraph::measure() {
  std::vector<bool> done(corners_.size(), false);
  for (std::size_t round = 0; round < corners_.size(); ++round) {
    std::size_t nearest = corners_.size();
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      if (!done[i] && (nearest == corners_.size() || corners_[i].to_goal_m < corners_[nearest].to_goal_m))
        nearest = i;
    }
    if (corners_[nearest].to_goal_m == kNoWay) return;
    done[nearest] = true;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      if (done[i]) continue;
      const double through =
          corners_[nearest].to_goal_m + (corners_[i].position_m - corners_[nearest].position_m).norm();
      if (through < corners_[i].to_goal_m && sees(corners_[i].position_m, corners_[nearest].position_m)) {
        corners_[i].to_goal_m = through;
      }
    }
  }
}

bool VisibilityGraph::sees(const Vec2& from, const Vec2& to) const {
  for (const Circle& disc : discs_) {
    if (squared_distance(disc.centre_m, Segment{from, to}) >= disc.radius_m * disc.radius_m) continue;
    const Vec2 outwards = from - disc.centre_m;
    const bool leaves = outwards.norm() < disc.radius_m && outwards.dot(to - from) >= 0;
    if (!leaves) return false;
  }
  return true;
}

std::optional<Route> VisibilityGraph::route_from(const Vec2& start_m) const {
  std::optional<Route> best;
  for (const Corner& corner : corners_) {
    const double there = (corner.position_m - start_m).norm();
    if (there < kReached_m && corner.to_goal_m > 0) continue;
    const double length = there + corner.to_goal_m;
    if (length == kNoWay || (best && length >= best->length_m) || !sees(start_m, corner.position_m)) continue;
    best = Route{corner.position_m, length};
  }
  return best;
}

}  // namespace sidestep
