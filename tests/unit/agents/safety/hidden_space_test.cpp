// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/hidden_space.hpp"

#include "agents/perception/laser_sight.hpp"
#include "agents/safety/safety_search.hpp"
#include "common/motion/robot_model.hpp"
#include "tests/catch.hpp"
#include "tests/unit/agents/perception/hidden_people.hpp"

namespace sidestep::hidden_space_test {

constexpr double kPi = std::numbers::pi;
const Time kCapture = time_from_ns(1'000'000'000);

/// A scene with a robot, people in view, and people whom the laser cannot see.
struct Crowd {
  Rng rng;
  LaserSettings laser;
  test::Scene scene;
  VisibilitySettings settings;
  double radius_m, deceleration_mps2;
  Vec2 scanned_at;
  Visibility visibility;
  HiddenSpace hidden;
  std::vector<Circle> people;
  std::vector<float> true_ranges_m;
  double heading_rad = 0;

  explicit Crowd(std::uint64_t seed)
      : rng(seed),
        laser(random_full_laser(rng)),
        scene(seed, laser),
        settings{rng.uniform(0.1, 0.3), rng.uniform(0, 0.03)},
        radius_m(rng.uniform(0.1, 0.3)),
        deceleration_mps2(rng.uniform(0.5, 4)),
        scanned_at(scene.random_free(rng, radius_m)),
        visibility(settings) {
    look();
    hide();
    hidden = {visibility.frontiers(), visibility.closed_gaps(), kCapture, rng.uniform(0.3, 2)};
    hidden.observed_from_m = scanned_at;
  }

  static LaserSettings random_full_laser(Rng& rng) {
    LaserSettings result;
    result.beams = 180 + static_cast<int>(rng.below(600));
    if (rng.chance(0.1)) result.field_of_view_rad = rng.uniform(5, 6.2);
    result.max_range_m = rng.uniform(4, 8);
    return result;
  }

  /// Scans walls and people in view. Only walls are known to be stationary.
  void look() {
    for (int i = static_cast<int>(rng.below(3)); i > 0; --i) {
      const double person_m = settings.person_radius_m * rng.uniform(1, 2);
      const Circle person{scene.random_free(rng, person_m), person_m};
      if (!touch(person, {scanned_at, 0.4})) people.push_back(person);
    }
    const LaserScan truth = scene.scan(scanned_at, rng.uniform(-4, 4), kCapture, people,
                                       {0, 0, rng.chance(0.3) ? 0.2 : 0.0}, rng);
    true_ranges_m.assign(truth.ranges_m.begin(), truth.ranges_m.end());
    heading_rad = truth.heading_rad;
    LaserBeams beams(laser);
    const std::vector<float> ranges = test::with_errors(true_ranges_m, settings.range_error_m, rng);
    beams.read({scanned_at, heading_rad, kCapture, ranges}, {});
    const PriorMap walls{&scene.map()};
    visibility.update(beams, [&](const Vec2& p, double within_m) { return walls.nearest_m(p, within_m); });
  }

  void hide() {
    const test::HiddenPeople everybody({scanned_at, heading_rad, Time{}, true_ranges_m}, laser);
    const auto fits = [&](const Circle& person) {
      return scene.is_free(person.centre_m, person.centre_m, person.radius_m);
    };
    for (int i = 0; i < 600; ++i) {
      const double person_m = settings.person_radius_m * (rng.chance(0.7) ? 1 : rng.uniform(1, 2));
      const double x = rng.uniform(-6, 6), y = rng.uniform(-6, 6);
      const Circle person{{x, y}, person_m};
      if (!fits(person) || !everybody.is_hidden(person)) continue;
      people.push_back(person);
      people.push_back(everybody.approached(person, scanned_at, fits));
      const double ahead_x = rng.uniform(-2, 2), ahead_y = rng.uniform(-2, 2);
      people.push_back(everybody.approached(person, scanned_at + Vec2(ahead_x, ahead_y), fits));
    }
  }

  /// A motion that begins near the place of the scan, soon after it. It holds an acceleration and then stops.
  Trajectory random_motion() {
    const Vec2 along = rotated({1, 0}, rng.uniform(-kPi, kPi));
    const double speed_mps = rng.chance(0.2) ? 0 : rng.uniform(0, 2.5);
    Vec2 from = scanned_at + rng.uniform(0, 0.2) * along;
    if (!scene.is_free(scanned_at, from, radius_m) || !visibility.is_enclosed_by_frontiers(from))
      from = scanned_at;
    const Vec2 acceleration = rotated({rng.uniform(0, 3), 0}, rng.uniform(-kPi, kPi));
    return accelerate_then_stop(kCapture + from_seconds(rng.uniform(0, 0.15)), {from, speed_mps * along},
                                acceleration, from_seconds(rng.uniform(0.01, 0.1)), deceleration_mps2);
  }

  enum class Touch { kNone, kWall, kPerson };

  /// What happens first while the robot moves: it hits a wall, or a person who walks straight towards it can
  /// touch it.
  Touch first_touch(const Trajectory& motion) const {
    constexpr Duration kStep{10'000'000};
    for (Time t = motion.start(); t < motion.end(); t += kStep) {
      const Vec2 robot = motion.state_at(t).position_m;
      if (!scene.is_free(robot, robot, radius_m)) return Touch::kWall;
      for (const Circle& person : people) {
        const Vec2 way = robot - person.centre_m;
        const double walk_m = std::max(0.0, way.norm() - radius_m - person.radius_m);
        if (walk_m > hidden.speed_mps * to_seconds(t - kCapture)) continue;
        const Vec2 end = person.centre_m + walk_m * way.normalized();
        if (scene.is_free(person.centre_m, end, person.radius_m - 1e-6)) return Touch::kPerson;
      }
    }
    return Touch::kNone;
  }
};

TEST_CASE("no hidden person can touch a robot that moves as the hidden space check permits") {
  using enum Crowd::Touch;
  int allowed = 0, refused = 0, touched = 0, walls = 0;
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    Crowd crowd(seed);
    if (!crowd.visibility.is_enclosed_by_frontiers(crowd.scanned_at)) continue;
    for (int i = 0; i < 6; ++i) {
      CAPTURE(seed, i);
      const Trajectory motion = crowd.random_motion();
      const Crowd::Touch first = crowd.first_touch(motion);
      if (is_passively_safe_from_hidden(motion, crowd.hidden, crowd.radius_m)) {
        ++allowed;
        CHECK(first == kNone);
      } else {
        ++refused;
        touched += first == kPerson;
        walls += first == kWall;
      }
    }
  }
  WARN(allowed << " motions allowed, " << refused << " refused; of those, " << touched
               << " would have been touched, " << walls << " would have reached a wall");
  CHECK(allowed > 150);
  CHECK(refused > 100);
  // The check refuses few motions needlessly.
  CHECK(touched + walls > refused / 4);
}

/// Slow reference: the smallest clearance over many instants, by the formula in Visibility.
double reference_clearance_m(const Trajectory& motion, const HiddenSpace& hidden) {
  double room_m = 1e9;
  constexpr int kSteps = 2000;
  for (int i = 0; i <= kSteps; ++i) {
    const Time t = motion.start() + (motion.end() - motion.start()) * i / kSteps;
    const Vec2 p = motion.state_at(t).position_m;
    const double turned_m = hidden.heading_error_rad * (p - hidden.observed_from_m).norm();
    for (const Frontier& frontier : hidden.frontiers)
      room_m = std::min(room_m, std::sqrt(squared_distance(p, frontier.segment)) - frontier.bulge_m -
                                    hidden.speed_mps * to_seconds(t - hidden.observed_at) - turned_m);
    for (const Frontier& gap : hidden.closed_gaps)
      if (gap.bulge_m > 0)
        room_m = std::min(room_m, std::sqrt(squared_distance(p, gap.segment)) - gap.bulge_m - turned_m);
  }
  return room_m;
}

TEST_CASE("the hidden space check agrees with distances sampled at many instants") {
  int allowed = 0, refused = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Crowd crowd(seed);
    crowd.hidden.heading_error_rad = crowd.rng.uniform(0, 0.05);
    for (int i = 0; i < 4; ++i) {
      CAPTURE(seed, i);
      const Trajectory motion = crowd.random_motion();
      const double room_m = reference_clearance_m(motion, crowd.hidden);
      const bool is_safe = is_passively_safe_from_hidden(motion, crowd.hidden, crowd.radius_m);
      if (is_safe) CHECK(room_m > crowd.radius_m);
      if (!is_safe) CHECK(room_m < crowd.radius_m + 0.002);
      (is_safe ? allowed : refused) += 1;
    }
  }
  CHECK(allowed > 40);
  CHECK(refused > 40);
}

//  frontier      robot
//     |            o ->  away, slowly
TEST_CASE("a robot beside a frontier may move away slowly, but neither fast nor towards the frontier") {
  const std::vector<Frontier> frontiers{{{{0, -1}, {0, 1}}, 0}};
  HiddenSpace hidden{frontiers, {}, kCapture, 1.2};
  hidden.creep_mps = 0.03;
  const auto motion = [](double speed_mps) {
    Trajectory creeping(kCapture, {{0.1, 0}, {speed_mps, 0}});
    creeping.append(Duration{100'000'000}, {0, 0});
    append_stop(creeping, 5);
    return creeping;
  };
  CHECK(is_passively_safe_from_hidden(motion(0.03), hidden, 0.09));
  CHECK_FALSE(is_passively_safe_from_hidden(motion(-0.03), hidden, 0.09));
  CHECK_FALSE(is_passively_safe_from_hidden(motion(0.04), hidden, 0.09));
  hidden.creep_mps = 0;
  CHECK_FALSE(is_passively_safe_from_hidden(motion(0.03), hidden, 0.09));
  CHECK(is_passively_safe_from_hidden(Trajectory::resting(kCapture, {0.1, 0}), hidden, 0.09));
  CHECK(is_passively_safe_from_hidden(motion(2), {}, 0.09));
}

//   ----+ O +----   a corridor, and a person O in a doorway that is
//   ...  r ->  ...   hardly wider than the person, or much wider
//   -------------
struct Doorway {
  Rng rng;
  FloorRules rules;
  LaserSpec laser;
  LaserSightSettings errors;
  std::vector<Circle> people;
  double speed_mps = 0;
  Vec2 robot_m{0, 0};

  explicit Doorway(std::uint64_t seed) : rng(seed) {
    const double person_m = rng.uniform(0.1, 0.35), lane_m = rng.uniform(0.5, 1.2),
                 wall_m = rng.uniform(0.05, 0.4);
    const double half_m =
        std::max(person_m + (rng.chance(0.5) ? rng.uniform(0, 0.1) : 0.0), rng.uniform(0.15, 0.6));
    rules.radius_m = rng.uniform(0.08, 0.25);
    rules.margin_m = rng.uniform(0.012, 0.05);
    rules.obstacles = {Box{{-5, lane_m}, {-half_m, lane_m + wall_m}},
                       Box{{half_m, lane_m}, {5, lane_m + wall_m}}, Box{{-5, -lane_m - 0.1}, {5, -lane_m}}};
    speed_mps = rng.uniform(0.3, 2);
    laser.settings = {360 + static_cast<int>(rng.below(720)), 2 * kPi, 0.02, 8};
    laser.person_radius_m = person_m;
    laser.range_error_m = rng.uniform(0, 0.05);
    errors = {.position_error_m = rng.uniform(0, rules.margin_m / 2),
              .heading_error_rad = rng.uniform(0, 0.03)};
    const double room_m = rules.radius_m + rules.margin_m;
    robot_m = {rng.uniform(-2, 1), rng.uniform(-lane_m + room_m, lane_m - room_m)};
    for (int i = 0; i < 300 && people.size() < 3; ++i) {
      const double size_m = person_m * (rng.chance(0.6) ? 1 : rng.uniform(1, 1.5));
      const double x = rng.uniform(-half_m, half_m),
                   y = rng.uniform(lane_m - size_m, lane_m + wall_m + size_m);
      const Circle person{{x, y}, size_m};
      if (is_free(person.centre_m, person.centre_m, size_m) &&
          !touch(person, {robot_m, rules.radius_m + 0.02}))
        people.push_back(person);
    }
  }

  bool is_free(const Vec2& from, const Vec2& to, double radius_m) const {
    return std::ranges::none_of(rules.obstacles, [&](const Shape& wall) {
      return squared_distance(Segment{from, to}, wall) < radius_m * radius_m;
    });
  }

  /// Takes a scan with wrong ranges and a wrong pose.
  void look(LaserSight& sight) {
    const ObstacleWorld world(rules.obstacles);
    std::vector<float> ranges(static_cast<std::size_t>(laser.settings.beams));
    const double heading_rad = rng.uniform(-kPi, kPi);
    LaserScanner(laser.settings).scan({nullptr, nullptr, &world, people}, robot_m, heading_rad, ranges);
    const double error_m = rng.uniform(0, errors.position_error_m);
    const Vec2 at = robot_m + rotated({error_m, 0}, rng.uniform(-kPi, kPi));
    const double turned_rad = rng.uniform(-errors.heading_error_rad, errors.heading_error_rad);
    REQUIRE(sight.update(
        {at, heading_rad + turned_rad, kCapture, test::with_errors(ranges, laser.range_error_m, rng)}, {}));
  }

  Trajectory random_motion() {
    const double part = rng.uniform(),
                 angle_rad = rng.chance(0.7) ? rng.uniform(-0.3, 0.3) : rng.uniform(-kPi, kPi);
    const Vec2 along = rotated({1, 0}, angle_rad);
    return accelerate_then_stop(kCapture + from_seconds(rng.uniform(0, 0.2)), {robot_m, 2 * part * along},
                                rng.uniform(-3, 3) * along, from_seconds(rng.uniform(0.01, 0.1)),
                                rng.uniform(1, 5));
  }

  Crowd::Touch first_touch(const Trajectory& motion) const {
    constexpr Duration kStep{5'000'000};
    for (Time t = motion.start(); t < motion.end(); t += kStep) {
      const Vec2 robot = motion.state_at(t).position_m;
      if (!is_free(robot, robot, rules.radius_m + rules.margin_m)) return Crowd::Touch::kWall;
      for (const Circle& person : people) {
        const Vec2 way = robot - person.centre_m;
        const double walk_m = std::max(0.0, way.norm() - rules.radius_m - person.radius_m);
        if (walk_m > speed_mps * to_seconds(t - kCapture)) continue;
        const Vec2 end = person.centre_m + walk_m * way.normalized();
        if (is_free(person.centre_m, end, person.radius_m - 1e-6)) return Crowd::Touch::kPerson;
      }
    }
    return Crowd::Touch::kNone;
  }
};

TEST_CASE("no person in a doorway can touch a robot that moves as the hidden space check permits") {
  using enum Crowd::Touch;
  int allowed = 0, refused = 0, touched = 0;
  for (std::uint64_t seed = 1; seed <= 1500; ++seed) {
    Doorway doorway(seed);
    LaserSight sight(doorway.laser, doorway.rules, doorway.errors);
    doorway.look(sight);
    HiddenSpace hidden{sight.visibility().frontiers(), sight.visibility().closed_gaps(), kCapture,
                       doorway.speed_mps};
    hidden.heading_error_rad = doorway.errors.heading_error_rad;
    hidden.observed_from_m = sight.beams().at_m();
    if (!sight.visibility().is_enclosed_by_frontiers(doorway.robot_m)) continue;
    for (int i = 0; i < 8; ++i) {
      CAPTURE(seed, i);
      const Trajectory motion = doorway.random_motion();
      const Crowd::Touch first = doorway.first_touch(motion);
      if (first == kWall) continue;
      const double separation_m = doorway.rules.radius_m + doorway.rules.margin_m;
      if (is_passively_safe_from_hidden(motion, hidden, separation_m)) {
        ++allowed;
        CHECK(first == kNone);
      } else {
        ++refused;
        touched += first == kPerson;
      }
    }
  }
  WARN(allowed << " motions allowed, " << refused << " refused, of which " << touched
               << " would have been touched");
  CHECK(allowed > 1000);
  CHECK(touched > 300);
}

TEST_CASE("the search finds no candidate that a hidden person could touch during motion") {
  int found = 0, limited = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    Crowd crowd(seed);
    FloorRules rules;
    rules.field = {30, 30};
    rules.radius_m = crowd.radius_m;
    rules.limits.deceleration_mps2 = 5;
    SafetySearch search(rules);
    SearchQuery query{kCapture + Duration{50'000'000}, {crowd.scanned_at, Vec2(crowd.rng.uniform(0, 2), 0)}};
    query.desired_mps2 = {crowd.rng.uniform(-3, 3), crowd.rng.uniform(-3, 3)};
    query.hold_time = Duration{16'666'667};
    TrajectoryIndex nobody;
    const SearchResult without = search.search(query, nobody, crowd.rng);
    for (std::size_t i = 0; i < without.count; ++i)
      limited += !is_passively_safe_from_hidden(without.candidates[i], crowd.hidden,
                                                rules.radius_m + rules.margin_m);
    query.hidden = crowd.hidden;
    const SearchResult result = search.search(query, nobody, crowd.rng);
    for (std::size_t i = 0; i < result.count; ++i)
      CHECK(
          is_passively_safe_from_hidden(result.candidates[i], crowd.hidden, rules.radius_m + rules.margin_m));
    found += result.count > 0;
  }
  CHECK(found > 10);
  CHECK(limited > 10);
}

}  // namespace sidestep::hidden_space_test
