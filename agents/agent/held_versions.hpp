// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/motion/version_set.hpp"
#include "common/protocol/robot_messages.hpp"

namespace sidestep {

/// The versions that the robot may be executing, now or later: those that the agent has forwarded, corrected
/// by the robot's reports.
class HeldVersions {
 public:
  /// What a report changed.
  struct ReportEffect {
    bool is_late = false;     ///< nothing, because a later report was applied before
    bool is_unknown = false;  ///< the robot executes a version that the agent did not know; only that is held
    bool has_switched = false;  ///< the robot executes another of the held versions
    int lost = 0;               ///< number of forwarded versions that the robot did not activate
  };

  /// A version that starts later than this was proposed by a wrong clock. Agents keep proposing despite it.
  static constexpr Duration kMaxAhead{2'000'000'000};

  explicit HeldVersions(VersionNumber next_number) : next_number_(next_number) {}

  /// Begins with what the robot executes when it first acknowledges the agent.
  void begin(const RobotReport& robot_report);
  /// Applies a later report. `is_current`: it belongs to the robot's current incarnation.
  ReportEffect apply(const RobotReport& robot_report, bool is_current);
  /// Accepts reports of any time, because the robot's clock is another one.
  void forget_report_times() { latest_report_ = Time::min(); }
  /// Adds a granted version. Precondition: not is_full().
  void add(const Version& version) { versions_.add(version); }

  const VersionSet& versions() const { return versions_; }
  bool is_full() const { return versions_.is_full(); }
  /// Whether the robot executes a version; false before begin() and while it is off the floor.
  bool is_executing() const { return versions_.find(executing_) != nullptr; }
  /// The version that the robot executes according to its latest report. Precondition: is_executing().
  const Version& executing() const { return *versions_.find(executing_); }
  /// The version that the robot is expected to execute at a time. Precondition: is_executing().
  const Version& base_at(Time start) const;
  /// Start of the last version that the robot is expected to receive soon.
  Time last_start(Time now) const;
  /// Whether the robot can still switch to a version of this base.
  bool has_base(VersionNumber base) const;
  /// Whether the robot can no longer switch to one of the versions.
  bool has_unreachable() const;
  /// A number above those of all versions of the robot.
  VersionNumber take_number() { return next_number_++; }
  VersionNumber next_number() const { return next_number_; }

 private:
  void number_above(const Version& executing);

  VersionSet versions_;
  VersionNumber executing_ = 0;
  Time latest_report_{};  // by the robot's clock
  VersionNumber next_number_;
};

}  // namespace sidestep
