// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/collision/shapes.hpp"
#include "deploy/audit/audit_path.hpp"

namespace sidestep {

/// A static obstacle, for the auditor only: its corners, counter-clockwise, and a radius around them. The
/// arithmetic is deliberately independent of common/collision and common/motion.
class AuditShape {
 public:
  explicit AuditShape(const Shape& shape);

  /// Distance of a point from the edge; 0 inside.
  double distance_m(double x_m, double y_m) const;

 private:
  struct Corner {
    double x, y;
  };
  std::vector<Corner> corners_;
  double radius_m_ = 0;
};

/// The closest approach of a path to an obstacle's edge.
[[nodiscard]] ClosestApproach closest_approach(const AuditPath& path, const AuditShape& obstacle,
                                               double cutoff_m);

}  // namespace sidestep
