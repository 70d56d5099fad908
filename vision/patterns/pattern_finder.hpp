// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/marking/layout.hpp"
#include "vision/patterns/patch.hpp"
#include "vision/patterns/pose_fit.hpp"

namespace sidestep {

/// Limits are on the floor, not in pixels: they hold wherever the camera hangs.
struct PatternSettings {
  double tolerance_m = 0.012;  ///< by which a dot may be seen beside where the others put it
  double least_area = 0.3;     ///< of a dot's area, below which a patch is something else
  double most_area = 2.5;      ///< and above which
};

/// Dots that stand as a layout's do. At most one of them is missing.
struct MarkedRobot {
  Pose pose;
  double residual_m = 0;     ///< root mean square distance of the dots from where the pose puts them
  std::optional<Team> team;  ///< nothing: it is the centre dot that is missing
  int seen = 0;              ///< dots, the centre included
  std::array<std::optional<Colour>, kMaxDots> colours{};  ///< of the layout's dots; nothing: missing

  /// Whether the dots that are seen are what this one wears.
  bool can_be(Team its_team, const MarkingPattern& pattern) const;
};

/// Finds robots among patches by how their dots stand, whatever their colours: one dot that is missing, and
/// dots that belong to nobody, do no harm. Who it is has to be told by the colours that are left
/// (Identifier).
class PatternFinder {
 public:
  explicit PatternFinder(const MarkingLayout& layout, const PatternSettings& settings = {});

  /// Best first: more dots, then smaller residuals. No patch is used twice. Valid until the next call.
  std::span<const MarkedRobot> find(std::span<const Patch> patches);

 private:
  struct Candidate {
    MarkedRobot robot;
    int centre = -1;                   ///< index into centres_
    std::array<int, kMaxDots> dots{};  ///< indices into dots_, -1: missing
  };
  void sort_out(std::span<const Patch> patches);
  bool has_area_of(const Patch& patch, double radius_m) const;
  int nearest_dot(const Vec2& at_m) const;
  std::optional<Candidate> candidate_at(const Pose& guess, int centre) const;
  std::optional<Candidate> completed(Pose pose, int centre) const;
  std::optional<Candidate> best_around(int centre) const;
  void find_with_centres();
  void find_without_centres();
  void accept(const Candidate& candidate);

  MarkingLayout layout_;
  PatternSettings settings_;
  double reach_m_ = 0;  ///< of the dot farthest from the centre
  std::vector<Patch> centres_, dots_;
  std::vector<bool> is_taken_;  ///< as dots_
  std::vector<Candidate> candidates_;
  std::vector<MarkedRobot> found_;
};

}  // namespace sidestep
