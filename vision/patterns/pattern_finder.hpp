// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/marking/layout.hpp"
#include "vision/patterns/pose_fit.hpp"
#include "vision/patterns/projected_region.hpp"

namespace sidestep {

/// A set of dots arranged as in the layout; at most one dot is missing.
struct DetectedPattern {
  Pose pose;
  double rms_residual_m = 0;  ///< root mean square distance of the dots from their predicted positions
  std::optional<Team> team;   ///< nullopt if the centre dot is missing
  int dot_count = 0;          ///< number of dots found, including the centre dot
  /// Colours of the layout's dots; nullopt for a missing dot.
  std::array<std::optional<Colour>, kMaxDots> colours{};

  /// Whether all dots that were found have the colours of this team and pattern.
  [[nodiscard]] bool matches(Team other_team, const MarkerPattern& pattern) const;
};

/// Finds robots by the arrangement of their dots, regardless of the dots' colours. Tolerates one missing dot
/// per robot and dots that belong to no robot. The colours identify the robot afterwards (Identifier).
class PatternFinder {
 public:
  explicit PatternFinder(const MarkerLayout& layout);

  /// Patterns, best first: more dots, then smaller residuals. No region is used twice. Valid until the next
  /// call.
  std::span<const DetectedPattern> find(std::span<const ProjectedRegion> regions);

 private:
  struct Candidate {
    DetectedPattern pattern;
    int centre = -1;                   ///< index into centres_; -1: missing
    std::array<int, kMaxDots> dots{};  ///< indices into dots_; -1: missing
  };
  void classify_regions(std::span<const ProjectedRegion> regions);
  bool has_disc_area(const ProjectedRegion& region, double radius_m) const;
  int nearest_dot(const Vec2& position_m) const;
  std::optional<Candidate> candidate_at(const Pose& guess, int centre) const;
  std::optional<Candidate> refined(const Pose& guess, int centre) const;
  std::optional<Candidate> best_around(int centre) const;
  void find_with_centres();
  void find_without_centres();
  void accept(const Candidate& candidate);

  MarkerLayout layout_;
  double max_dot_distance_m_ = 0;  ///< from the centre dot to the farthest dot
  std::vector<ProjectedRegion> centres_, dots_;
  std::vector<bool> is_used_;  ///< parallel to dots_
  std::vector<Candidate> candidates_;
  std::vector<DetectedPattern> found_;
};

}  // namespace sidestep
