// SPDX-License-Identifier: Apache-2.0
#include "common/map/floor_map.hpp"

#include <bit>
#include <fmt/format.h>
#include <stdexcept>
#include <utility>

namespace sidestep {
namespace {

std::vector<Box> rectangles_of(const OccupancyMap& map) {
  std::optional<std::vector<Box>> found = map.rectangles(FloorMap::kMaxRectangles);
  if (found) return std::move(*found);
  throw std::invalid_argument(
      fmt::format("the map's blocked cells form more than {} rectangles", FloorMap::kMaxRectangles));
}

/// FNV-1a, computed word by word.
std::uint64_t fingerprint_of(const OccupancyMap& map) {
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto add = [&hash](std::uint64_t word) { hash = (hash ^ word) * 0x100000001b3, hash ^= hash >> 32; };
  const MapGrid& grid = map.grid();
  add(static_cast<std::uint64_t>(grid.columns));
  add(static_cast<std::uint64_t>(grid.rows));
  for (const double number : {grid.resolution_m, grid.origin_m.x(), grid.origin_m.y()})
    add(std::bit_cast<std::uint64_t>(number));
  for (int row = 0; row < grid.rows; ++row)
    for (int i = 0; i < map.blocked().words_per_row(); ++i) add(map.blocked().word(i, row));
  return hash;
}

}  // namespace

FloorMap::FloorMap(OccupancyMap map, std::string name, std::string notice)
    : name_(std::move(name)),
      notice_(std::move(notice)),
      cells_(std::move(map)),
      field_(cells_),
      rectangles_(rectangles_of(cells_)),
      fingerprint_(fingerprint_of(cells_)) {}

std::vector<Box> FloorMap::boxes_on(const Field& field) const {
  std::vector<Box> boxes = rectangles_;
  constexpr double kOutsideDepth_m = 10;  // more than the radius plus margin of any robot
  const Vec2 half_m(field.length_m / 2 + kOutsideDepth_m, field.width_m / 2 + kOutsideDepth_m);
  const Box inside = cells_.extent();
  const auto add = [&](const Vec2& min_m, const Vec2& max_m) {
    if ((min_m.array() < max_m.array()).all()) boxes.push_back({min_m, max_m});
  };
  add(-half_m, {inside.min_m.x(), half_m.y()});
  add(-half_m, {half_m.x(), inside.min_m.y()});
  add({inside.max_m.x(), -half_m.y()}, half_m);
  add({-half_m.x(), inside.max_m.y()}, half_m);
  return boxes;
}

std::optional<Circle> FloorMap::disc_facing(const Vec2& p, double within_m) const {
  if (field_.lower_bound_m(p) > within_m) return std::nullopt;
  std::optional<Circle> nearest;
  double nearest_m = within_m;
  const Vec2 half_m(within_m, within_m);
  cells_.for_each_box({p - half_m, p + half_m}, [&](const Box& box) {
    const double distance_m = signed_distance(p, box);
    if (distance_m > nearest_m) return true;
    nearest_m = distance_m;
    nearest = sidestep::disc_facing(p, box);
    return true;
  });
  return nearest;
}

}  // namespace sidestep
