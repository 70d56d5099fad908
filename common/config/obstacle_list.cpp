// SPDX-License-Identifier: Apache-2.0
#include "common/config/obstacle_list.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fmt/format.h>
#include <optional>
#include <stdexcept>

#include "common/file/home_folder.hpp"
#include "common/map/map_file.hpp"
#include "common/yaml/yaml_schema.hpp"

namespace sidestep {
namespace {

constexpr Range kPlace_m{-1000, 1000}, kSize_m{0.001, 1000};
constexpr std::size_t kMaxCorners = 1000;
constexpr std::size_t kMaxPieces = 10'000;  // total for all walls; also the maximum number of other obstacles

Vec2 point(YamlMap& map, const std::string& key) {
  Vec2 value(0, 0);
  map.require(key);
  map.read(key, kPlace_m, value);
  return value;
}

double size_m(YamlMap& map, const std::string& key) {
  double value = 0;
  map.require(key);
  map.read(key, kSize_m, value);
  return value;
}

std::vector<Vec2> points(YamlMap& map, const std::string& key, std::size_t min_count) {
  (void)map.require(key);
  return map.points(key, min_count, kMaxCorners, kPlace_m);
}

/// The rectangle around a straight piece of a wall. It extends beyond both ends by half the thickness, so
/// that the pieces leave no notch between them.
Shape wall_piece(const Vec2& from, const Vec2& to, double thickness_m) {
  const Vec2 along = thickness_m / 2 * (to - from).stableNormalized(), aside(-along.y(), along.x());
  if (along.x() == 0 || along.y() == 0) {
    const Vec2 reach = (along + aside).cwiseAbs();
    return Box{from.cwiseMin(to) - reach, from.cwiseMax(to) + reach};
  }
  return ConvexPolygon{{from - along - aside, to + along - aside, to + along + aside, from - along + aside}};
}

void read_wall(YamlMap& map, std::vector<Shape>& shapes) {
  const std::vector<Vec2> path = points(map, "points_m", 2);
  const double thickness_m = size_m(map, "thickness_m");
  for (std::size_t i = 1; i < path.size(); ++i) {
    if (path[i] == path[i - 1]) map.location_of("points_m").fail("two successive points are identical");
    shapes.push_back(wall_piece(path[i - 1], path[i], thickness_m));
  }
}

void read_disc(YamlMap& map, std::vector<Shape>& shapes) {
  shapes.push_back(Circle{point(map, "centre_m"), size_m(map, "radius_m")});
}

struct ObstacleKind {
  const char* key;
  void (*read)(YamlMap& map, std::vector<Shape>& shapes);
};

constexpr std::array kObstacleKinds{
    ObstacleKind{"circle", read_disc},
    ObstacleKind{"box",
                 [](YamlMap& map, std::vector<Shape>& shapes) {
                   shapes.push_back(Box{point(map, "min_m"), point(map, "max_m")});
                 }},
    ObstacleKind{"polygon",
                 [](YamlMap& map, std::vector<Shape>& shapes) {
                   shapes.push_back(ConvexPolygon{points(map, "corners_m", 3)});
                 }},
    ObstacleKind{"segment",
                 [](YamlMap& map, std::vector<Shape>& shapes) {
                   shapes.push_back(Segment{point(map, "from_m"), point(map, "to_m")});
                 }},
    ObstacleKind{"wall", read_wall}};

/// Describes obstacles of each kind, and circles in their short form.
void describe_obstacle(YamlMap& map, YamlSchema& schema) {
  std::vector<Shape> ignored;
  std::vector<std::string> keys;
  for (const ObstacleKind& kind : kObstacleKinds) keys.push_back(kind.key);
  keys.emplace_back("centre_m");
  const std::string& key = schema.choose(keys);
  const auto kind = std::ranges::find(kObstacleKinds, key, &ObstacleKind::key);
  if (kind == kObstacleKinds.end()) return read_disc(map, ignored);
  read_section(map, key, [&](YamlMap& inner) { kind->read(inner, ignored); });
}

void read_obstacle(YamlMap& map, std::vector<Shape>& shapes) {
  if (YamlSchema* const schema = map.schema()) return describe_obstacle(map, *schema);
  const std::size_t before = shapes.size();
  int kinds = 0;
  for (const ObstacleKind& kind : kObstacleKinds) {
    read_section(map, kind.key, [&](YamlMap& inner) {
      ++kinds;
      kind.read(inner, shapes);
    });
  }
  if (kinds == 0 && (map.find("centre_m").IsDefined() || map.find("radius_m").IsDefined())) {
    ++kinds;
    read_disc(map, shapes);
  }
  map.finish();
  if (kinds != 1) map.location().fail("expected one of circle, box, polygon, segment, wall");
  for (std::size_t i = before; i < shapes.size(); ++i) {
    try {
      check(shapes[i]);
    } catch (const std::invalid_argument& wrong) {
      map.location().fail(wrong.what());
    }
  }
}

std::string text_of(const Vec2& p) { return fmt::format("[{}, {}]", p.x(), p.y()); }
std::string text_of(const Circle& circle) {
  return fmt::format("circle: {{centre_m: {}, radius_m: {}}}", text_of(circle.centre_m), circle.radius_m);
}
std::string text_of(const Box& box) {
  return fmt::format("box: {{min_m: {}, max_m: {}}}", text_of(box.min_m), text_of(box.max_m));
}
std::string text_of(const Segment& segment) {
  return fmt::format("segment: {{from_m: {}, to_m: {}}}", text_of(segment.from_m), text_of(segment.to_m));
}
std::string text_of(const ConvexPolygon& polygon) {
  std::string corners;
  for (const Vec2& corner : polygon.corners_m) corners += (corners.empty() ? "" : ", ") + text_of(corner);
  return fmt::format("polygon: {{corners_m: [{}]}}", corners);
}

/// A notice for the user about unknown cells and a rotation of the map; empty if there are none.
std::string map_notice(const LoadedMap& map, const std::string& name, const std::string& unknown) {
  std::string text;
  if (map.unknown > 0)
    text = fmt::format("map {}: {} of {} cells are unknown; they count as {}{}", name, map.unknown,
                       std::int64_t{map.cells.grid().columns} * map.cells.grid().rows, unknown,
                       unknown == "free" ? "" : ", unless the scenario says `unknown: free`");
  if (map.yaw_rad != 0)
    text += fmt::format(
        "{}map {} is rotated by {:.6g} rad; coordinates of the scenario follow its rows and "
        "columns, those of other programs are rotated by this angle",
        text.empty() ? "" : "; ", name, map.yaw_rad);
  return text;
}

}  // namespace

std::vector<Shape> read_obstacles(YamlMap& map, std::size_t max_count) {
  std::vector<Shape> shapes;
  read_optional_list(map, "obstacles", 0, max_count, [&](YamlMap& obstacle) {
    read_obstacle(obstacle, shapes);
    if (shapes.size() > kMaxPieces)
      map.location_of("obstacles").fail(fmt::format("the walls have more than {} pieces", kMaxPieces));
  });
  return shapes;
}

std::string obstacle_text(const Shape& shape) {
  return std::visit([](const auto& s) { return text_of(s); }, shape);
}

std::shared_ptr<const FloorMap> read_floor_map(YamlMap& map, const OccupancyMap* cells) {
  const auto name = map.text("map");
  const YamlLocation location = map.location_of("map");
  constexpr std::array<std::string_view, 2> kUnknown{"blocked", "free"};
  std::string unknown{kUnknown[0]};
  map.read("unknown", kUnknown, unknown);
  if (map.schema()) return nullptr;
  if (!name && map.find("unknown").IsDefined())
    map.location_of("unknown").fail("expected only together with the key map");
  if (!name) return nullptr;
  if (name->empty()) location.fail("expected the path of a map's YAML file, got nothing");
  const std::string path = (std::filesystem::path(location.file).parent_path() / expand_home(*name)).string();
  try {
    if (cells != nullptr) return std::make_shared<const FloorMap>(*cells, *name);
    LoadedMap loaded = load_map(path, unknown == kUnknown[1] ? UnknownCells::kFree : UnknownCells::kBlocked);
    const std::string notice = map_notice(loaded, *name, unknown);
    return std::make_shared<const FloorMap>(std::move(loaded.cells), *name, notice);
  } catch (const std::exception& error) {
    location.fail(error.what());
  }
}

}  // namespace sidestep
