// SPDX-License-Identifier: Apache-2.0
#include "vision/patterns/pattern_finder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sidestep {
namespace {

/// Maximum distance of a dot from the position that the pose predicts. All limits apply in the plane of the
/// dots rather than in pixels, so that they hold at any camera height.
constexpr double kDotTolerance_m = 0.012;
// Minimum and maximum area of a region, as fractions of the dot's area.
constexpr double kMinDotAreaRatio = 0.3, kMaxDotAreaRatio = 2.5;

double area_m2(double radius_m) { return std::numbers::pi * radius_m * radius_m; }

double angle_rad(const Vec2& v) { return std::atan2(v.y(), v.x()); }

bool is_better(const DetectedPattern& a, const DetectedPattern& b) {
  return a.dot_count != b.dot_count ? a.dot_count > b.dot_count : a.rms_residual_m < b.rms_residual_m;
}

}  // namespace

bool DetectedPattern::matches(Team other_team, const MarkerPattern& pattern) const {
  if (team && *team != other_team) return false;
  for (std::size_t k = 0; k < pattern.colours.size(); ++k) {
    if (colours[k] && *colours[k] != pattern.colours[k]) return false;
  }
  return true;
}

PatternFinder::PatternFinder(const MarkerLayout& layout) : layout_(layout) {
  for (const Marker& dot : layout_.dots) {
    max_dot_distance_m_ = std::max(max_dot_distance_m_, (dot.position_m - layout_.centre.position_m).norm());
  }
}

bool PatternFinder::has_disc_area(const ProjectedRegion& region, double radius_m) const {
  return region.area_m2 >= kMinDotAreaRatio * area_m2(radius_m) &&
         region.area_m2 <= kMaxDotAreaRatio * area_m2(radius_m);
}

void PatternFinder::classify_regions(std::span<const ProjectedRegion> regions) {
  centres_.clear();
  dots_.clear();
  const auto is_pattern_colour = [&](Colour colour) {
    return std::ranges::any_of(layout_.patterns, [&](const MarkerPattern& pattern) {
      return std::ranges::find(pattern.colours, colour) != pattern.colours.end();
    });
  };
  const auto has_dot_area = [&](const ProjectedRegion& region) {
    return std::ranges::any_of(layout_.dots,
                               [&](const Marker& dot) { return has_disc_area(region, dot.radius_m); });
  };
  for (const ProjectedRegion& region : regions) {
    if (region.colour == layout_.blue_team || region.colour == layout_.yellow_team) {
      if (has_disc_area(region, layout_.centre.radius_m)) centres_.push_back(region);
    } else if (has_dot_area(region) && is_pattern_colour(region.colour)) {
      dots_.push_back(region);
    }
  }
  is_used_.assign(dots_.size(), false);
}

int PatternFinder::nearest_dot(const Vec2& position_m) const {
  int nearest = -1;
  double min_squared = kDotTolerance_m * kDotTolerance_m;
  for (std::size_t j = 0; j < dots_.size(); ++j) {
    const double squared = (dots_[j].position_m - position_m).squaredNorm();
    if (squared > min_squared || is_used_[j]) continue;
    min_squared = squared;
    nearest = static_cast<int>(j);
  }
  return nearest;
}

/// Finds the dots near their positions at the guessed pose, and fits the pose to them.
std::optional<PatternFinder::Candidate> PatternFinder::candidate_at(const Pose& guess, int centre) const {
  Candidate candidate;
  candidate.centre = centre;
  candidate.dots.fill(-1);
  std::array<PointCorrespondence, kMaxDots + 1> points;
  std::size_t count = 0;
  if (centre >= 0) {
    const ProjectedRegion& region = centres_[static_cast<std::size_t>(centre)];
    points[count++] = {layout_.centre.position_m, region.position_m};
    candidate.pattern.team = region.colour == layout_.blue_team ? Team::kBlue : Team::kYellow;
  }
  for (std::size_t k = 0; k < layout_.dots.size(); ++k) {
    const int dot = nearest_dot(guess.to_world(layout_.dots[k].position_m));
    if (dot < 0 || std::ranges::find(candidate.dots, dot) != candidate.dots.end()) continue;
    const ProjectedRegion& region = dots_[static_cast<std::size_t>(dot)];
    candidate.dots[k] = dot;
    candidate.pattern.colours[k] = region.colour;
    points[count++] = {layout_.dots[k].position_m, region.position_m};
  }
  if (count < std::max<std::size_t>(3, layout_.dots.size())) return std::nullopt;
  const std::span<const PointCorrespondence> found(points.data(), count);
  candidate.pattern.dot_count = static_cast<int>(count);
  candidate.pattern.pose = fit_pose(found);
  candidate.pattern.rms_residual_m = rms_residual_m(candidate.pattern.pose, found);
  return candidate;
}

/// Tries the guessed pose and the pose fitted to the dots found there. Returns the better candidate.
std::optional<PatternFinder::Candidate> PatternFinder::refined(const Pose& guess, int centre) const {
  const auto first = candidate_at(guess, centre);
  if (!first) return std::nullopt;
  const auto second = candidate_at(first->pattern.pose, centre);
  return second && is_better(second->pattern, first->pattern) ? second : first;
}

/// Returns the best candidate around a centre dot. Each dot near the centre suggests a heading for each
/// layout dot at the same distance from the layout's centre.
std::optional<PatternFinder::Candidate> PatternFinder::best_around(int centre) const {
  const Vec2& centre_m = centres_[static_cast<std::size_t>(centre)].position_m;
  std::optional<Candidate> best;
  for (std::size_t j = 0; j < dots_.size(); ++j) {
    const Vec2 observed = dots_[j].position_m - centre_m;
    const double distance_m = observed.norm();
    if (is_used_[j] || distance_m > max_dot_distance_m_ + kDotTolerance_m) continue;
    for (const Marker& dot : layout_.dots) {
      const Vec2 expected = dot.position_m - layout_.centre.position_m;
      if (std::abs(expected.norm() - distance_m) > kDotTolerance_m) continue;
      const double heading_rad = angle_rad(observed) - angle_rad(expected);
      const Pose guess{centre_m - rotated(layout_.centre.position_m, heading_rad), heading_rad};
      const auto candidate = refined(guess, centre);
      if (candidate && (!best || is_better(candidate->pattern, best->pattern))) best = candidate;
    }
  }
  return best;
}

void PatternFinder::accept(const Candidate& candidate) {
  for (const int dot : candidate.dots) {
    if (dot >= 0) is_used_[static_cast<std::size_t>(dot)] = true;
  }
  found_.push_back(candidate.pattern);
}

void PatternFinder::find_with_centres() {
  candidates_.clear();
  for (std::size_t i = 0; i < centres_.size(); ++i) {
    if (const auto candidate = best_around(static_cast<int>(i))) candidates_.push_back(*candidate);
  }
  std::ranges::stable_sort(
      candidates_, [](const Candidate& a, const Candidate& b) { return is_better(a.pattern, b.pattern); });
  for (const Candidate& candidate : candidates_) {
    const bool is_free = std::ranges::none_of(
        candidate.dots, [&](int dot) { return dot >= 0 && is_used_[static_cast<std::size_t>(dot)]; });
    // A better candidate has claimed one of the dots: search again among the unused ones.
    const auto accepted = is_free ? candidate : best_around(candidate.centre);
    if (accepted) accept(*accepted);
  }
}

/// If the centre dot is missing, all others must be present, and each pair of dots that may be the layout's
/// first two suggests a pose.
void PatternFinder::find_without_centres() {
  if (layout_.dots.size() < 3) return;
  const Vec2 &first = layout_.dots[0].position_m, &second = layout_.dots[1].position_m;
  const double spacing_m = (second - first).norm();
  for (std::size_t i = 0; i < dots_.size(); ++i) {
    for (std::size_t j = 0; j < dots_.size() && !is_used_[i]; ++j) {
      if (is_used_[j] || i == j) continue;
      const Vec2 &from = dots_[i].position_m, &to = dots_[j].position_m;
      if (std::abs((to - from).norm() - spacing_m) > kDotTolerance_m) continue;
      const std::array<PointCorrespondence, 2> pair{{{first, from}, {second, to}}};
      const auto candidate = refined(fit_pose(pair), -1);
      if (candidate && candidate->pattern.dot_count == static_cast<int>(layout_.dots.size()))
        accept(*candidate);
    }
  }
}

std::span<const DetectedPattern> PatternFinder::find(std::span<const ProjectedRegion> regions) {
  found_.clear();
  classify_regions(regions);
  find_with_centres();
  find_without_centres();
  std::ranges::stable_sort(found_, is_better);
  return found_;
}

}  // namespace sidestep
