// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "idl/trajectory.h"

namespace sidestep {

/// Whether everything in it is a number that a robot could mean, and the phase count fits.
bool is_sane(const msg::Version& version);

/// Where a version says that its robot is, for the auditor only: plain arithmetic of its own that shares
/// nothing with common/motion, so that a mistake there does not hide itself.
class AuditPath {
 public:
  struct Node {
    double after_s = 0;  ///< the path's start
    double x = 0, y = 0, vx = 0, vy = 0, ax = 0, ay = 0;
  };

  AuditPath() = default;
  /// Precondition: is_sane(version).
  explicit AuditPath(const msg::Version& version);

  std::int64_t start_ns() const { return start_ns_; }
  double duration_s() const { return nodes_[static_cast<std::size_t>(count_)].after_s; }
  /// Position, velocity and acceleration so long after the path's start; at the start before it, at rest
  /// after the end.
  Node at_s(double after_s) const;
  Node at_ns(std::int64_t t_ns) const { return at_s(static_cast<double>(t_ns - start_ns_) * 1e-9); }
  const Node& first() const { return nodes_[0]; }
  /// Where the last phase ends, and how fast it still is then.
  const Node& last() const { return nodes_[static_cast<std::size_t>(count_)]; }
  int phase_count() const { return count_; }
  /// The state at the beginning of a phase.
  const Node& phase(int index) const { return nodes_[static_cast<std::size_t>(index)]; }
  /// No point of the path is farther from its first than this.
  double reach_m() const { return reach_m_; }
  double fastest_mps() const { return fastest_mps_; }

 private:
  std::int64_t start_ns_ = 0;
  int count_ = 0;
  std::array<Node, msg::MAX_PHASES + 1> nodes_{};  ///< the beginnings of the phases, and the end of the last
  double reach_m_ = 0;
  double fastest_mps_ = 0;
};

/// How near two paths come, and when, from the later start on, and not before a time.
struct Approach {
  double distance_m = std::numeric_limits<double>::infinity();
  std::int64_t at_ns = 0;
};

/// Looks from point to point as far apart as the relative speed allows without missing anything nearer than
/// `enough_m`, at most 0.25 ms apart where they are that near. Exact to micrometres below `enough_m`; above
/// it only a bound.
Approach nearest(const AuditPath& a, const AuditPath& b, double enough_m, std::int64_t from_ns = 0);
/// The same for a point that stays where it is.
Approach nearest(const AuditPath& path, double x_m, double y_m, double enough_m);

}  // namespace sidestep
