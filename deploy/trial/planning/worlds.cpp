// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/planning/worlds.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

#include "deploy/trial/planning/free_space.hpp"

namespace sidestep {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::size_t kCircles = 64;

Vec2 sample_position(const PlanWorld& world, Rng& rng) {
  const double x = world.field.length_m / 2, y = world.field.width_m / 2;
  return {rng.uniform(-x, x), rng.uniform(-y, y)};
}

Vec2 sample_free_position(const PlanWorld& world, Rng& rng) {
  for (;;) {
    Vec2 position = sample_position(world, rng);
    if (is_free(world, position)) return position;
  }
}

Vec2 sample_free_position(const PlanWorld& world, const Box& within, Rng& rng) {
  for (;;) {
    // y is sampled first, because the evaluation order of arguments would be unspecified.
    const double y = rng.uniform(within.min_m.y(), within.max_m.y());
    const double x = rng.uniform(within.min_m.x(), within.max_m.x());
    const Vec2 position(x, y);
    if (is_free(world, position)) return position;
  }
}

/// Adds solvable queries from one part of the field to another until the world has `queries` queries.
void add_queries_between(PlanWorld& world, const Box& from, const Box& to, std::size_t queries, Rng& rng) {
  const FreeSpace free_space(world);
  while (world.queries.size() < queries) {
    const Vec2 start = sample_free_position(world, from, rng), goal = sample_free_position(world, to, rng);
    if (free_space.connects(start, goal)) world.queries.push_back({start, goal});
  }
}

void add_circles(PlanWorld& world, std::size_t count, Rng& rng) {
  for (std::size_t i = 0; i < count; ++i)
    world.obstacles.push_back(Circle{sample_position(world, rng), rng.uniform(0.2, 0.6)});
}

ConvexPolygon random_polygon(const Vec2& centre, Rng& rng) {
  const auto corners = 3 + rng.below(4);
  const double radius = rng.uniform(0.25, 0.7), turn = rng.uniform(0, 2 * kPi);
  ConvexPolygon polygon;
  // Corners on a circle, one in each sector: convex and counter-clockwise.
  for (std::uint64_t i = 0; i < corners; ++i) {
    const double angle = turn + 2 * kPi * (static_cast<double>(i) + rng.uniform(0, 0.7)) / double(corners);
    polygon.corners_m.push_back(centre + radius * Vec2(std::cos(angle), std::sin(angle)));
  }
  return polygon;
}

void add_mixed_shapes(PlanWorld& world, std::size_t count_each, Rng& rng) {
  add_circles(world, count_each, rng);
  for (std::size_t i = 0; i < count_each; ++i) {
    const Vec2 centre = sample_position(world, rng);
    const double half_y = rng.uniform(0.1, 0.6), half_x = rng.uniform(0.1, 0.6);
    const Vec2 half(half_x, half_y);
    world.obstacles.push_back(Box{centre - half, centre + half});
    world.obstacles.push_back(random_polygon(sample_position(world, rng), rng));
    const Vec2 end = sample_position(world, rng);
    const double turn = rng.uniform(0, 2 * kPi), length_m = rng.uniform(0.5, 2);
    world.obstacles.push_back(Segment{end, end + rotated({length_m, 0}, turn)});
  }
}

/// A perfect maze: exactly one route joins any two cells (depth-first, from the first cell).
class Maze {
 public:
  Maze(std::size_t cells, Rng& rng)
      : cells_(cells), visited_(cells * cells), right_(cells * cells, true), up_(right_) {
    std::vector<std::size_t> route{0};
    visited_[0] = true;
    while (!route.empty()) {
      const auto neighbours = unvisited_neighbours(route.back());
      if (neighbours.empty()) {
        route.pop_back();
        continue;
      }
      const std::size_t next = neighbours[rng.below(neighbours.size())];
      open(route.back(), next);
      visited_[next] = true;
      route.push_back(next);
    }
  }

  /// The walls between cells, merged into maximal straight segments. Excludes the border of the field.
  std::vector<Segment> walls(double length_m) const {
    const double cell = length_m / static_cast<double>(cells_);
    std::vector<Segment> walls;
    for (const bool vertical : {true, false}) {
      for (std::size_t line = 0; line + 1 < cells_; ++line) {
        for (std::size_t i = 0, end = 0; i < cells_; i = end + 1) {
          for (end = i; end < cells_ && is_wall(vertical, line, end);) ++end;
          if (end == i) continue;
          const double position = static_cast<double>(line + 1) * cell - length_m / 2;
          const double from = static_cast<double>(i) * cell - length_m / 2;
          const double to = static_cast<double>(end) * cell - length_m / 2;
          walls.push_back(vertical ? Segment{{position, from}, {position, to}}
                                   : Segment{{from, position}, {to, position}});
        }
      }
    }
    return walls;
  }

 private:
  bool is_wall(bool vertical, std::size_t line, std::size_t i) const {
    return vertical ? right_[i * cells_ + line] : up_[line * cells_ + i];
  }
  std::vector<std::size_t> unvisited_neighbours(std::size_t cell) const {
    std::vector<std::size_t> found;
    const std::size_t x = cell % cells_, y = cell / cells_;
    if (x > 0 && !visited_[cell - 1]) found.push_back(cell - 1);
    if (x + 1 < cells_ && !visited_[cell + 1]) found.push_back(cell + 1);
    if (y > 0 && !visited_[cell - cells_]) found.push_back(cell - cells_);
    if (y + 1 < cells_ && !visited_[cell + cells_]) found.push_back(cell + cells_);
    return found;
  }
  void open(std::size_t a, std::size_t b) {
    (std::max(a, b) - std::min(a, b) == 1 ? right_ : up_)[std::min(a, b)] = false;
  }

  std::size_t cells_;
  std::vector<bool> visited_, right_, up_;
};

void make_maze(PlanWorld& world, std::size_t queries, Rng& rng) {
  for (const Segment& wall : Maze(7, rng).walls(world.field.length_m)) world.obstacles.push_back(wall);
  add_queries_across(world, queries, rng);
}

/// A wall with a gap that is 20 % wider than the robot.
void make_gap(PlanWorld& world, std::size_t queries, Rng& rng) {
  const double half = world.radius_m * 1.2, middle = 1;
  world.obstacles = {Box{{-0.2, -5}, {0.2, middle - half}}, Box{{-0.2, middle + half}, {0.2, 5}}};
  add_queries_between(world, {{-5, -5}, {-0.2, 5}}, {{0.2, -5}, {5, 5}}, queries, rng);
}

/// A chamber whose opening is a funnel that points inwards: following the walls does not lead out.
void make_trap(PlanWorld& world, std::size_t queries, Rng& rng) {
  world.obstacles = {Box{{-3, 2.8}, {3, 3}}, Box{{-3, -3}, {3, -2.8}}, Box{{-3, -2.8}, {-2.8, 2.8}},
                     ConvexPolygon{{{2.8, 2.8}, {0.5, 0.3}, {0.6, 0.12}, {3, 2.8}}},
                     ConvexPolygon{{{2.8, -2.8}, {3, -2.8}, {0.6, -0.12}, {0.5, -0.3}}}};
  add_queries_between(world, {{-2.8, -2.8}, {0, 2.8}}, {{3.1, -5}, {5, 5}}, queries, rng);
}

void make_u(PlanWorld& world, std::size_t queries, Rng& rng) {
  world.obstacles = {Box{{-2, 2}, {2, 2.3}}, Box{{-2, -2.3}, {2, -2}}, Box{{2, -2.3}, {2.3, 2.3}}};
  add_queries_between(world, {{-1, -1.9}, {1.9, 1.9}}, {{2.4, -2}, {5, 2}}, queries, rng);
}

}  // namespace

const std::vector<std::string>& world_names() {
  static const std::vector<std::string> names{"empty", "circles", "mixed", "maze", "gap", "trap", "u"};
  return names;
}

PlanWorld make_world(const std::string& name, std::size_t queries, std::uint64_t seed) {
  Rng rng(seed);
  PlanWorld world;
  world.name = name;
  if (name == "empty") {
    add_queries_across(world, queries, rng);
  } else if (name == "circles") {
    return make_circles(kCircles, queries, seed);
  } else if (name == "mixed") {
    add_mixed_shapes(world, 12, rng);
    add_queries_across(world, queries, rng);
  } else if (name == "maze") {
    make_maze(world, queries, rng);
  } else if (name == "gap") {
    make_gap(world, queries, rng);
  } else if (name == "trap") {
    make_trap(world, queries, rng);
  } else if (name == "u") {
    make_u(world, queries, rng);
  } else {
    throw std::invalid_argument(
        fmt::format("world: expected one of {}, got \"{}\"", fmt::join(world_names(), ", "), name));
  }
  return world;
}

PlanWorld make_circles(std::size_t circles, std::size_t queries, std::uint64_t seed) {
  Rng rng(seed);
  PlanWorld world;
  world.name = "circles";
  const double scale = std::sqrt(static_cast<double>(circles) / kCircles);
  world.field = {scale * world.field.length_m, scale * world.field.width_m};
  add_circles(world, circles, rng);
  add_queries_across(world, queries, rng);
  return world;
}

void add_queries_across(PlanWorld& world, std::size_t queries, Rng& rng) {
  const FreeSpace free_space(world);
  while (world.queries.size() < queries) {
    const Vec2 start = sample_free_position(world, rng), goal = sample_free_position(world, rng);
    if ((start - goal).norm() < world.field.length_m / 2) continue;
    if (free_space.connects(start, goal)) world.queries.push_back({start, goal});
  }
}

bool is_free(const PlanWorld& world, const Vec2& position_m) { return is_valid_path(world, {position_m}, 0); }

bool is_valid_path(const PlanWorld& world, const std::vector<Vec2>& path_m, double slack_m) {
  if (path_m.empty()) return false;
  const double radius_m = world.radius_m - slack_m;
  const auto is_in_field = [&](const Vec2& p) { return world.field.contains(p, radius_m); };
  if (!std::all_of(path_m.begin(), path_m.end(), is_in_field)) return false;
  for (const Shape& shape : world.obstacles) {
    const RoundedShape obstacle = rounded(shape);
    for (std::size_t i = 0; i < path_m.size(); ++i) {
      const Vec2 leg[2] = {path_m[i > 0 ? i - 1 : 0], path_m[i]};
      if (closest_points(leg, obstacle.corners_m).distance_m - obstacle.radius_m <= radius_m) return false;
    }
  }
  return true;
}

}  // namespace sidestep
