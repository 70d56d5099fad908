// SPDX-License-Identifier: Apache-2.0
#include "agents/perception/local_grid.hpp"

#include <map>
#include <set>

#include "tests/catch.hpp"
#include "tests/unit/agents/perception/scene.hpp"

namespace sidestep::local_grid_test {

constexpr double kPi = std::numbers::pi;
constexpr float kInfinite = std::numeric_limits<float>::infinity();
constexpr LaserSettings kLaser{90, 2 * kPi, 0.05, 5};

Time at_s(double seconds) { return time_from_ns(1'000'000'000) + from_seconds(seconds); }

/// Slow reference: stores the same evidence for cells of the whole world, with finely sampled rays.
class SlowGrid {
 public:
  explicit SlowGrid(int side_cells) : side_cells_(side_cells) {}

  using Key = std::pair<int, int>;

  Key key(const Vec2& p) const {
    return {static_cast<int>(std::floor(p.x() / LocalGrid::kResolution_m)),
            static_cast<int>(std::floor(p.y() / LocalGrid::kResolution_m))};
  }
  void update(const LaserBeams& beams) {
    for (auto& [cell, odds] : odds_)
      odds *= std::exp(-to_seconds(beams.captured_at() - updated_at_) / LocalGrid::kDecay_s);
    updated_at_ = beams.captured_at();
    // Forgets cells that leave the window.
    const Key robot = key(beams.at_m());
    const int half = side_cells_ / 2;
    const auto is_inside = [&](const Key& cell) {
      return cell.first >= robot.first - half && cell.first < robot.first + half &&
             cell.second >= robot.second - half && cell.second < robot.second + half;
    };
    std::erase_if(odds_, [&](const auto& entry) { return !is_inside(entry.first); });
    std::set<Key> hits, crossed, grazed;
    for (const Beam& beam : beams.all()) {
      if (beam.end == BeamEnd::kHit) hits.insert(key(beams.end_m(beam)));
      if (beam.end == BeamEnd::kUnknown) continue;
      constexpr double kStep_m = 0.00025;
      for (double m = 0; m <= beam.free_m; m += kStep_m)
        crossed.insert(key(beams.at_m() + m * beam.direction));
    }
    for (const Key& cell : hits)
      if (is_inside(cell)) odds_[cell] = std::min<double>(odds_[cell] + LocalGrid::kHit, LocalGrid::kLimit);
    for (const Key& cell : crossed)
      if (is_inside(cell) && !hits.contains(cell))
        odds_[cell] = std::max<double>(odds_[cell] - LocalGrid::kMiss, -LocalGrid::kLimit);
  }
  double log_odds(const Cell& cell) const {
    const auto found = odds_.find({cell.column, cell.row});
    return found == odds_.end() ? 0 : found->second;
  }

 private:
  int side_cells_;
  Time updated_at_{};
  std::map<Key, double> odds_;
};

TEST_CASE("while the robot drives, the grid equals a slow grid of the whole world") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    test::Scene scene(seed, kLaser);
    LocalGrid grid({.side_cells = 128});  // smaller than the laser's range
    SlowGrid slow(128);
    LaserBeams beams(kLaser);
    test::Walker robot(scene, rng, 0.2, 2);
    int occupied = 0, free = 0, different = 0, all = 0;
    double now_s = 0;
    for (int scan = 0; scan < 12; ++scan) {
      now_s += rng.uniform(0.1, 0.6);
      robot.step(scene, rng, 0.4);
      const std::vector<Circle> robots{{scene.random_free(rng, 0.2), 0.2}};
      beams.read(scene.scan(robot.at_m(), rng.uniform(-4, 4), at_s(now_s), robots, {0.02, 1, 0.1}, rng),
                 robots);
      REQUIRE(grid.update(beams));
      slow.update(beams);
      const Cell centre = grid.cell_at(robot.at_m());
      for (int row = centre.row - 80; row < centre.row + 80; ++row) {
        for (int column = centre.column - 80; column < centre.column + 80; ++column, ++all) {
          const Cell cell{column, row};
          // Sampling misses cells where a ray only cuts a corner.
          different += std::abs(grid.log_odds(cell) - slow.log_odds(cell)) > 0.002;
          occupied += grid.state(cell) == CellState::kOccupied;
          free += grid.state(cell) == CellState::kFree;
        }
      }
    }
    CHECK(occupied > 100);
    CHECK(free > 5000);
    CHECK(different < all / 300);
  }
}

/// A scanner at the origin. In each scan, all beams have the same range.
struct Fixture {
  LaserBeams beams{kLaser};
  LocalGrid grid;
  double now_s = 0;

  void scan(float range_m, const Vec2& at = {0, 0}, std::span<const Circle> robots = {}) {
    const std::vector<float> ranges(90, range_m);
    beams.read({at, 0, at_s(now_s), ranges}, robots);
    CHECK(grid.update(beams));
    now_s += 0.1;
  }
  CellState state(double x, double y) const { return grid.state_at({x, y}); }
};

TEST_CASE("hits mark cells, rays clear cells, and dropouts change nothing") {
  Fixture f;
  f.scan(2.02F);
  CHECK(f.state(2.02, 0.001) == CellState::kUnknown);
  f.scan(2.02F);
  CHECK(f.state(2.02, 0.001) == CellState::kOccupied);
  CHECK(f.state(1, 0.001) == CellState::kFree);
  CHECK(f.state(2.2, 0.001) == CellState::kUnknown);
  CHECK(f.state(40, 0.001) == CellState::kUnknown);
  // Dropouts and hits that are too near change nothing.
  Fixture same = f;
  f.scan(test::kNoRange);
  f.scan(-kInfinite);
  f.scan(2.02F);
  same.now_s += 0.2;
  same.scan(2.02F);
  for (double x = -3; x <= 3; x += 0.05)
    CHECK(f.grid.log_odds(f.grid.cell_at({x, 0.001})) ==
          Approx(same.grid.log_odds(f.grid.cell_at({x, 0.001}))).margin(1e-5));
  // A beam with maximum range clears all cells up to that range.
  for (int i = 0; i < 20; ++i) f.scan(kInfinite);
  CHECK(f.state(2.02, 0.001) == CellState::kFree);
  CHECK(f.state(4.97, 0.001) == CellState::kFree);
  CHECK(f.state(5.1, 0.001) == CellState::kUnknown);
}

TEST_CASE("known robots leave no hits, and rays clear cells up to their edges") {
  Fixture f;
  const std::vector<Circle> robots{{{1.7, 0}, 0.2}};
  for (int i = 0; i < 5; ++i) f.scan(1.52F, {0, 0}, robots);
  CHECK(f.state(1.52, 0.001) != CellState::kOccupied);
  CHECK(f.state(1.4, 0.001) == CellState::kFree);
  CHECK(f.state(1.6, 0.001) == CellState::kUnknown);
  CHECK(f.state(-1.52, -0.001) == CellState::kOccupied);
}

TEST_CASE("the evidence in a cell saturates, and decays while the cell is not observed") {
  Fixture f;
  for (int i = 0; i < 50; ++i) f.scan(2.02F);
  const Cell hit = f.grid.cell_at({2.02, 0.001}), crossed = f.grid.cell_at({1, 0.001});
  CHECK(f.grid.log_odds(hit) == Approx(LocalGrid::kLimit).margin(0.02));
  CHECK(f.grid.log_odds(crossed) == Approx(-LocalGrid::kLimit).margin(0.02));
  const float before = f.grid.log_odds(hit);
  f.now_s += LocalGrid::kDecay_s - 0.1;
  f.scan(test::kNoRange);
  CHECK(f.grid.log_odds(hit) == Approx(before * std::exp(-1)).margin(0.01));
  f.now_s += 100;
  f.scan(test::kNoRange);
  CHECK(f.grid.state(hit) == CellState::kUnknown);
  CHECK(f.grid.state(crossed) == CellState::kUnknown);
}

TEST_CASE("a cell's occupied time starts over after the cell has been free") {
  Fixture f;
  for (int i = 0; i <= 20; ++i) f.scan(2.02F);
  const Cell hit = f.grid.cell_at({2.02, 0.001});
  CHECK(to_seconds(f.grid.occupied_for(hit)) == Approx(1.9));
  CHECK(f.grid.crossed_at(hit) == Time::min());
  CHECK(f.grid.crossed_at(f.grid.cell_at({1, 0.001})) == at_s(2));
  for (int i = 0; i < 20; ++i) f.scan(kInfinite);
  CHECK(f.grid.occupied_for(hit) == Duration::zero());
  CHECK(f.grid.crossed_at(hit) == at_s(4));
  for (int i = 0; i < 20; ++i) f.scan(2.02F);
  CHECK(to_seconds(f.grid.occupied_for(hit)) < 1.95);
  CHECK(to_seconds(f.grid.occupied_for(hit)) > 0.5);
}

TEST_CASE("the window moves by whole cells and forgets cells that leave it") {
  Fixture f;
  for (int i = 0; i < 5; ++i) f.scan(2.02F);
  const Cell hit = f.grid.cell_at({2.02, 0.001});
  const float odds = f.grid.log_odds(hit);
  f.scan(test::kNoRange, {3.07, -1.33});
  CHECK(f.grid.log_odds(hit) == Approx(odds).margin(0.05));
  f.scan(test::kNoRange, {9, 0});
  CHECK(f.grid.log_odds(hit) == 0);
  f.scan(test::kNoRange, {0, 0});
  CHECK(f.grid.log_odds(hit) == 0);
  CHECK(f.grid.crossed_at(f.grid.cell_at({1, 0.001})) == Time::min());
  f.scan(test::kNoRange, {-1000.02, 777.7});
  f.scan(1.05F, {-1000.02, 777.72});
  f.scan(1.05F, {-1000.02, 777.72});
  CHECK(f.grid.state_at({-998.97, 777.72}) == CellState::kOccupied);
}

TEST_CASE("the query for occupied cells in a box agrees with a check of each cell") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    test::Scene scene(seed, kLaser);
    LaserBeams beams(kLaser);
    LocalGrid grid;
    const Vec2 at = scene.random_free(rng, 0.3);
    for (int i = 0; i < 5; ++i) {
      beams.read(scene.scan(at, 0.3 * i, at_s(i), {}, {}, rng), {});
      REQUIRE(grid.update(beams));
    }
    for (int i = 0; i < 30; ++i) {
      const double x = rng.uniform(-9, 9), y = rng.uniform(-9, 9);
      const Vec2 size(rng.uniform(0, 3), rng.uniform(0, 3));
      const Box box{{x, y}, Vec2(x, y) + size};
      std::set<std::pair<int, int>> found, expected;
      grid.for_each_occupied(box, [&](const Cell& cell) { found.insert({cell.column, cell.row}); });
      const Cell centre = grid.cell_at(at);
      for (int row = centre.row - 128; row < centre.row + 128; ++row)
        for (int column = centre.column - 128; column < centre.column + 128; ++column)
          if (const Cell cell{column, row};
              grid.state(cell) == CellState::kOccupied && overlap(grid.box_of(cell), box))
            expected.insert({column, row});
      REQUIRE(found == expected);
    }
    int all = 0;
    grid.for_each_occupied({{-1e9, -1e9}, {1e9, 1e9}}, [&](const Cell&) { ++all; });
    CHECK(all > 20);
  }
}

TEST_CASE("old scans change nothing and invalid settings are refused") {
  Fixture f;
  f.scan(2.02F);
  const std::vector<float> ranges(90, 1.02F);
  f.beams.read({{0, 0}, 0, at_s(0), ranges}, {});
  CHECK_FALSE(f.grid.update(f.beams));
  CHECK(f.grid.log_odds(f.grid.cell_at({1.02, 0.001})) < 0);
  f.beams.read({{2e6, 0}, 0, at_s(9), ranges}, {});
  CHECK_THROWS_AS(f.grid.update(f.beams), std::invalid_argument);
  for (const int side_cells : {100, 8, 8192})
    CHECK_THROWS_AS(LocalGrid({.side_cells = side_cells}), std::invalid_argument);
}

}  // namespace sidestep::local_grid_test
