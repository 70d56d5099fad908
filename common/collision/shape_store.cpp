// SPDX-License-Identifier: Apache-2.0
#include "common/collision/shape_store.hpp"

#include <array>
#include <limits>

namespace sidestep {
namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
// Number of records beyond the slots. Kernels may look up any bit of the last word, and index 64 for a
// missing bit.
constexpr std::size_t kPaddingRecords = 128;

bool touches_one(const void* store, Slot slot, const double* from_m, const double* to_m, double radius_m) {
  return static_cast<const ShapeStore*>(store)->touches(
      slot, Sweep(Vec2(from_m[0], from_m[1]), Vec2(to_m[0], to_m[1]), radius_m));
}

}  // namespace

float rounded_down(double value) { return std::nextafter(static_cast<float>(value), -kInfinite); }
float rounded_up(double value) { return std::nextafter(static_cast<float>(value), kInfinite); }

ShapeStore::ShapeStore(std::vector<Shape> shapes) : records_(kPaddingRecords) {
  if (shapes.empty()) return;
  Box box = bounds(shapes.front());
  for (const Shape& shape : shapes) box = united(box, bounds(shape));
  origin_m_ = 0.5 * box.min_m + 0.5 * box.max_m;
  for (Shape& shape : shapes) add(std::move(shape));
}

Slot ShapeStore::add(Shape shape) {
  Slot slot = end();
  if (free_.empty()) {
    shapes_.push_back(std::move(shape));
    indices_.push_back(kUnused);
    records_.emplace_back();
  } else {
    slot = free_.back();
    free_.pop_back();
    shapes_[slot] = std::move(shape);
  }
  indices_[slot] = static_cast<std::uint32_t>(slots_.size());
  slots_.push_back(slot);
  records_[slot].edges = kUnused;
  write_record(slot);
  return slot;
}

void ShapeStore::replace(Slot slot, Shape shape) {
  shapes_[slot] = std::move(shape);
  write_record(slot);
}

void ShapeStore::remove(Slot slot) {
  indices_[slots_.back()] = indices_[slot];
  slots_[indices_[slot]] = slots_.back();
  slots_.pop_back();
  indices_[slot] = kUnused;
  shapes_[slot] = Circle{};
  if (records_[slot].edges != kUnused) unused_edges_ += edges_[records_[slot].edges].following + 1;
  if (unused_edges_ > edges_.size() / 2) rebuild_edges();
  free_.push_back(slot);
}

void ShapeStore::write_record(Slot slot) {
  const Shape& shape = shapes_[slot];
  const Box box = bounds(shape);
  max_coordinate_m_ = std::max({max_coordinate_m_, (box.min_m - origin_m_).cwiseAbs().maxCoeff(),
                                (box.max_m - origin_m_).cwiseAbs().maxCoeff()});
  if (const auto* circle = std::get_if<Circle>(&shape)) {
    const Vec2 centre = circle->centre_m - origin_m_;
    records_[slot] = {static_cast<float>(centre.x()), static_cast<float>(centre.y()),
                      static_cast<float>(circle->radius_m), kUnused};
    max_radius_m_ = std::max(max_radius_m_, circle->radius_m);
  } else if (std::holds_alternative<Box>(shape)) {
    write_edges(slot, corners_of(std::get<Box>(shape)));
  } else if (const auto* polygon = std::get_if<ConvexPolygon>(&shape)) {
    write_edges(slot, polygon->corners_m);
  } else {
    write_edges(slot, std::array{std::get<Segment>(shape).from_m, std::get<Segment>(shape).to_m});
  }
}

void ShapeStore::write_edges(Slot slot, std::span<const Vec2> corners) {
  const auto blocks = static_cast<std::uint32_t>((corners.size() + 3) / 4);
  std::uint32_t& first = records_[slot].edges;
  if (first == kUnused) {
    first = static_cast<std::uint32_t>(edges_.size());
    edges_.resize(edges_.size() + blocks);
  }
  records_[slot] = {0, 0, kNan, first};
  for (std::uint32_t i = 0; i < 4 * blocks; ++i) {
    collision::EdgeBlock& block = edges_[first + i / 4];
    const std::size_t at = std::min<std::size_t>(i, corners.size() - 1);
    const Vec2 begin = corners[at] - origin_m_, edge = corners[(at + 1) % corners.size()] - corners[at];
    const Vec2 along = edge / std::max(edge.squaredNorm(), 1e-24);
    block.x_m[i % 4] = static_cast<float>(begin.x());
    block.y_m[i % 4] = static_cast<float>(begin.y());
    block.edge_x_m[i % 4] = static_cast<float>(edge.x());
    block.edge_y_m[i % 4] = static_cast<float>(edge.y());
    block.along_x_per_m[i % 4] = static_cast<float>(along.x());
    block.along_y_per_m[i % 4] = static_cast<float>(along.y());
    block.following = blocks - 1 - i / 4;
  }
}

void ShapeStore::rebuild_edges() {
  edges_.clear();
  unused_edges_ = 0;
  for (const Slot slot : slots_) {
    records_[slot].edges = kUnused;
    write_record(slot);
  }
}

bool ShapeStore::touches(Slot slot, const Sweep& sweep) const {
  if (const auto* circle = std::get_if<Circle>(&shapes_[slot])) return sweep.touches(*circle);
  return squared_distance(sweep.segment(), shapes_[slot]) <= sweep.radius_m * sweep.radius_m;
}

void ShapeStore::compare(Slot slot, const Vec2& at, NearestSlot& nearest) const {
  const double distance_m = signed_distance(at, shapes_[slot]);
  if (distance_m < nearest.distance_m) nearest = {distance_m, slot};
}

NearestSlot ShapeStore::nearest(const Vec2& at) const {
  NearestSlot nearest;
  const Vec2 location = at - origin_m_;
  const double slack_m = 8 * 0x1p-24 * (max_coordinate_m_ + max_radius_m_);
  for (const Slot slot : slots_) {
    const collision::ShapeRecord& circle = records_[slot];
    const double dx = circle.x_m - location.x(), dy = circle.y_m - location.y();
    const double reach = nearest.distance_m + circle.radius_m + slack_m;
    // Negated to include shapes other than circles, whose radius is NaN.
    if (!(dx * dx + dy * dy > reach * reach)) compare(slot, at, nearest);
  }
  return nearest;
}

collision::ShapesView ShapeStore::view() const {
  // A coordinate up to L has a rounding error of L * kRounding, a difference of two coordinates one of 2 L *
  // kRounding. Including the error of the projection onto the path and perpendicular to it, distances are
  // wrong by less than 16 L * kRounding.
  constexpr double kRounding = 0x1p-24;
  const double limit_m = 4 * max_coordinate_m_, error_m = 16 * kRounding * limit_m;
  // If a distance has an error e, a squared distance near the squared sum of radii R is wrong by at most 2 R
  // e + e^2. Crossing edges may appear up to 2 e apart.
  return {{origin_m_.x(), origin_m_.y()},
          rounded_down(limit_m),
          rounded_up(error_m),
          rounded_up(2 * error_m),
          rounded_up(2 * error_m * (max_radius_m_ + 5 * error_m)),
          records_.data(),
          edges_.data(),
          touches_one,
          this};
}

}  // namespace sidestep
