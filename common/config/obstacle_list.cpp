// SPDX-License-Identifier: Apache-2.0
#include "common/config/obstacle_list.hpp"

#include <array>
#include <filesystem>
#include <fmt/format.h>
#include <optional>
#include <stdexcept>

#include "common/file/home_folder.hpp"
#include "common/map/map_file.hpp"

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

std::vector<Vec2> points(YamlMap& map, const std::string& key) {
  std::vector<Vec2> found;
  const YamlLocation location = map.location_of(key);
  for (const YAML::Node& element : list_from(map.require(key), location, kMaxCorners)) {
    const auto numbers = numbers_from(element, location.of(element, location.what), 2, 2, kPlace_m);
    found.emplace_back(numbers[0], numbers[1]);
  }
  return found;
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
  const std::vector<Vec2> path = points(map, "points_m");
  const double thickness_m = size_m(map, "thickness_m");
  if (path.size() < 2) map.location_of("points_m").fail("expected at least two points");
  for (std::size_t i = 1; i < path.size(); ++i) {
    if (path[i] == path[i - 1]) map.location_of("points_m").fail("two successive points are identical");
    shapes.push_back(wall_piece(path[i - 1], path[i], thickness_m));
  }
}

void read_obstacle(YamlMap& map, std::vector<Shape>& shapes) {
  const std::size_t before = shapes.size();
  int kinds = 0;
  const auto read_kind = [&](const char* key, const auto& read) {
    read_section(map, key, [&](YamlMap& inner) {
      ++kinds;
      read(inner);
    });
  };
  const auto read_circle = [&](YamlMap& inner) {
    shapes.push_back(Circle{point(inner, "centre_m"), size_m(inner, "radius_m")});
  };
  read_kind("circle", read_circle);
  read_kind("box", [&](YamlMap& inner) {
    shapes.push_back(Box{point(inner, "min_m"), point(inner, "max_m")});
  });
  read_kind("polygon", [&](YamlMap& inner) { shapes.push_back(ConvexPolygon{points(inner, "corners_m")}); });
  read_kind("segment", [&](YamlMap& inner) {
    shapes.push_back(Segment{point(inner, "from_m"), point(inner, "to_m")});
  });
  read_kind("wall", [&](YamlMap& inner) { read_wall(inner, shapes); });
  if (kinds == 0 && (map.find("centre_m").IsDefined() || map.find("radius_m").IsDefined())) {
    ++kinds;
    read_circle(map);
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
  const YAML::Node node = map.find("obstacles");
  if (!node.IsDefined()) return shapes;
  const YamlLocation location = map.location_of("obstacles");
  const std::vector<YAML::Node> elements = list_from(node, location, max_count);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    YamlMap inner(elements[i], location.of(elements[i], fmt::format("obstacles[{}]", i)));
    read_obstacle(inner, shapes);
    if (shapes.size() > kMaxPieces)
      location.fail(fmt::format("the walls have more than {} pieces", kMaxPieces));
  }
  return shapes;
}

std::string obstacle_text(const Shape& shape) {
  return std::visit([](const auto& s) { return text_of(s); }, shape);
}

std::shared_ptr<const FloorMap> read_floor_map(YamlMap& map, const OccupancyMap* cells) {
  const YAML::Node node = map.find("map");
  const YamlLocation location = map.location_of("map");
  constexpr std::array<std::string_view, 2> kUnknown{"blocked", "free"};
  std::string unknown{kUnknown[0]};
  map.read("unknown", kUnknown, unknown);
  if (!node.IsDefined() && map.find("unknown").IsDefined())
    map.location_of("unknown").fail("expected only together with the key map");
  if (!node.IsDefined()) return nullptr;
  const std::string name = text_from(node, location);
  if (name.empty()) location.fail("expected the path of a map's YAML file, got nothing");
  const std::string path = (std::filesystem::path(location.file).parent_path() / expand_home(name)).string();
  try {
    if (cells != nullptr) return std::make_shared<const FloorMap>(*cells, name);
    LoadedMap loaded = load_map(path, unknown == kUnknown[1] ? UnknownCells::kFree : UnknownCells::kBlocked);
    const std::string notice = map_notice(loaded, name, unknown);
    return std::make_shared<const FloorMap>(std::move(loaded.cells), name, notice);
  } catch (const std::exception& error) {
    location.fail(error.what());
  }
}

}  // namespace sidestep
