// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/motion/version.hpp"
#include "common/time/time.hpp"
#include "vision/patterns/pattern_finder.hpp"

namespace sidestep {

/// A participating robot and its marker pattern.
struct RosterEntry {
  RobotId robot = 0;
  Team team = Team::kBlue;
  MarkerPattern pattern;
};

/// The predicted pose of a robot.
struct ExpectedRobot {
  RobotId robot = 0;
  Pose pose;
};

struct IdentifiedRobot {
  RobotId robot = 0;
  DetectedPattern pattern;
};

/// Identifies robots by the colours of their dots. A complete pattern identifies one robot. If a dot is
/// missing, several robots may match. Then the robot expected at the pattern's position is chosen, or else
/// the only robot that matches all observations there. Where a robot is expected, a pattern is never
/// identified as a different robot, even if a dot was misread. An ambiguous pattern remains unidentified.
class Identifier {
 public:
  explicit Identifier(std::span<const RosterEntry> roster);

  /// Identifies the patterns of one camera's frame; frames may come in any order. Returns each robot at most
  /// once. Valid until the next call.
  std::span<const IdentifiedRobot> identify(Time captured_at, std::span<const DetectedPattern> patterns,
                                            std::span<const ExpectedRobot> expected);

 private:
  /// One flag per robot, in the order of the roster.
  using RosterMask = std::vector<bool>;
  /// An observed robot whose identity is unknown.
  struct UnidentifiedRobot {
    Vec2 position_m;
    Time observed_at;
    RosterMask matches;  ///< robots that match all observations so far
  };
  RosterMask matching_robots(const DetectedPattern& pattern) const;
  bool is_within_gates(const ExpectedRobot& expected, const DetectedPattern& pattern) const;
  RosterMask robots_expected_at(const DetectedPattern& pattern,
                                std::span<const ExpectedRobot> expected) const;
  RosterMask narrowed_by_history(Time captured_at, const DetectedPattern& pattern, const RosterMask& matches);

  std::vector<RosterEntry> roster_;
  std::vector<UnidentifiedRobot> unidentified_;
  std::vector<IdentifiedRobot> found_;
};

}  // namespace sidestep
