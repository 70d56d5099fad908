// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/planning/free_space.hpp"

#include <limits>
#include <numeric>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::free_space_test {

/// Labels the connected cells of a grid by flood fill, with distances from signed_distance().
class Grid {
 public:
  Grid(const PlanWorld& world, double cell_m) : cell_m_(cell_m) {
    columns_ = static_cast<int>(std::lround(world.field.length_m / cell_m));
    rows_ = static_cast<int>(std::lround(world.field.width_m / cell_m));
    corner_m_ = Vec2(-world.field.length_m / 2 + cell_m / 2, -world.field.width_m / 2 + cell_m / 2);
    for (int i = 0; i < columns_ * rows_; ++i) {
      const Vec2 p = centre_m(i);
      double clearance_m =
          std::min(world.field.length_m / 2 - std::abs(p.x()), world.field.width_m / 2 - std::abs(p.y()));
      for (const Shape& shape : world.obstacles)
        clearance_m = std::min(clearance_m, signed_distance(p, shape));
      clearance_m_.push_back(clearance_m - world.radius_m);
    }
  }

  Vec2 centre_m(int i) const { return corner_m_ + cell_m_ * Vec2(i % columns_, i / columns_); }
  int size() const { return columns_ * rows_; }

  /// Labels cells so that cells with the same label are joined by a free path: every point between the
  /// centres of neighbours is within half a cell of one of the centres.
  std::vector<int> labels_of_connected_cells() const { return labels(cell_m_ / 2, false); }
  /// Labels cells so that cells with different labels are not joined by any free path: each cell with a free
  /// point has a label, and a path may pass diagonally from a cell to the next.
  std::vector<int> labels_of_separable_cells() const {
    return labels(-cell_m_ * std::sqrt(0.5) - 1e-9, true);
  }

 private:
  std::vector<int> labels(double min_clearance_m, bool across_corners) const {
    std::vector<int> labels(clearance_m_.size(), -1), open;
    int label = 0;
    for (int first = 0; first < size(); ++first) {
      if (labels[first] >= 0 || clearance_m_[first] <= min_clearance_m) continue;
      labels[first] = label;
      open.assign(1, first);
      while (!open.empty()) {
        const int cell = open.back();
        open.pop_back();
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            const int x = cell % columns_ + dx, y = cell / columns_ + dy, next = y * columns_ + x;
            if ((dx != 0 && dy != 0 && !across_corners) || x < 0 || x >= columns_ || y < 0 || y >= rows_)
              continue;
            if (labels[next] >= 0 || clearance_m_[next] <= min_clearance_m) continue;
            labels[next] = label;
            open.push_back(next);
          }
        }
      }
      ++label;
    }
    return labels;
  }

  double cell_m_;
  int columns_ = 0, rows_ = 0;
  Vec2 corner_m_{0, 0};
  std::vector<double> clearance_m_;
};

/// A world with enough obstacles of all kinds to enclose some free positions.
PlanWorld crowded_world(std::uint64_t seed) {
  Rng rng(seed);
  PlanWorld world;
  world.field = {4, 3};
  world.radius_m = 0.1;
  const auto count = 20 + rng.below(25);
  for (std::uint64_t i = 0; i < count; ++i) {
    const double y = rng.uniform(-1.7, 1.7), x = rng.uniform(-2.2, 2.2);
    const Vec2 at(x, y);
    const double size_m = rng.uniform(0.05, 0.35), angle_rad = rng.uniform(0, 6.283);
    const Vec2 half(size_m, 0.5 * size_m), along = rotated({3 * size_m, 0}, angle_rad);
    const Shape shapes[] = {Circle{at, size_m}, Box{at - half, at + half}, Segment{at, at + along},
                            ConvexPolygon{{at, at + along, at + rotated(along, 0.8)}}};
    world.obstacles.push_back(shapes[rng.below(4)]);
  }
  return world;
}

/// A box of half a metre for each '#'.
struct Scene {
  PlanWorld world;
  Vec2 a{0, 0}, b{0, 0};
};
Scene scene_of(const std::vector<std::string>& rows) {
  constexpr double kCell_m = 0.5;
  Scene scene;
  const auto width = static_cast<double>(rows[0].size()), height = static_cast<double>(rows.size());
  scene.world.field = {kCell_m * width, kCell_m * height};
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (std::size_t column = 0; column < rows[row].size(); ++column) {
      const Vec2 corner =
          kCell_m * Vec2(static_cast<double>(column) - width / 2, height / 2 - 1 - static_cast<double>(row));
      const Vec2 cell(kCell_m, kCell_m);
      if (rows[row][column] == '#') scene.world.obstacles.push_back(Box{corner, corner + cell});
      if (rows[row][column] == 'a') scene.a = corner + cell / 2;
      if (rows[row][column] == 'b') scene.b = corner + cell / 2;
    }
  }
  return scene;
}

bool connects(const std::vector<std::string>& rows) {
  const Scene scene = scene_of(rows);
  return FreeSpace(scene.world).connects(scene.a, scene.b);
}

TEST_CASE("free space connects and separates the same positions as a flood fill") {
  int joined = 0, separated = 0, undecided = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    const PlanWorld world = crowded_world(seed);
    const Grid grid(world, 0.02);
    const std::vector<int> surely = grid.labels_of_connected_cells(),
                           possibly = grid.labels_of_separable_cells();
    std::vector<int> free;
    for (int i = 0; i < grid.size(); ++i)
      if (surely[i] >= 0) free.push_back(i);
    const FreeSpace free_space(world);
    Rng rng(seed);
    for (int query = 0; query < 100; ++query) {
      const int a = free[rng.below(free.size())], b = free[rng.below(free.size())];
      const bool connected = free_space.connects(grid.centre_m(a), grid.centre_m(b));
      CAPTURE(grid.centre_m(a), grid.centre_m(b));
      if (surely[a] == surely[b]) {
        ++joined;
        REQUIRE(connected);
      } else if (possibly[a] != possibly[b]) {
        ++separated;
        REQUIRE_FALSE(connected);
      } else {
        ++undecided;
      }
    }
  }
  CAPTURE(joined, separated, undecided);
  CHECK(joined > 500);
  CHECK(separated > 300);
  CHECK(undecided < joined / 10);
}

TEST_CASE("a gap 1 nm wider than needed connects positions, and a gap 1 nm too narrow does not") {
  PlanWorld world;
  world.radius_m = 0.1;
  for (const double excess_m : {-1e-9, 1e-9}) {
    const double half = 0.1 + excess_m / 2;
    const Shape walls[][2] = {{Box{{-0.2, -6}, {0.2, -half}}, Box{{-0.2, half}, {0.2, 6}}},
                              {Segment{{0, -6}, {0, -half}}, Segment{{0, half}, {0, 6}}},
                              {Circle{{0, -half - 5}, 5}, Circle{{0, half + 5}, 5}}};
    for (const auto& wall : walls) {
      world.obstacles.assign(std::begin(wall), std::end(wall));
      CHECK(FreeSpace(world).connects({-4, 0}, {4, 0}) == (excess_m > 0));
    }
  }
}

TEST_CASE("free space without obstacles is connected") {
  CHECK(FreeSpace(PlanWorld{}).connects({-4.9, -4.9}, {4.9, 4.9}));
}

TEST_CASE("a closed ring separates its inside from its outside, but an open ring does not") {
  CHECK_FALSE(connects({".......",  //
                        ".#####.", ".#.a.#.", ".#...#.", ".#####b"}));
  CHECK(connects({".......",  //
                  ".#####.", ".#.a.#.", ".#....b", ".#####."}));
}

TEST_CASE("a wall from side to side separates positions even if its boxes meet only at corners") {
  CHECK_FALSE(connects({"a.#....",  //
                        "..#....", "...#...", "....#.b"}));
  CHECK(connects({"a.#....",  //
                  "..#....", ".......", "....#.b"}));
}

TEST_CASE("two islands inside a ring do not separate positions, but a wall across the ring does") {
  CHECK(connects({"#########",  //
                  "#.......#", "#a.#.#.b#", "#.......#", "#########"}));
  CHECK_FALSE(connects({"#########",  //
                        "#...#...#", "#a..#..b#", "#...#...#", "#########"}));
}

}  // namespace sidestep::free_space_test
