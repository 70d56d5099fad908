// SPDX-License-Identifier: Apache-2.0
#include "vision/patterns/pattern_finder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sidestep {
namespace {

double area_m2(double radius_m) { return std::numbers::pi * radius_m * radius_m; }

double angle_rad(const Vec2& v) { return std::atan2(v.y(), v.x()); }

bool is_better(const MarkedRobot& a, const MarkedRobot& b) {
  return a.seen != b.seen ? a.seen > b.seen : a.residual_m < b.residual_m;
}

}  // namespace

bool MarkedRobot::can_be(Team its_team, const MarkingPattern& pattern) const {
  if (team && *team != its_team) return false;
  for (std::size_t k = 0; k < pattern.colours.size(); ++k) {
    if (colours[k] && *colours[k] != pattern.colours[k]) return false;
  }
  return true;
}

PatternFinder::PatternFinder(const MarkingLayout& layout, const PatternSettings& settings)
    : layout_(layout), settings_(settings) {
  for (const MarkingDot& dot : layout_.dots)
    reach_m_ = std::max(reach_m_, (dot.position_m - layout_.centre.position_m).norm());
}

bool PatternFinder::has_area_of(const Patch& patch, double radius_m) const {
  return patch.area_m2 >= settings_.least_area * area_m2(radius_m) &&
         patch.area_m2 <= settings_.most_area * area_m2(radius_m);
}

void PatternFinder::sort_out(std::span<const Patch> patches) {
  centres_.clear();
  dots_.clear();
  const auto is_worn = [&](Colour colour) {
    return std::ranges::any_of(layout_.patterns, [&](const MarkingPattern& pattern) {
      return std::ranges::find(pattern.colours, colour) != pattern.colours.end();
    });
  };
  const auto is_a_dot = [&](const Patch& patch) {
    return std::ranges::any_of(layout_.dots,
                               [&](const MarkingDot& dot) { return has_area_of(patch, dot.radius_m); });
  };
  for (const Patch& patch : patches) {
    if (patch.colour == layout_.blue_team || patch.colour == layout_.yellow_team) {
      if (has_area_of(patch, layout_.centre.radius_m)) centres_.push_back(patch);
    } else if (is_a_dot(patch) && is_worn(patch.colour)) {
      dots_.push_back(patch);
    }
  }
  is_taken_.assign(dots_.size(), false);
}

int PatternFinder::nearest_dot(const Vec2& at_m) const {
  int nearest = -1;
  double least = settings_.tolerance_m * settings_.tolerance_m;
  for (std::size_t j = 0; j < dots_.size(); ++j) {
    const double distance2 = (dots_[j].position_m - at_m).squaredNorm();
    if (distance2 > least || is_taken_[j]) continue;
    least = distance2;
    nearest = static_cast<int>(j);
  }
  return nearest;
}

/// The dots around a pose, and the pose that follows from them; centre -1: that dot is missing.
std::optional<PatternFinder::Candidate> PatternFinder::candidate_at(const Pose& guess, int centre) const {
  Candidate candidate;
  candidate.centre = centre;
  candidate.dots.fill(-1);
  std::array<SeenPoint, kMaxDots + 1> points;
  std::size_t count = 0;
  if (centre >= 0) {
    const Patch& patch = centres_[static_cast<std::size_t>(centre)];
    points[count++] = {layout_.centre.position_m, patch.position_m};
    candidate.robot.team = patch.colour == layout_.blue_team ? Team::kBlue : Team::kYellow;
  }
  for (std::size_t k = 0; k < layout_.dots.size(); ++k) {
    const int dot = nearest_dot(guess.to_world(layout_.dots[k].position_m));
    if (dot < 0 || std::ranges::find(candidate.dots, dot) != candidate.dots.end()) continue;
    const Patch& patch = dots_[static_cast<std::size_t>(dot)];
    candidate.dots[k] = dot;
    candidate.robot.colours[k] = patch.colour;
    points[count++] = {layout_.dots[k].position_m, patch.position_m};
  }
  if (count < std::max<std::size_t>(3, layout_.dots.size())) return std::nullopt;
  const std::span<const SeenPoint> seen(points.data(), count);
  candidate.robot.seen = static_cast<int>(count);
  candidate.robot.pose = fitted_pose(seen);
  candidate.robot.residual_m = residual_m(candidate.robot.pose, seen);
  return candidate;
}

/// What a first guess comes to: once more from where its own dots put it.
std::optional<PatternFinder::Candidate> PatternFinder::completed(Pose pose, int centre) const {
  const auto first = candidate_at(pose, centre);
  if (!first) return std::nullopt;
  const auto second = candidate_at(first->robot.pose, centre);
  return second && is_better(second->robot, first->robot) ? second : first;
}

/// Each dot near a centre, taken for each of the layout's that is as far from its centre, says a heading.
std::optional<PatternFinder::Candidate> PatternFinder::best_around(int centre) const {
  const Vec2& at = centres_[static_cast<std::size_t>(centre)].position_m;
  std::optional<Candidate> best;
  for (std::size_t j = 0; j < dots_.size(); ++j) {
    const Vec2 seen = dots_[j].position_m - at;
    const double distance_m = seen.norm();
    if (is_taken_[j] || distance_m > reach_m_ + settings_.tolerance_m) continue;
    for (const MarkingDot& dot : layout_.dots) {
      const Vec2 worn = dot.position_m - layout_.centre.position_m;
      if (std::abs(worn.norm() - distance_m) > settings_.tolerance_m) continue;
      const double heading_rad = angle_rad(seen) - angle_rad(worn);
      const Pose guess{at - rotated(layout_.centre.position_m, heading_rad), heading_rad};
      const auto candidate = completed(guess, centre);
      if (candidate && (!best || is_better(candidate->robot, best->robot))) best = candidate;
    }
  }
  return best;
}

void PatternFinder::accept(const Candidate& candidate) {
  for (const int dot : candidate.dots) {
    if (dot >= 0) is_taken_[static_cast<std::size_t>(dot)] = true;
  }
  found_.push_back(candidate.robot);
}

void PatternFinder::find_with_centres() {
  candidates_.clear();
  for (std::size_t i = 0; i < centres_.size(); ++i) {
    if (const auto candidate = best_around(static_cast<int>(i))) candidates_.push_back(*candidate);
  }
  std::ranges::stable_sort(
      candidates_, [](const Candidate& a, const Candidate& b) { return is_better(a.robot, b.robot); });
  for (const Candidate& candidate : candidates_) {
    const bool is_free = std::ranges::none_of(
        candidate.dots, [&](int dot) { return dot >= 0 && is_taken_[static_cast<std::size_t>(dot)]; });
    // What a better one has taken was not this one's.
    const auto left = is_free ? candidate : best_around(candidate.centre);
    if (left) accept(*left);
  }
}

/// Where the centre is missing no other dot may be: the first two of the layout say the pose.
void PatternFinder::find_without_centres() {
  if (layout_.dots.size() < 3) return;
  const Vec2 &first = layout_.dots[0].position_m, &second = layout_.dots[1].position_m;
  const double apart_m = (second - first).norm();
  for (std::size_t i = 0; i < dots_.size(); ++i) {
    for (std::size_t j = 0; j < dots_.size() && !is_taken_[i]; ++j) {
      if (is_taken_[j] || i == j) continue;
      const Vec2 &from = dots_[i].position_m, &to = dots_[j].position_m;
      if (std::abs((to - from).norm() - apart_m) > settings_.tolerance_m) continue;
      const std::array<SeenPoint, 2> pair{{{first, from}, {second, to}}};
      const auto candidate = completed(fitted_pose(pair), -1);
      if (candidate && candidate->robot.seen == static_cast<int>(layout_.dots.size())) accept(*candidate);
    }
  }
}

std::span<const MarkedRobot> PatternFinder::find(std::span<const Patch> patches) {
  found_.clear();
  sort_out(patches);
  find_with_centres();
  find_without_centres();
  std::ranges::stable_sort(found_, is_better);
  return found_;
}

}  // namespace sidestep
