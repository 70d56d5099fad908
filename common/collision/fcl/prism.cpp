// SPDX-License-Identifier: Apache-2.0
#include "common/collision/fcl/prism.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/convex.h>
#include <numbers>
#include <span>
#include <stdexcept>

namespace sidestep {
namespace {

/// The prism over a convex polygon: its corners below and above the floor, counter-clockwise, and the faces
/// between them.
Solid polygon_prism(std::span<const Vec2> corners, double height_m) {
  const auto count = static_cast<int>(corners.size());
  auto points = std::make_shared<std::vector<Eigen::Vector3d>>();
  auto faces = std::make_shared<std::vector<int>>();
  for (const double z : {-height_m / 2, height_m / 2})
    for (const Vec2& corner : corners) points->emplace_back(corner.x(), corner.y(), z);
  faces->push_back(count);
  for (int i = 0; i < count; ++i) faces->push_back(count - 1 - i);
  faces->push_back(count);
  for (int i = 0; i < count; ++i) faces->push_back(count + i);
  for (int i = 0; i < count; ++i) {
    const int next = (i + 1) % count;
    faces->insert(faces->end(), {4, i, next, count + next, count + i});
  }
  return std::make_shared<fcl::Convexd>(points, count + 2, faces, true);
}

/// The vertical rectangle over a segment.
Solid wall(const Segment& segment, double height_m) {
  const Eigen::Vector3d up(0, 0, height_m / 2);
  const Eigen::Vector3d from(segment.from_m.x(), segment.from_m.y(), 0),
      to(segment.to_m.x(), segment.to_m.y(), 0);
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  model->beginModel(2, 4);
  model->addSubModel({from - up, to - up, to + up, from + up},
                     std::vector<fcl::Triangle>{{0, 1, 2}, {0, 2, 3}});
  model->endModel();
  return model;
}

}  // namespace

Solid prism(const Shape& shape, double height_m) {
  check(shape);
  if (!(height_m > 0 && std::isfinite(height_m)))
    throw std::invalid_argument("a prism's height has to be > 0");
  if (const auto* circle = std::get_if<Circle>(&shape)) {
    // FCL's cylinders must be centred on the origin, so the circle is replaced by a circumscribed polygon,
    // whose error is 0.03 % of the radius.
    constexpr int kCorners = 128;
    std::vector<Vec2> corners;
    corners.reserve(kCorners);
    const double corner_radius_m = circle->radius_m / std::cos(std::numbers::pi / kCorners);
    for (int i = 0; i < kCorners; ++i)
      corners.push_back(circle->centre_m +
                        rotated(Vec2(corner_radius_m, 0), 2 * std::numbers::pi * i / kCorners));
    return polygon_prism(corners, height_m);
  }
  if (const auto* box = std::get_if<Box>(&shape)) return polygon_prism(corners_of(*box), height_m);
  if (const auto* polygon = std::get_if<ConvexPolygon>(&shape))
    return polygon_prism(polygon->corners_m, height_m);
  return wall(std::get<Segment>(shape), height_m);
}

}  // namespace sidestep
