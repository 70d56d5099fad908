// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/crowd_families.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/bench/crowds/crowd_passages.hpp"

namespace sidestep {
namespace {

constexpr double kTimeLimit_s = 60;
constexpr double kPostRadius_m = 0.09;
constexpr Field kSmallField{4.5, 3.5}, kRandomField{5, 4};

Vec2 shift_m(double max_m, Rng& rng) { return random_point({{-max_m, -max_m}, {max_m, max_m}}, rng); }

std::vector<Vec2> shifted(std::vector<Vec2> points_m, double max_m, Rng& rng) {
  for (Vec2& point_m : points_m) point_m += shift_m(max_m, rng);
  return points_m;
}

std::vector<Vec2> mirrored(std::vector<Vec2> points_m) {
  for (Vec2& point_m : points_m) point_m = -point_m;
  return points_m;
}

std::vector<Vec2> moved(std::vector<Vec2> points_m, const Vec2& by_m) {
  for (Vec2& point_m : points_m) point_m += by_m;
  return points_m;
}

std::vector<Vec2> rotated_left(std::vector<Vec2> points_m) {
  for (Vec2& point_m : points_m) point_m = Vec2(-point_m.y(), point_m.x());
  return points_m;
}

/// Four posts at the corners of a square.
void add_square_of_posts(CrowdFloor& floor, double side_m, const Vec2& centre_m) {
  for (const double x : {-side_m / 2, side_m / 2})
    for (const double y : {-side_m / 2, side_m / 2})
      floor.add_obstacle(Circle{centre_m + Vec2(x, y), kPostRadius_m});
}

Scenario obstacle_lanes(Rng& rng) {
  CrowdFloor floor(kSmallField, rng);
  add_square_of_posts(floor, 0.7, {0, 0});
  constexpr double kMaxShift_m = 0.03;
  std::vector<Vec2> left_m, right_m;
  for (const double y : {-0.75, -0.25, 0.25, 0.75}) {
    left_m.emplace_back(-1.4, y);
    right_m.emplace_back(1.4, y);
  }
  const auto near = [&](const std::vector<Vec2>& places_m) { return shifted(places_m, kMaxShift_m, rng); };
  const auto blue_starts_m = near(left_m), blue_goals_m = near(right_m);
  const auto yellow_starts_m = near(right_m), yellow_goals_m = near(left_m);
  floor.add_robots(blue_starts_m, blue_goals_m, Team::kBlue);
  floor.add_robots(yellow_starts_m, yellow_goals_m, Team::kYellow);
  return floor.finish();
}

Scenario obstacle_gaps(Rng& rng) {
  CrowdFloor floor(kSmallField, rng);
  const double side_m = rng.uniform(0.6, 0.84);
  add_square_of_posts(floor, side_m, shift_m(0.1, rng));
  const Box left{{-1.43, -1.1}, {-1.37, 1.1}}, right{{1.37, -1.1}, {1.43, 1.1}};
  const auto blue_starts_m = floor.random_places(4, left), yellow_starts_m = floor.random_places(4, right);
  floor.add_robots(blue_starts_m, floor.random_goals(blue_starts_m, right), Team::kBlue);
  floor.add_robots(yellow_starts_m, floor.random_goals(yellow_starts_m, left), Team::kYellow);
  return floor.finish();
}

Scenario doorway(Rng& rng) { return doorway_scene({6, {0.50, 0.62}, {0.1, 0.1}, 0.4}, {5, 3.5}, rng); }

Scenario narrow_doorway(Rng& rng) { return doorway_scene({4, {0.30, 0.40}, {0.1, 0.1}, 0.4}, {5, 3.5}, rng); }

Scenario corridor(Rng& rng) { return passage_scene({4, {0.55, 0.70}, {1.5, 2.5}, 0.1, 2, 1}, {8, 3}, rng); }

Scenario two_way_corridor(Rng& rng) { return passage_scene({6, {0.8, 1.0}, {2.8, 3.2}, 0.3}, {8.2, 3}, rng); }

Scenario junction(Rng& rng) { return junction_scene({0.55, 0.75}, {4.8, 4.8}, rng); }

/// Adds robots with random starts and goals anywhere on the floor.
void add_random_robots(CrowdFloor& floor, std::size_t count) {
  const auto starts_m = floor.random_places(count, floor.robot_area());
  const auto goals_m = floor.random_goals(starts_m, floor.robot_area());
  for (std::size_t i = 0; i < count; ++i)
    floor.add_robot(starts_m[i], {goals_m[i]}, i % 2 == 0 ? Team::kBlue : Team::kYellow);
}

Scenario pillars(Rng& rng) {
  CrowdFloor floor(kRandomField, rng);
  for (const double x : {-1.2, 0.0, 1.2}) {
    for (const double y : {-1.0, 0.0, 1.0}) {
      const double radius_m = rng.uniform(0.10, 0.18);
      floor.add_obstacle(Circle{Vec2(x, y) + shift_m(0.05, rng), radius_m});
    }
  }
  add_random_robots(floor, 16);
  return floor.finish();
}

Scenario crowd_30(Rng& rng) {
  CrowdFloor floor(kRandomField, rng);
  add_random_robots(floor, 30);
  return floor.finish();
}

Scenario crowd_60(Rng& rng) {
  CrowdFloor floor({8, 6}, rng);
  constexpr std::size_t kObstacles = 12;
  constexpr double kSpacing_m = 1.1;  // leaves at least 0.5 m between two of the obstacles
  std::vector<Vec2> centres_m;
  while (centres_m.size() < kObstacles) {
    const Vec2 centre_m = random_point({{-3.2, -2.2}, {3.2, 2.2}}, rng);
    const auto is_far = [&](const Vec2& other_m) { return (other_m - centre_m).norm() >= kSpacing_m; };
    if (!std::ranges::all_of(centres_m, is_far)) continue;
    centres_m.push_back(centre_m);
    const double size_m = rng.uniform(0.1, 0.3);
    const Vec2 half_m = Vec2(size_m, size_m) / std::numbers::sqrt2;
    if (rng.chance(0.5))
      floor.add_obstacle(Circle{centre_m, size_m});
    else
      floor.add_obstacle(Box{centre_m - half_m, centre_m + half_m});
  }
  add_random_robots(floor, 60);
  return floor.finish();
}

Scenario mixed_speeds(Rng& rng) {
  CrowdFloor floor(kRandomField, rng);
  constexpr std::array<double, 4> kSpeeds_mps{0.5, 1, 1.5, 2};
  const auto starts_m = floor.random_places(16, floor.robot_area());
  const auto goals_m = floor.random_goals(starts_m, floor.robot_area());
  for (std::size_t i = 0; i < starts_m.size(); ++i) {
    Goal goal{goals_m[i]};
    goal.speed_limit_mps = kSpeeds_mps[i % kSpeeds_mps.size()];
    floor.add_robot(starts_m[i], goal, i % 2 == 0 ? Team::kBlue : Team::kYellow);
  }
  return floor.finish();
}

Scenario goal_swap(Rng& rng) {
  CrowdFloor floor({4, 3}, rng);
  const auto starts_m = floor.random_places(12, floor.robot_area());
  auto goals_m = starts_m;
  const auto is_far = [](const Vec2& start_m, const Vec2& goal_m) {
    return (goal_m - start_m).norm() >= CrowdFloor::kMinTravel_m;
  };
  do rng.shuffle(goals_m);
  while (!std::ranges::equal(starts_m, goals_m, is_far));
  for (std::size_t i = 0; i < starts_m.size(); ++i)
    floor.add_robot(starts_m[i], {goals_m[i]}, i % 2 == 0 ? Team::kBlue : Team::kYellow);
  return floor.finish();
}

/// Five robots behind each other drive along x, and five along y. Robots at the same position in both
/// streams would reach the crossing at the same time.
Scenario crossing_streams(Rng& rng) {
  CrowdFloor floor({7, 7}, rng);
  constexpr int kRobots = 5;
  constexpr double kSpacing_m = 0.3, kRear_m = 2.4, kMaxShift_m = 0.03;
  constexpr double kTravel_m = 2 * kRear_m - kSpacing_m * (kRobots - 1);
  std::vector<Vec2> starts_m, goals_m;
  for (int i = 0; i < kRobots; ++i) {
    starts_m.emplace_back(kSpacing_m * i - kRear_m, 0);
    goals_m.emplace_back(kSpacing_m * i - kRear_m + kTravel_m, 0);
  }
  for (const Team team : {Team::kBlue, Team::kYellow}) {
    const auto along = [&](const std::vector<Vec2>& places_m) {
      return team == Team::kBlue ? places_m : rotated_left(places_m);
    };
    const auto from_m = shifted(starts_m, kMaxShift_m, rng), to_m = shifted(goals_m, kMaxShift_m, rng);
    floor.add_robots(along(from_m), along(to_m), team);
  }
  return floor.finish();
}

/// Ten lanes of five robots behind each other, which drive along x. The lanes lie at a random distance of up
/// to half their spacing from the centre.
Scenario stream_100(Rng& rng) {
  CrowdFloor floor({12, 9}, rng);
  constexpr int kLanes = 10, kRows = 5;
  constexpr double kSpacing_m = 0.5, kMaxShift_m = 0.04, kRear_m = 5.6, kCrossingRear_m = 4.1;
  const bool is_crossing = rng.chance(0.5);
  for (const Team team : {Team::kBlue, Team::kYellow}) {
    const bool is_second = team == Team::kYellow;
    const double rear_m = is_crossing && is_second ? kCrossingRear_m : kRear_m;
    const double lateral_m = rng.uniform(-kSpacing_m / 2, kSpacing_m / 2);
    std::vector<Vec2> lattice_m;
    for (int lane = 0; lane < kLanes; ++lane) {
      for (int row = 0; row < kRows; ++row)
        lattice_m.emplace_back(kSpacing_m * row - rear_m,
                               kSpacing_m * (lane - 0.5 * (kLanes - 1)) + lateral_m);
    }
    const Vec2 travel_m(2 * rear_m - kSpacing_m * (kRows - 1), 0);
    const auto along = [&](const std::vector<Vec2>& places_m) {
      if (!is_second) return places_m;
      return is_crossing ? rotated_left(places_m) : mirrored(places_m);
    };
    const auto starts_m = shifted(lattice_m, kMaxShift_m, rng);
    const auto goals_m = shifted(moved(lattice_m, travel_m), kMaxShift_m, rng);
    floor.add_robots(along(starts_m), along(goals_m), team);
  }
  return floor.finish();
}

/// The robots stand on those points of a triangular lattice that are nearest to the disc's centre. The centre
/// lies near the middle of a triangle, so that all robots have to move. The disc is turned at random.
Scenario disc_swap(Rng& rng) {
  CrowdFloor floor({5, 5}, rng);
  constexpr double kSpacing_m = 0.42, kMaxShift_m = 0.02;
  constexpr int kReach = 8;  // more lattice points than robots in each direction
  constexpr std::size_t kRobots = 32;
  const Vec2 middle_m(kSpacing_m / 2, kSpacing_m / (2 * std::numbers::sqrt3));
  const Vec2 centre_m = middle_m + shift_m(kMaxShift_m, rng);
  const double turn_rad = rng.uniform(0, 2 * std::numbers::pi);
  std::vector<Vec2> lattice_m;
  for (int row = -kReach; row <= kReach; ++row) {
    for (int column = -kReach; column <= kReach; ++column) {
      const double x = kSpacing_m * (column + 0.5 * row), y = kSpacing_m * std::sqrt(0.75) * row;
      lattice_m.push_back(rotated(Vec2(Vec2(x, y) - centre_m), turn_rad));
    }
  }
  std::ranges::sort(lattice_m, {}, [](const Vec2& point_m) { return point_m.squaredNorm(); });
  lattice_m.resize(kRobots);
  const auto starts_m = shifted(lattice_m, kMaxShift_m, rng);
  const auto goals_m = shifted(mirrored(lattice_m), kMaxShift_m, rng);
  for (std::size_t i = 0; i < kRobots; ++i)
    floor.add_robot(starts_m[i], {goals_m[i]}, i % 2 == 0 ? Team::kBlue : Team::kYellow);
  return floor.finish();
}

Scenario uneven_circle(Rng& rng) {
  CrowdFloor floor({6.5, 6.5}, rng);
  constexpr double kMinChord_m = 0.42, kMinRadius_m = 1.2;
  const std::size_t count = 12 + rng.below(9);
  std::vector<double> gaps;
  double total = 0;
  for (std::size_t i = 0; i < count; ++i) total += gaps.emplace_back(rng.uniform(0.6, 1.6));
  const double rad_per_gap = 2 * std::numbers::pi / total;
  const double min_gap_rad = rad_per_gap * *std::ranges::min_element(gaps);
  const double radius_m = std::max(kMinRadius_m, kMinChord_m / (2 * std::sin(min_gap_rad / 2)));
  double angle_rad = rng.uniform(0, 2 * std::numbers::pi);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2 start_m = rotated(Vec2(radius_m, 0), angle_rad);
    floor.add_robot(start_m, {-start_m}, i % 2 == 0 ? Team::kBlue : Team::kYellow);
    angle_rad += rad_per_gap * gaps[i];
  }
  return floor.finish();
}

}  // namespace

const std::vector<CrowdFamily>& crowd_families() {
  static const std::vector<CrowdFamily> families{
      {"obstacle-lanes", "four against four over 2.8 m, four posts between their lanes", obstacle_lanes},
      {"obstacle-gaps", "four against four among four posts 0.6 to 0.84 m apart", obstacle_gaps},
      {"doorway", "six against six through a doorway of 0.50 to 0.62 m", doorway},
      {"pillars", "16 at random among nine pillars", pillars},
      {"crossing-streams", "two streams of five cross at a right angle", crossing_streams},
      {"corridor", "four against four through a corridor of 0.55 to 0.70 m", corridor},
      {"crowd-30", "30 at random, 5 x 4 m", crowd_30},
      {"crowd-60", "60 at random among 12 obstacles, 8 x 6 m", crowd_60},
      {"narrow-doorway", "four against four through a doorway for one robot", narrow_doorway},
      {"junction", "eight robots change arms at a four-way crossing of corridors", junction},
      {"two-way-corridor", "six against six through a corridor of 0.8 to 1.0 m", two_way_corridor},
      {"disc-swap", "32 robots in a dense disc, each to the opposite point", disc_swap},
      {"uneven-circle", "12 to 20 robots on a circle with unequal spacing, each to the opposite point",
       uneven_circle},
      {"goal-swap", "12 robots whose goals are other robots' starts, 4 x 3 m", goal_swap},
      {"mixed-speeds", "16 robots at random with speed limits of 0.5 to 2 m/s, 5 x 4 m", mixed_speeds},
      {"stream-100", "two streams of 50 meet head-on or cross, 12 x 9 m", stream_100},
  };
  return families;
}

const CrowdFamily* find_crowd_family(std::string_view name) {
  const auto& families = crowd_families();
  const auto found = std::ranges::find(families, name, &CrowdFamily::name);
  return found == families.end() ? nullptr : &*found;
}

Scenario crowd_scene(const CrowdFamily& family, std::uint64_t seed) {
  Rng rng(seed);
  Scenario scenario = family.make(rng);
  scenario.name = family.name;
  scenario.time_limit_s = kTimeLimit_s;
  return scenario;
}

}  // namespace sidestep
