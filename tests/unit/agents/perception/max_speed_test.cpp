// SPDX-License-Identifier: Apache-2.0
#include "agents/perception/visibility.hpp"
#include "tests/catch.hpp"
#include "tests/unit/agents/perception/hidden_people.hpp"

namespace sidestep::max_speed_test {

constexpr double kPi = std::numbers::pi;
constexpr float kInfinite = std::numeric_limits<float>::infinity();

/// How far a robot that brakes has come after some time, and whether it still moves.
struct Braking {
  double speed_mps, reaction_s, deceleration_mps2;

  double rest_s() const { return reaction_s + speed_mps / deceleration_mps2; }
  double come_m(double seconds) const {
    const double braking_s = std::clamp(seconds - reaction_s, 0.0, speed_mps / deceleration_mps2);
    return speed_mps * (std::min(seconds, reaction_s) + braking_s) -
           deceleration_mps2 * braking_s * braking_s / 2;
  }
};

/// A scene with a robot, people in view, and people whom the laser cannot see.
struct Crowd {
  Rng rng;
  LaserSettings laser;
  test::Scene scene;
  VisibilitySettings settings;
  BrakingQuery query;
  double age_s;
  Visibility visibility;
  std::vector<Circle> people;

  explicit Crowd(std::uint64_t seed)
      : rng(seed),
        laser(random_full_laser(rng)),
        scene(seed, laser),
        settings{rng.uniform(0.1, 0.3), rng.uniform(0, 0.03)},
        age_s(rng.uniform(0, 0.15)),
        visibility(settings) {
    query.radius_m = rng.uniform(0.1, 0.3);
    query.reaction_s = rng.chance(0.2) ? 0 : rng.uniform(0, 0.3);
    query.deceleration_mps2 = rng.uniform(0.5, 4);
    query.person_speed_mps = rng.uniform(0.3, 2);
    query.limit_mps = 4;
    const Vec2 scanned_at = scene.random_free(rng, query.radius_m);
    query.at_m = scanned_at;
    const double x = rng.uniform(-0.2, 0.2), y = rng.uniform(-0.2, 0.2);
    if (scene.is_free(scanned_at, scanned_at + Vec2(x, y), query.radius_m)) query.at_m += Vec2(x, y);
    query.direction = rotated({1, 0}, rng.uniform(-kPi, kPi));
    query.now = time_from_ns(1'000'000'000) + from_seconds(age_s);
    look(scanned_at);
    hide(scanned_at);
  }

  static LaserSettings random_full_laser(Rng& rng) {
    LaserSettings result;
    result.beams = 180 + static_cast<int>(rng.below(600));
    if (rng.chance(0.1)) result.field_of_view_rad = rng.uniform(5, 6.2);
    result.max_range_m = rng.uniform(4, 8);
    return result;
  }

  /// Scans walls and people in view; only walls stand.
  void look(const Vec2& at) {
    for (int i = static_cast<int>(rng.below(3)); i > 0; --i) {
      const double radius_m = settings.person_radius_m * rng.uniform(1, 2);
      const Circle person{scene.random_free(rng, radius_m), radius_m};
      if (!touch(person, {at, 0.4})) people.push_back(person);
    }
    const LaserScan truth = scene.scan(at, rng.uniform(-4, 4), query.now - from_seconds(age_s), people,
                                       {0, 0, rng.chance(0.3) ? 0.2 : 0.0}, rng);
    true_ranges_m.assign(truth.ranges_m.begin(), truth.ranges_m.end());
    heading_rad = truth.heading_rad;
    LaserBeams beams(laser);
    const std::vector<float> ranges = test::with_errors(true_ranges_m, settings.range_error_m, rng);
    beams.read({at, heading_rad, truth.captured_at, ranges}, {});
    visibility.update(beams, [&](int beam) {
      const Vec2 hit = beams.end_m(beams[beam]);
      return std::ranges::none_of(people, [&](const Circle& person) {
        return touch(person, {hit, settings.range_error_m + 0.001});
      });
    });
  }
  void hide(const Vec2& at) {
    const test::HiddenPeople hidden({at, heading_rad, Time{}, true_ranges_m}, laser);
    const auto fits = [&](const Circle& person) {
      return scene.is_free(person.centre_m, person.centre_m, person.radius_m);
    };
    for (int i = 0; i < 600; ++i) {
      const double radius_m = settings.person_radius_m * (rng.chance(0.7) ? 1 : rng.uniform(1, 2));
      const double x = rng.uniform(-6, 6), y = rng.uniform(-6, 6);
      const Circle person{{x, y}, radius_m};
      if (!fits(person) || !hidden.is_hidden(person)) continue;
      people.push_back(person);
      people.push_back(hidden.approached(person, at, fits));
      const Vec2 ahead = query.at_m + rng.uniform(0, 3) * query.direction;
      people.push_back(hidden.approached(person, ahead, fits));
    }
  }

  enum class Contact { kNone, kWall, kPerson };

  /// Whether somebody can walk straight to the robot and touch it while it moves, or it reaches a wall first.
  Contact contact(double speed_mps) const {
    const Braking braking{speed_mps, query.reaction_s, query.deceleration_mps2};
    constexpr double kStep_s = 0.01;
    for (double t = 0; t < braking.rest_s(); t += kStep_s) {
      const Vec2 robot = query.at_m + braking.come_m(t) * query.direction;
      if (!scene.is_free(robot, robot, query.radius_m)) return Contact::kWall;
      for (const Circle& person : people) {
        const Vec2 way = robot - person.centre_m;
        const double walk_m = std::max(0.0, way.norm() - query.radius_m - person.radius_m);
        if (walk_m > query.person_speed_mps * (age_s + t)) continue;
        const Vec2 end = person.centre_m + walk_m * way.normalized();
        if (scene.is_free(person.centre_m, end, person.radius_m - 1e-6)) return Contact::kPerson;
      }
    }
    return Contact::kNone;
  }

  std::vector<float> true_ranges_m;
  double heading_rad = 0;
};

TEST_CASE("nobody who was hidden can touch a robot that moves, at any speed up to the highest") {
  using enum Crowd::Contact;
  int useful = 0, limited = 0, walls = 0, touched = 0;
  for (std::uint64_t seed = 1; seed <= 80; ++seed) {
    Crowd crowd(seed);
    for (int direction = 0; direction < 4; ++direction) {
      crowd.query.direction = rotated(crowd.query.direction, 1.5);
      const double speed = crowd.visibility.max_speed_mps(crowd.query);
      INFO("seed " << seed << ", direction " << direction << ", speed " << speed << " m/s");
      if (speed == 0) continue;
      ++useful;
      for (const double part : {1.0, 0.6, 0.2}) CHECK(crowd.contact(part * speed) == kNone);
      if (speed == crowd.query.limit_mps) continue;
      ++limited;
      const Crowd::Contact beyond = crowd.contact(1.3 * speed + 0.1);
      walls += beyond == kWall;
      touched += beyond == kPerson;
    }
  }
  WARN(useful << " of 320 speeds above 0, " << limited << " below the limit. At 1.3 times the speed, "
              << walls << " reach a wall, " << touched << " are touched");
  CHECK(useful > 250);
  // The bound is not much too low: often, a robot that is a little faster reaches a wall or is touched.
  CHECK(walls > limited / 10);
  CHECK(touched > limited / 10);
}

/// The formula of the derivation, for one frontier after the other and many speeds.
double slow_max_speed_mps(const Visibility& visibility, const BrakingQuery& query, double age_s) {
  constexpr double kStep_mps = 0.001;
  if (!visibility.was_seen_free(query.at_m)) return 0;
  const auto distance_m = [](const Vec2& p, const Segment& s) {
    const Vec2 along = s.to_m - s.from_m;
    const double length2 = along.dot(along);
    const double part = length2 == 0 ? 0 : (p - s.from_m).dot(along) / length2;
    return (s.from_m + std::min(1.0, std::max(0.0, part)) * along - p).norm();
  };
  for (double u = 0; u < query.limit_mps; u += kStep_mps) {
    const double rest_s = query.reaction_s + u / query.deceleration_mps2;
    const Vec2 rest =
        query.at_m + (u * query.reaction_s + u * u / 2 / query.deceleration_mps2) * query.direction;
    for (const Frontier& frontier : visibility.frontiers())
      if (distance_m(rest, frontier.segment) <=
          query.radius_m + frontier.bulge_m + query.person_speed_mps * (age_s + rest_s))
        return std::max(0.0, u - kStep_mps);
    for (const Frontier& gap : visibility.closed_gaps()) {
      const double reach_m = query.radius_m + gap.bulge_m;
      const bool was_near = distance_m(query.at_m, gap.segment) <= reach_m;
      const bool leaves =
          distance_m(query.at_m + 1e-4 * query.direction, gap.segment) >= distance_m(query.at_m, gap.segment);
      if (was_near && leaves) continue;
      if (distance_m(rest, gap.segment) <= reach_m) return std::max(0.0, u - kStep_mps);
    }
  }
  return query.limit_mps;
}

TEST_CASE("the highest speed is that of a slow search") {
  int above_0 = 0, far = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    Crowd crowd(seed);
    const double speed = crowd.visibility.max_speed_mps(crowd.query);
    const double slow = slow_max_speed_mps(crowd.visibility, crowd.query, crowd.age_s);
    CHECK(speed <= slow + 0.0021);
    CHECK(speed >= slow - 0.05);
    far += speed < slow - 0.003;
    above_0 += speed > 0;
  }
  CHECK(above_0 > 10);
  CHECK(far <= 3);
}

TEST_CASE("in the open, the range of the laser limits the speed") {
  const LaserSettings laser{90, 2 * kPi, 0.05, 6};
  LaserBeams beams(laser);
  const std::vector<float> ranges(90, kInfinite);
  beams.read({{1, 2}, 0, time_from_ns(5'000'000'000), ranges}, {});
  const double r = 0.3, error_m = 0.02;
  Visibility visibility({r, error_m});
  visibility.update(beams, [](int) { return true; });
  REQUIRE(visibility.frontiers().size() == 90);
  const double half_rad = kPi / 90, seen_m = 6 - error_m;
  const double sagitta_m = r - std::sqrt(r * r - std::pow(seen_m * std::sin(half_rad), 2));
  BrakingQuery query{.at_m = {1, 2},
                     .direction = rotated({1, 0}, half_rad),
                     .radius_m = 0.25,
                     .now = time_from_ns(5'200'000'000),
                     .limit_mps = 100};
  for (const double reaction_s : {0.0, 0.3})
    for (const double deceleration : {0.5, 3.0})
      for (const double person : {0.0, 0.5, 2.0}) {
        query.reaction_s = reaction_s;
        query.deceleration_mps2 = deceleration;
        query.person_speed_mps = person;
        // v² / 2 D + v (T + v_p / D) = room
        const double room_m =
            seen_m * std::cos(half_rad) - sagitta_m - query.radius_m - person * (0.2 + reaction_s);
        const double b = reaction_s + person / deceleration;
        const double expected = deceleration * (std::sqrt(b * b + 2 * room_m / deceleration) - b);
        CAPTURE(reaction_s, deceleration, person);
        CHECK(visibility.max_speed_mps(query) == Approx(expected).margin(0.0015));
        CHECK(visibility.max_speed_mps(query) <= expected + 1e-6);
      }
  query.limit_mps = 0.7;
  CHECK(visibility.max_speed_mps(query) == 0.7);
  query.at_m = {20, 2};
  CHECK(visibility.max_speed_mps(query) == 0);
}

//   ------------------+      the robot drives along a wall; beyond its
//   robot ->          |      end, people may come from the left
TEST_CASE("a robot slows down before a corner and beside a wall it does not have to") {
  const LaserSettings laser{1440, 2 * kPi, 0.05, 8};
  const auto speed_at = [&](double x, bool has_corner) {
    std::vector<Shape> walls{Segment{{-3, -1}, {5, -1}}, Segment{{5, -1}, {5, 6}}, Segment{{-3, -1}, {-3, 6}},
                             Segment{{-3, 6}, {5, 6}}};
    walls.emplace_back(Segment{{-3, 0.6}, {has_corner ? 2.0 : 5.0, 0.6}});
    const ObstacleWorld world(walls);
    std::vector<float> ranges(1440);
    LaserScanner(laser).scan({nullptr, nullptr, &world, {}}, {x, 0}, 0, ranges);
    LaserBeams beams(laser);
    beams.read({{x, 0}, 0, Time{}, ranges}, {});
    Visibility visibility({0.2, 0.01});
    visibility.update(beams, [](int) { return true; });
    return visibility.max_speed_mps({.at_m = {x, 0},
                                     .direction = {1, 0},
                                     .radius_m = 0.3,
                                     .now = Time{},
                                     .deceleration_mps2 = 2,
                                     .person_speed_mps = 1,
                                     .limit_mps = 3});
  };
  CHECK(speed_at(-1, true) > speed_at(0, true) + 0.2);
  CHECK(speed_at(0, true) > speed_at(1, true) + 0.2);
  CHECK(speed_at(0, false) > speed_at(0, true) + 0.5);
}

TEST_CASE("a robot that touches a wall may leave it") {
  const LaserSettings laser{720, 2 * kPi, 0.05, 8};
  const ObstacleWorld world({Segment{{0.25, -3}, {0.25, 3}}, Segment{{-3, -3}, {0.25, -3}},
                             Segment{{-3, 3}, {0.25, 3}}, Segment{{-3, -3}, {-3, 3}}});
  std::vector<float> ranges(720);
  LaserScanner(laser).scan({nullptr, nullptr, &world, {}}, {0, 0}, 0, ranges);
  LaserBeams beams(laser);
  beams.read({{0, 0}, 0, Time{}, ranges}, {});
  Visibility visibility({0.2, 0.01});
  visibility.update(beams, [](int) { return true; });
  BrakingQuery query{.at_m = {0, 0}, .direction = {-1, 0}, .radius_m = 0.3};
  CHECK(visibility.max_speed_mps(query) > 0.5);
  query.direction = {1, 0};
  CHECK(visibility.max_speed_mps(query) == 0);
}

TEST_CASE("bad queries are refused") {
  const Visibility visibility;
  const double nan = std::nan("");
  for (const BrakingQuery& query :
       {BrakingQuery{.at_m = {nan, 0}}, BrakingQuery{.direction = {1, 1}}, BrakingQuery{.radius_m = -1},
        BrakingQuery{.reaction_s = -1}, BrakingQuery{.deceleration_mps2 = 0},
        BrakingQuery{.person_speed_mps = nan}, BrakingQuery{.limit_mps = -1}})
    CHECK_THROWS_AS(visibility.max_speed_mps(query), std::invalid_argument);
}

}  // namespace sidestep::max_speed_test
