// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "idl/trajectory.hpp"

namespace sidestep {

inline constexpr double kLengthTolerance_m = 2e-6;  ///< allows for rounding in paths and their distances

/// Whether all numbers of the version are finite and physically plausible and its phase count fits the array.
[[nodiscard]] bool is_sane(const msg::Version& version);

/// The reference path of a version, for the auditor only. The arithmetic is deliberately independent of
/// common/motion, so that the auditor does not repeat errors of that code.
class AuditPath {
 public:
  struct Node {
    double elapsed_s = 0;  ///< time since the path's start
    double x = 0, y = 0, vx = 0, vy = 0, ax = 0, ay = 0;
  };

  AuditPath() = default;
  /// Precondition: is_sane(version).
  explicit AuditPath(const msg::Version& version);

  std::int64_t start_ns() const { return start_ns_; }
  double duration_s() const { return nodes_[static_cast<std::size_t>(count_)].elapsed_s; }
  /// Position, velocity and acceleration `elapsed_s` after the start. Before the start, the state at the
  /// start; after the end, the end at rest.
  Node at_s(double elapsed_s) const;
  Node at_ns(std::int64_t t_ns) const { return at_s(static_cast<double>(t_ns - start_ns_) * 1e-9); }
  const Node& first() const { return nodes_[0]; }
  /// The end of the last phase, with the residual speed there.
  const Node& last() const { return nodes_[static_cast<std::size_t>(count_)]; }
  int phase_count() const { return count_; }
  /// The state at the beginning of a phase.
  const Node& phase(int index) const { return nodes_[static_cast<std::size_t>(index)]; }
  /// Upper bound of the distance between any point of the path and its first point.
  double reach_m() const { return reach_m_; }
  double max_speed_mps() const { return max_speed_mps_; }

 private:
  std::int64_t start_ns_ = 0;
  int count_ = 0;
  std::array<Node, msg::MAX_PHASES + 1> nodes_{};  ///< the start of each phase, and the end of the last one
  double reach_m_ = 0;
  double max_speed_mps_ = 0;
};

/// The smallest distance between two paths, and the time at which it occurs.
struct ClosestApproach {
  double distance_m = std::numeric_limits<double>::infinity();
  std::int64_t at_ns = 0;
};

/// Closest approach at or after `from_ns` and the later of the two starts. Steps are as long as the relative
/// speed allows without missing a distance below `cutoff_m`; where the paths are closer than that, steps are
/// at most 0.25 ms. Below `cutoff_m` the result is accurate to micrometres; above it, the result is only a
/// bound.
[[nodiscard]] ClosestApproach closest_approach(const AuditPath& a, const AuditPath& b, double cutoff_m,
                                               std::int64_t from_ns = 0);
/// The closest approach of a path to a fixed point, with the same accuracy.
[[nodiscard]] ClosestApproach closest_approach(const AuditPath& path, double x_m, double y_m,
                                               double cutoff_m);

}  // namespace sidestep
