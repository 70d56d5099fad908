// SPDX-License-Identifier: Apache-2.0
// Compares the listed obstacles, and the distance within which a list claims to be complete, with brute
// force.
#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "common/messaging/detected_obstacles.hpp"
#include "tests/catch.hpp"
#include "tests/counted_allocations.hpp"
#include "tests/unit/vision/tracker_fixture.hpp"

namespace sidestep::obstacle_list_test {

using namespace sidestep::test;

constexpr double kRadius_m = 0.05;
constexpr double kPatrol_m = 0.03;  ///< radius of the circles on which obstacles move
constexpr double kNoise_m = 0.0005;

/// Obstacles that move on small circles around the cells of a grid, with up to 0.3 m/s and 3 m/s².
struct Crowd {
  std::vector<Vec2> centres_m;
  std::vector<double> turns_radps;

  /// Fills a square around the origin.
  Crowd(std::size_t count, double spacing_m, Rng& rng) {
    const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
    for (std::size_t cell = 0; cell < side * side; ++cell) {
      const Vec2 index(static_cast<double>(cell % side), static_cast<double>(cell / side));
      centres_m.push_back(spacing_m * (index - Vec2::Constant(0.5 * static_cast<double>(side))));
    }
    rng.shuffle(centres_m);
    centres_m.resize(count);
    for (std::size_t i = 0; i < count; ++i) turns_radps.push_back(rng.uniform(-10, 10));
  }
  void stop() { turns_radps.assign(centres_m.size(), 0); }
  Vec2 position_m(std::size_t i, Time t) const {
    return centres_m[i] + rotated({kPatrol_m, 0}, turns_radps[i] * to_seconds(t - kBegin));
  }
  std::vector<Vec2> positions_m(Time t) const {
    std::vector<Vec2> positions;
    for (std::size_t i = 0; i < centres_m.size(); ++i) positions.push_back(position_m(i, t));
    return positions;
  }
};

/// A camera that sees every object with x from `low_m` to `high_m`, without misses.
struct StripCamera {
  std::uint32_t number = 0;
  double low_m = 0, high_m = 0;

  msg::DetectionFrame capture(Time t, const Crowd& crowd, const std::vector<Vec2>& robots_m, Rng& rng) const {
    msg::DetectionFrame frame = frame_message(number, t);
    const auto sees = [&](const Vec2& p) { return p.x() >= low_m && p.x() <= high_m; };
    for (RobotId robot = 0; robot < robots_m.size(); ++robot) {
      if (sees(robots_m[robot])) add_noisy_robot(frame, robot, {robots_m[robot], {0, 0}, 0}, {kNoise_m}, rng);
    }
    std::vector<Circle> seen;
    for (const Vec2& position : crowd.positions_m(t)) {
      if (sees(position)) seen.push_back({position + kNoise_m * normal_vector(rng), kRadius_m});
    }
    set_obstacles(seen, frame);
    return frame;
  }
};

/// Cameras side by side with overlapping views.
std::vector<StripCamera> cameras_over(double width_m, std::uint32_t count) {
  constexpr double kOverlap_m = 0.4;
  std::vector<StripCamera> cameras;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double low = -0.5 * width_m + width_m * i / count;
    cameras.push_back({i, low - kOverlap_m, low + width_m / count + kOverlap_m});
  }
  return cameras;
}

double edge_distance_m(const Vec2& obstacle_m, const msg::WorldState& world) {
  double min_distance = std::numeric_limits<double>::infinity();
  for (const msg::TrackedRobot& robot : world.robots())
    min_distance = std::min(min_distance, (position_of(robot) - obstacle_m).norm());
  return min_distance - kRadius_m;
}

/// Indices of the listed obstacles, matched by their positions at their last observations.
std::set<std::size_t> listed_of(const msg::ObstacleList& list, const Crowd& crowd) {
  std::set<std::size_t> found;
  std::map<std::int64_t, std::vector<Vec2>> positions_m;  // by time of observation
  for (const msg::TrackedObstacle& listed : list.obstacles()) {
    std::vector<Vec2>& positions = positions_m[listed.observed_at_ns()];
    if (positions.empty()) positions = crowd.positions_m(time_from_ns(listed.observed_at_ns()));
    const Vec2 listed_m(listed.x_m(), listed.y_m());
    const auto nearest =
        std::ranges::min_element(positions, {}, [&](const Vec2& p) { return (p - listed_m).squaredNorm(); });
    REQUIRE((*nearest - listed_m).norm() < 0.03);
    found.insert(static_cast<std::size_t>(nearest - positions.begin()));
  }
  return found;
}

/// Checks all promises in the definition of ObstacleList.
void check_list(const msg::ObstacleList& list, const msg::WorldState& world, const Crowd& crowd) {
  const Time t = time_from_ns(list.valid_at_ns());
  REQUIRE(list.valid_at_ns() == world.valid_at_ns());
  REQUIRE(list.obstacles().size() <= msg::MAX_OBSTACLES);
  REQUIRE(list.complete_within_m() >= 0);
  double last = -std::numeric_limits<double>::infinity();
  for (const msg::TrackedObstacle& o : list.obstacles()) {
    const double age_s = to_seconds(t - time_from_ns(o.observed_at_ns()));
    const double distance = edge_distance_m({o.x_m(), o.y_m()}, world) + kRadius_m - o.radius_m() -
                            4 * std::sqrt(o.position_variance_m2()) -
                            TrackerSettings{}.obstacles.max_speed_mps * std::abs(age_s);
    REQUIRE(distance >= last - 1e-9);
    last = distance;
  }
  const std::set<std::size_t> listed = listed_of(list, crowd);
  for (std::size_t i = 0; i < crowd.centres_m.size(); ++i) {
    const double distance = edge_distance_m(crowd.position_m(i, t), world);
    if (listed.contains(i) || distance >= list.complete_within_m()) continue;
    FAIL("obstacle " << i << " is at " << distance << " m and not listed, although the list claims to be "
                     << "complete within " << list.complete_within_m() << " m");
  }
}

TEST_CASE("every obstacle nearer than the list claims to be complete is listed, for crowds of up to 600") {
  const std::uint64_t seed = GENERATE(range(1u, 25u));
  Rng rng(seed);
  const std::size_t count = 20 + rng.below(581);
  const auto camera_count = static_cast<std::uint32_t>(1 + rng.below(4));
  CAPTURE(seed, count, camera_count);
  const Crowd crowd(count, 0.25, rng);
  const double width_m = 0.25 * std::ceil(std::sqrt(static_cast<double>(count))) + 0.5;
  const auto cameras = cameras_over(width_m, camera_count);
  std::vector<Vec2> starts_m, velocities_mps;
  for (std::uint64_t left = 1 + rng.below(8); left > 0; --left) {
    const double x = rng.uniform(-0.4, 0.4), y = rng.uniform(-0.4, 0.4);
    starts_m.push_back(width_m * Vec2(x, y));
    const double speed_mps = rng.uniform(0, 1.5), angle_rad = rng.uniform(-3, 3);
    velocities_mps.push_back(rotated({speed_mps, 0}, angle_rad));
  }
  TrackerFixture fixture(static_cast<RobotId>(starts_m.size()));
  int incomplete = 0, useful = 0;
  for (int k = 0; k < 30; ++k) {
    const Time t = kBegin + k * kFrame;
    std::vector<Vec2> robots_m;
    for (std::size_t i = 0; i < starts_m.size(); ++i)
      robots_m.push_back(starts_m[i] + to_seconds(t - kBegin) * velocities_mps[i]);
    for (const StripCamera& camera : cameras) {
      const msg::DetectionFrame frame = camera.capture(t, crowd, robots_m, rng);
      if (k < 5 || !rng.chance(0.1)) fixture.feed(frame);  // some frames are lost
    }
    if (k < 5) continue;  // tracks are not confirmed yet
    const Time valid_at = t + from_seconds(rng.uniform(0, 0.03));
    const msg::ObstacleList& list = fixture.obstacles_at(valid_at);
    const msg::WorldState world = fixture.world_at(valid_at);
    check_list(list, world, crowd);
    const bool is_incomplete = list.complete_within_m() < kCompleteEverywhere_m;
    if (count <= msg::MAX_OBSTACLES) REQUIRE_FALSE(is_incomplete);
    if (count > msg::MAX_OBSTACLES) REQUIRE(is_incomplete);
    incomplete += is_incomplete;
    useful += is_incomplete && list.complete_within_m() > 0.3;
  }
  // With a single camera, which sees all robots, the list's claim holds for each of them.
  if (incomplete > 0 && camera_count == 1) CHECK(useful > 0);
}

TEST_CASE(
    "the nearest obstacles of a resting crowd are listed, and the list is complete almost up to the farthest "
    "of them") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  const auto camera_count = GENERATE(1u, 4u);
  CAPTURE(seed, camera_count);
  Rng rng(seed);
  Crowd crowd(600, 0.3, rng);
  crowd.stop();
  const auto cameras = cameras_over(8, camera_count);
  const std::vector<Vec2> robots_m{{-1, 0.5}, {0.3, -1}, {1.2, 1}};
  TrackerFixture fixture(3);
  for (int k = 0; k < 20; ++k) {
    for (const StripCamera& camera : cameras)
      fixture.feed(camera.capture(kBegin + k * kFrame, crowd, robots_m, rng));
  }
  const Time t = kBegin + 19 * kFrame;
  const msg::ObstacleList list = fixture.obstacles_at(t);
  const msg::WorldState world = fixture.world_at(t);
  REQUIRE(list.obstacles().size() == msg::MAX_OBSTACLES);
  std::vector<double> distances_m;
  for (std::size_t i = 0; i < crowd.centres_m.size(); ++i)
    distances_m.push_back(edge_distance_m(crowd.position_m(i, t), world));
  std::sort(distances_m.begin(), distances_m.end());
  const double farthest_m = distances_m[msg::MAX_OBSTACLES - 1];
  CHECK(list.complete_within_m() > farthest_m - 0.05);
  CHECK(list.complete_within_m() <= farthest_m);
  for (const msg::TrackedObstacle& o : list.obstacles())
    CHECK(edge_distance_m({o.x_m(), o.y_m()}, world) < farthest_m + 0.02);
  check_list(list, world, crowd);
}

TEST_CASE("if all tracks are in use, the list is complete up to the nearest obstacle without a track") {
  const std::uint64_t seed = GENERATE(1u, 2u);
  CAPTURE(seed);
  Rng rng(seed);
  Crowd crowd(ObstacleTracker::kMaxTracks + 200, 0.25, rng);
  crowd.stop();
  const auto cameras = cameras_over(9, 10);
  TrackerFixture fixture(2);
  for (int k = 0; k < 20; ++k) {
    const Time t = kBegin + k * kFrame;
    for (const StripCamera& camera : cameras) {
      // All cameras see the robots, so each states a distance. One robot is among the obstacles seen by the
      // last cameras, for which no tracks are left.
      msg::DetectionFrame frame = camera.capture(t, crowd, {}, rng);
      add_noisy_robot(frame, 0, {{3.5, 0}, {0, 0}, 0}, {kNoise_m}, rng);
      add_noisy_robot(frame, 1, {{-2, 1}, {0, 0}, 0}, {kNoise_m}, rng);
      fixture.feed(frame);
    }
    if (k < 5) continue;
    const msg::ObstacleList& list = fixture.obstacles_at(t);
    check_list(list, fixture.world_at(t), crowd);
    CHECK(list.complete_within_m() < kCompleteEverywhere_m);
  }
  CHECK(fixture.rejected() > 0);
}

TEST_CASE("without a tracked robot, an incomplete list makes no claim of completeness") {
  const auto count = GENERATE(std::size_t{100}, std::size_t{300});
  Rng rng(4);
  const Crowd crowd(count, 0.3, rng);
  const auto cameras = cameras_over(6, 2);
  TrackerFixture fixture(2);
  for (int k = 0; k < 5; ++k) {
    for (const StripCamera& camera : cameras)
      fixture.feed(camera.capture(kBegin + k * kFrame, crowd, {}, rng));
  }
  const msg::ObstacleList& list = fixture.obstacles_at(kBegin + 4 * kFrame);
  CHECK(list.obstacles().size() == std::min<std::size_t>(count, msg::MAX_OBSTACLES));
  CHECK(list.complete_within_m() == (count > msg::MAX_OBSTACLES ? 0 : kCompleteEverywhere_m));
}

TEST_CASE("an incomplete frame limits the lists until the camera's next frame, at most for a second") {
  Rng rng(5);
  const StripCamera camera{0, -10, 30};
  Crowd crowd(msg::MAX_OBSTACLES, 0.3, rng);
  Crowd few(10, 0.3, rng);
  few.stop();
  for (int i = 0; i < 44; ++i) crowd.centres_m.emplace_back(8 + 0.3 * i, 0);  // frames omit these
  crowd.stop();
  TrackerFixture fixture(1);
  const auto feed = [&](const Crowd& seen, Time captured_at, Time arrival) {
    fixture.feed(camera.capture(captured_at, seen, {{0, 0}}, rng), arrival);
  };
  const auto complete_within_m = [&](Time t) { return fixture.obstacles_at(t).complete_within_m(); };
  for (int k = 0; k < 5; ++k) feed(crowd, kBegin + k * kFrame, kBegin + k * kFrame);
  const Time last = kBegin + 4 * kFrame, next = last + kFrame;
  const double at_first = complete_within_m(last);
  CHECK(at_first > 2);
  CHECK(at_first < 4);
  // The omitted obstacles may approach, so the distance shrinks.
  CHECK(complete_within_m(last + 100 * kMs) == Approx(at_first - 0.15).margin(0.01));
  CHECK(complete_within_m(last + 900 * kMs) < at_first - 1.3);
  SECTION("the next frame is complete") {
    feed(few, next, next);
    CHECK(complete_within_m(next) == kCompleteEverywhere_m);
  }
  SECTION("there is no next frame") { CHECK(complete_within_m(last + 1001 * kMs) == kCompleteEverywhere_m); }
  SECTION("an older frame arrives after the next one") {
    feed(crowd, next, next);
    const double before = complete_within_m(next);
    feed(crowd, last, next);
    CHECK(complete_within_m(next) == Approx(before).margin(0.005));
  }
}

TEST_CASE("256 obstacles are tracked and listed without memory allocations after a warm-up") {
  Rng rng(6);
  const Crowd crowd(msg::MAX_OBSTACLES, 0.3, rng);
  const StripCamera camera{0, -10, 10};
  std::vector<msg::DetectionFrame> frames;
  for (int k = 0; k < 60; ++k)
    frames.push_back(camera.capture(kBegin + k * kFrame, crowd, {{0, 0}, {1, 1}}, rng));
  TrackerFixture fixture(2);
  std::size_t before = 0;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    if (k == 10) before = allocation_count();
    fixture.feed(frames[k]);
    fixture.obstacles_at(time_from_ns(frames[k].captured_at_ns()));
  }
  CHECK(allocation_count() == before);
  CHECK(fixture.obstacles_at(kBegin + 59 * kFrame).obstacles().size() == msg::MAX_OBSTACLES);
}

}  // namespace sidestep::obstacle_list_test
