// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/crowd_families.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "tests/catch.hpp"

namespace sidestep::crowd_families_test {

constexpr std::uint64_t kSeeds = 60;

std::vector<Vec2> starts_of(const Scenario& scenario) {
  std::vector<Vec2> places_m;
  for (const RobotSpec& robot : scenario.robots) places_m.push_back(robot.start_m);
  return places_m;
}

std::vector<Vec2> goals_of(const Scenario& scenario) {
  std::vector<Vec2> places_m;
  for (const RobotSpec& robot : scenario.robots) places_m.push_back(robot.goals.at(0).position_m);
  return places_m;
}

bool touches_obstacle(const Scenario& scenario, const Vec2& place_m, double radius_m) {
  return std::ranges::any_of(scenario.obstacles, [&](const Shape& obstacle) {
    return signed_distance(place_m, obstacle) < radius_m;
  });
}

/// The cells of a grid that a robot alone on the floor reaches from a place, moving from cell to cell.
class ReachableCells {
 public:
  ReachableCells(const Scenario& scenario, const Vec2& from_m)
      : scenario_(scenario),
        half_columns_(cells_in(scenario.field.length_m / 2)),
        half_rows_(cells_in(scenario.field.width_m / 2)),
        is_seen_(static_cast<std::size_t>((2 * half_columns_ + 1) * (2 * half_rows_ + 1))),
        is_reached_(is_seen_.size()) {
    visit(cells_in(from_m.x()), cells_in(from_m.y()));
    while (!open_.empty()) {
      const auto [x, y] = open_.back();
      open_.pop_back();
      for (const auto& [dx, dy] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}}) visit(x + dx, y + dy);
    }
  }
  bool contains(const Vec2& place_m) const {
    return is_reached_[index(cells_in(place_m.x()), cells_in(place_m.y()))];
  }

 private:
  static constexpr double kCell_m = 0.02;

  static int cells_in(double length_m) { return static_cast<int>(std::round(length_m / kCell_m)); }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>((x + half_columns_) * (2 * half_rows_ + 1) + y + half_rows_);
  }
  /// Precondition: the cell is on the field, or next to a free cell.
  void visit(int x, int y) {
    const std::size_t cell = index(x, y);
    if (is_seen_[cell]) return;
    is_seen_[cell] = true;
    const Vec2 centre_m(kCell_m * x, kCell_m * y);
    is_reached_[cell] = scenario_.field.contains(centre_m, scenario_.radius_m) &&
                        !touches_obstacle(scenario_, centre_m, scenario_.radius_m + scenario_.margin_m);
    if (is_reached_[cell]) open_.emplace_back(x, y);
  }

  const Scenario& scenario_;
  int half_columns_, half_rows_;
  std::vector<bool> is_seen_, is_reached_;
  std::vector<std::pair<int, int>> open_;
};

/// The longest part of a line across the floor that is free of obstacles, in millimetres.
int free_mm(const Scenario& scenario, const Vec2& through_m, const Vec2& direction) {
  const int half_mm = static_cast<int>(500 * std::min(scenario.field.length_m, scenario.field.width_m));
  int longest_mm = 0, current_mm = 0;
  for (int mm = -half_mm; mm <= half_mm; ++mm) {
    const bool is_free = !touches_obstacle(scenario, through_m + 1e-3 * mm * direction, 0);
    current_mm = is_free ? current_mm + 1 : 0;
    longest_mm = std::max(longest_mm, current_mm);
  }
  return longest_mm;
}

TEST_CASE("starts and goals of crowds are free with a few centimetres to spare") {
  for (const CrowdFamily& family : crowd_families()) {
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      CAPTURE(family.name, seed);
      const Scenario scenario = crowd_scene(family, seed);
      for (const std::vector<Vec2>& places_m : {starts_of(scenario), goals_of(scenario)}) {
        for (std::size_t i = 0; i < places_m.size(); ++i) {
          REQUIRE(scenario.field.contains(places_m[i], scenario.radius_m + 0.01));
          REQUIRE_FALSE(
              touches_obstacle(scenario, places_m[i], scenario.radius_m + scenario.margin_m + 0.01));
          for (std::size_t j = 0; j < i; ++j)
            REQUIRE((places_m[i] - places_m[j]).norm() > 2 * scenario.radius_m + scenario.margin_m + 0.03);
        }
      }
    }
  }
}

TEST_CASE("a robot alone on the floor of a crowd reaches all starts and goals") {
  for (const CrowdFamily& family : crowd_families()) {
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      CAPTURE(family.name, seed);
      const Scenario scenario = crowd_scene(family, seed);
      if (scenario.obstacles.empty()) continue;
      const ReachableCells reachable(scenario, scenario.robots.front().start_m);
      for (const Vec2& start_m : starts_of(scenario)) REQUIRE(reachable.contains(start_m));
      for (const Vec2& goal_m : goals_of(scenario)) REQUIRE(reachable.contains(goal_m));
    }
  }
}

TEST_CASE("the scene of a seed is always the same, and differs from those of other seeds") {
  for (const CrowdFamily& family : crowd_families()) {
    CAPTURE(family.name);
    std::set<double> first_starts_m;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      CAPTURE(seed);
      const Scenario scenario = crowd_scene(family, seed), again = crowd_scene(family, seed);
      CHECK(starts_of(scenario) == starts_of(again));
      CHECK(goals_of(scenario) == goals_of(again));
      CHECK(scenario.obstacles.size() == again.obstacles.size());
      first_starts_m.insert(scenario.robots.front().start_m.x());
    }
    CHECK(first_starts_m.size() == kSeeds);
  }
}

TEST_CASE("ids of robots in crowds are consecutive and say nothing about the team") {
  for (const CrowdFamily& family : crowd_families()) {
    CAPTURE(family.name);
    std::size_t blue = 0;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      CAPTURE(seed);
      const Scenario scenario = crowd_scene(family, seed);
      for (std::size_t i = 0; i < scenario.robots.size(); ++i) REQUIRE(scenario.robots[i].id == i);
      blue += scenario.robots.front().team == Team::kBlue;
    }
    // A fair coin is outside these bounds once in 3,000 times.
    CHECK(blue > 15);
    CHECK(blue < 45);
  }
}

TEST_CASE("crowds have the stated numbers of robots") {
  const std::map<std::string, std::size_t> expected{
      {"obstacle-lanes", 8},    {"obstacle-gaps", 8}, {"doorway", 12},          {"pillars", 16},
      {"crossing-streams", 10}, {"corridor", 8},      {"crowd-30", 30},         {"crowd-60", 60},
      {"narrow-doorway", 8},    {"junction", 8},      {"two-way-corridor", 12}, {"disc-swap", 32},
      {"goal-swap", 12},        {"mixed-speeds", 16}, {"stream-100", 100}};
  REQUIRE(crowd_families().size() == expected.size() + 1);
  for (const auto& [name, robots] : expected) {
    CAPTURE(name);
    const CrowdFamily* const family = find_crowd_family(name);
    REQUIRE(family);
    CHECK(crowd_scene(*family, 1).robots.size() == robots);
    CHECK(crowd_scene(*family, 1).name == name);
  }
  std::set<std::size_t> sizes;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed)
    sizes.insert(crowd_scene(*find_crowd_family("uneven-circle"), seed).robots.size());
  CHECK(*sizes.begin() == 12);
  CHECK(*sizes.rbegin() == 20);
  CHECK(find_crowd_family("quiet-afternoon") == nullptr);
}

TEST_CASE("passages are as wide as their family says") {
  struct Expected {
    std::string name;
    int min_mm, max_mm;
  };
  const Expected expected = GENERATE(Expected{"doorway", 500, 620}, Expected{"narrow-doorway", 300, 400},
                                     Expected{"corridor", 550, 700}, Expected{"two-way-corridor", 800, 1000});
  std::set<int> widths_mm;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    CAPTURE(expected.name, seed);
    const Scenario scenario = crowd_scene(*find_crowd_family(expected.name), seed);
    const int width_mm = free_mm(scenario, {0, 0}, {0, 1});
    CHECK(width_mm >= expected.min_mm - 1);
    CHECK(width_mm <= expected.max_mm + 1);
    widths_mm.insert(width_mm);
  }
  CHECK(widths_mm.size() > 30);
}

TEST_CASE("the corridors of a junction are equally wide") {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    CAPTURE(seed);
    const Scenario scenario = crowd_scene(*find_crowd_family("junction"), seed);
    const int width_mm = free_mm(scenario, {1, 0}, {0, 1});
    CHECK(width_mm >= 549);
    CHECK(width_mm <= 751);
    CHECK(free_mm(scenario, {-1, 0}, {0, 1}) == width_mm);
    CHECK(free_mm(scenario, {0, 1}, {1, 0}) == width_mm);
    CHECK(free_mm(scenario, {0, -1}, {1, 0}) == width_mm);
  }
}

TEST_CASE("every robot of a junction drives to another arm") {
  const auto arm_of = [](const Vec2& place_m) {
    return std::abs(place_m.x()) > std::abs(place_m.y()) ? (place_m.x() > 0 ? 0 : 2)
                                                         : (place_m.y() > 0 ? 1 : 3);
  };
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    CAPTURE(seed);
    std::map<int, int> starts, goals;
    for (const RobotSpec& robot : crowd_scene(*find_crowd_family("junction"), seed).robots) {
      const int from = arm_of(robot.start_m), to = arm_of(robot.goals.at(0).position_m);
      CHECK(from != to);
      ++starts[from];
      ++goals[to];
    }
    for (int arm = 0; arm < 4; ++arm) {
      CHECK(starts[arm] == 2);
      CHECK(goals[arm] == 2);
    }
  }
}

}  // namespace sidestep::crowd_families_test
