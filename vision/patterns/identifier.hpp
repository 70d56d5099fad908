// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/motion/version.hpp"
#include "common/time/time.hpp"
#include "vision/patterns/pattern_finder.hpp"

namespace sidestep {

/// A robot that takes part, and what it wears.
struct RosterEntry {
  RobotId robot = 0;
  Team team = Team::kBlue;
  MarkingPattern pattern;
};

/// Where a robot is expected.
struct ExpectedRobot {
  RobotId robot = 0;
  Pose pose;
};

struct IdentifiedRobot {
  RobotId robot = 0;
  MarkedRobot seen;
};

struct IdentifierSettings {
  double gate_m = 0.09;   ///< who is expected within that of here is here: bodies have that radius
  double gate_rad = 0.8;  ///< and within that of this heading
  double speed_mps = 3;   ///< that no robot exceeds
  Duration forgets_after{500'000'000};
};

/// Says who the robots are whose dots were found. All dots together name a robot; with one missing several
/// may fit, and then it is the one that is expected there, or the only one that fits all that was seen there
/// before. Who is expected somewhere is not mistaken for somebody else because a dot was misread. What is not
/// certain is nobody.
class Identifier {
 public:
  explicit Identifier(std::span<const RosterEntry> roster, const IdentifierSettings& settings = {});

  /// Of one camera's frames, in any order. At most one sight for each robot. Valid until the next call.
  std::span<const IdentifiedRobot> identify(Time captured_at, std::span<const MarkedRobot> seen,
                                            std::span<const ExpectedRobot> expected);

 private:
  /// Somebody whose name is not known yet, and who it may be, as the roster.
  struct Nameless {
    Vec2 position_m;
    Time seen_at;
    std::vector<bool> may_be;
  };
  std::vector<bool> fitting(const MarkedRobot& seen) const;
  bool is_expected_at(const ExpectedRobot& expected, const MarkedRobot& seen) const;
  std::vector<bool> expected_there(const MarkedRobot& seen, std::span<const ExpectedRobot> expected) const;
  std::vector<bool> remembered(Time captured_at, const MarkedRobot& seen, std::vector<bool> fits);

  std::vector<RosterEntry> roster_;
  IdentifierSettings settings_;
  std::vector<Nameless> nameless_;
  std::vector<IdentifiedRobot> found_;
};

}  // namespace sidestep
