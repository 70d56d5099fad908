// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/collision/shapes.hpp"
#include "common/geometry/field.hpp"
#include "common/map/distance_field.hpp"

namespace sidestep {

/// The map of a floor, with data that is computed from it once. Const functions are thread-safe and do not
/// allocate.
class FloorMap {
 public:
  static constexpr std::size_t kMaxRectangles = 20'000;

  /// `name` is the name of the map's file, for messages. Throws std::invalid_argument if the blocked cells
  /// form more than kMaxRectangles rectangles: paths around them would take too long.
  explicit FloorMap(OccupancyMap map, std::string name = "map", std::string notice = "");

  const std::string& name() const { return name_; }
  /// A notice about the map for the user, in one line; empty if there is none. Programs print it at start.
  const std::string& notice() const { return notice_; }
  const OccupancyMap& cells() const { return cells_; }
  const DistanceField& field() const { return field_; }
  /// Rectangles that together cover exactly the blocked cells, without the outside. They may overlap.
  const std::vector<Box>& rectangles() const { return rectangles_; }
  /// Boxes that cover the blocked cells, and the outside of the map within a field and 10 m around it.
  std::vector<Box> boxes_on(const Field& field) const;
  /// Hash of the cells; maps whose cells differ in place or state have different hashes.
  std::uint64_t fingerprint() const { return fingerprint_; }

  /// A disc that stands in for the nearest blocked cell or the outside of the map: at the same distance and
  /// in the same direction from `p`, like disc_facing(Vec2, Shape). nullopt if neither is within `within_m`.
  std::optional<Circle> disc_facing(const Vec2& p, double within_m) const;

 private:
  std::string name_, notice_;
  OccupancyMap cells_;
  DistanceField field_;
  std::vector<Box> rectangles_;
  std::uint64_t fingerprint_;
};

}  // namespace sidestep
