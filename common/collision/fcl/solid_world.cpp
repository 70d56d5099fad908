// SPDX-License-Identifier: Apache-2.0
#include "common/collision/fcl/solid_world.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/narrowphase/distance.h>
#include <limits>
#include <string>

namespace sidestep {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

bool find_distance(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* nearest, double& bound) {
  fcl::DistanceResultd result;
  double& nearest_m = *static_cast<double*>(nearest);
  // With FCL's own choice of solver and tolerance one distance in forty is too large, by up to centimetres.
  const fcl::DistanceRequestd request(false, false, 0, 0, 1e-9, fcl::GST_INDEP);
  fcl::distance(a, b, request, result);
  // Where shapes overlap, FCL gives -1 or some other negative number.
  nearest_m = std::min(nearest_m, std::max(0.0, result.min_distance));
  bound = nearest_m;
  return nearest_m == 0;
}

/// Its corners below and above the floor, counter-clockwise, and the faces between them.
Solid prism(std::span<const Vec2> corners, double height_m) {
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

}  // namespace

Solid mesh(std::span<const Eigen::Vector3d> corners, std::span<const std::array<std::size_t, 3>> triangles) {
  if (triangles.empty()) throw std::invalid_argument("a mesh has no triangles");
  std::vector<fcl::Triangle> faces;
  for (const auto& [a, b, c] : triangles) {
    if (std::max({a, b, c}) >= corners.size())
      throw std::invalid_argument("a mesh's triangle has no such corner");
    faces.emplace_back(a, b, c);
  }
  for (const Eigen::Vector3d& corner : corners)
    if (!corner.allFinite()) throw std::invalid_argument("a mesh's corner is not finite");
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  model->beginModel(static_cast<int>(faces.size()), static_cast<int>(corners.size()));
  model->addSubModel({corners.begin(), corners.end()}, faces);
  model->endModel();
  return model;
}

Solid prism(const Shape& shape, double height_m) {
  check(shape);
  if (!(height_m > 0 && std::isfinite(height_m)))
    throw std::invalid_argument("a prism's height is not above 0");
  if (const auto* circle = std::get_if<Circle>(&shape)) {
    // FCL has cylinders around the origin only, so it is a polygon around the circle: wrong by 0.03 % of its
    // radius.
    constexpr int kCorners = 128;
    std::vector<Vec2> corners;
    const double out_m = circle->radius_m / std::cos(3.14159265358979 / kCorners);
    for (int i = 0; i < kCorners; ++i)
      corners.push_back(circle->centre_m + rotated(Vec2(out_m, 0), 2 * 3.14159265358979 * i / kCorners));
    return prism(corners, height_m);
  }
  if (const auto* box = std::get_if<Box>(&shape)) return prism(corners_of(*box), height_m);
  if (const auto* polygon = std::get_if<ConvexPolygon>(&shape)) return prism(polygon->corners_m, height_m);
  const auto& segment = std::get<Segment>(shape);
  const Eigen::Vector3d up(0, 0, height_m / 2);
  const Eigen::Vector3d from(segment.from_m.x(), segment.from_m.y(), 0),
      to(segment.to_m.x(), segment.to_m.y(), 0);
  const std::vector<Eigen::Vector3d> corners{from - up, to - up, to + up, from + up};
  return mesh(corners, std::vector<std::array<std::size_t, 3>>{{0, 1, 2}, {0, 2, 3}});
}

SolidWorld::Id SolidWorld::add(Solid solid, const Eigen::Isometry3d& place) {
  auto object = std::make_unique<fcl::CollisionObjectd>(std::move(solid), place);
  object->computeAABB();
  manager_.registerObject(object.get());
  manager_.setup();
  objects_.emplace(next_, std::move(object));
  return next_++;
}

void SolidWorld::move(Id id, const Eigen::Isometry3d& place) {
  fcl::CollisionObjectd& moved = object(id);
  moved.setTransform(place);
  moved.computeAABB();
  manager_.update(&moved);
}

void SolidWorld::remove(Id id) {
  manager_.unregisterObject(&object(id));
  objects_.erase(id);
}

double SolidWorld::clearance_m(const Solid& body, const Eigen::Isometry3d& place) const {
  fcl::CollisionObjectd query(body, place);
  query.computeAABB();
  double nearest_m = kInfinite;
  manager_.distance(&query, &nearest_m, find_distance);
  return nearest_m;
}

fcl::CollisionObjectd& SolidWorld::object(Id id) {
  const auto found = objects_.find(id);
  if (found == objects_.end()) throw std::invalid_argument("there is no solid " + std::to_string(id));
  return *found->second;
}

}  // namespace sidestep
