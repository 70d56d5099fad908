// SPDX-License-Identifier: Apache-2.0
#include "agents/perception/visibility.hpp"

#include "agents/perception/prior_map.hpp"
#include "tests/catch.hpp"
#include "tests/unit/agents/perception/hidden_people.hpp"

namespace sidestep::visibility_test {

constexpr double kPi = std::numbers::pi;
constexpr float kInfinite = std::numeric_limits<float>::infinity();
const auto kNothing = [](const Vec2&, double) { return std::optional<Vec2>(); };

/// Looks up known points of the scene, with occasional omissions.
auto known_in(const test::Scene& scene, Rng& rng, double unknown = 0) {
  return [&scene, &rng, unknown](const Vec2& p, double within_m) {
    return rng.chance(unknown) ? std::nullopt : PriorMap{&scene.map()}.nearest_m(p, within_m);
  };
}

TEST_CASE("no point of a hidden person counts as seen free") {
  int hidden = 0, near = 0, wrong = 0;
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    Rng rng(seed);
    const LaserSettings laser = test::random_laser(rng);
    INFO("seed " << seed << ", beams " << laser.beams << ", field of view " << laser.field_of_view_rad);
    test::Scene scene(seed, laser);
    const VisibilitySettings settings{rng.uniform(0.05, 0.4), rng.uniform(0, 0.05)};
    const Vec2 at = scene.random_free(rng, 0.25);
    const LaserScan truth =
        scene.scan(at, rng.uniform(-4, 4), Time{}, {}, {0, 0, rng.chance(0.5) ? 0.3 : 0.0}, rng);
    const test::HiddenPeople people(truth, laser);
    const std::vector<float> ranges = test::with_errors(truth.ranges_m, settings.range_error_m, rng);
    LaserBeams beams(laser);
    beams.read({at, truth.heading_rad, Time{}, ranges}, {});
    Visibility visibility(settings);
    visibility.update(beams, known_in(scene, rng, 0.15));
    int wrong_here = 0;
    for (int i = 0; i < 150; ++i) {
      const double x = rng.uniform(-8, 8), y = rng.uniform(-8, 8);
      Circle person{at + Vec2(x, y), settings.person_radius_m * (rng.chance(0.5) ? 1 : rng.uniform(1, 4))};
      if (!people.is_hidden(person)) continue;
      ++hidden;
      person = people.approached(person, at, [](const Circle&) { return true; });
      for (int k = 0; k < 60; ++k) {
        const double angle_rad = rng.uniform(0, 2 * kPi), part = k < 40 ? 1 : std::sqrt(rng.uniform());
        const Vec2 point = person.centre_m + rotated({part * person.radius_m, 0}, angle_rad);
        wrong_here += visibility.was_seen_free(point);
        near += (point - at).norm() < 2;
      }
    }
    CHECK(wrong_here == 0);
    wrong += wrong_here;
  }
  CHECK(hidden > 3000);
  CHECK(near > 3000);
}

TEST_CASE("most of the space in view counts as seen free") {
  int in_view = 0, free = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Rng rng(seed);
    const LaserSettings laser{720, 2 * kPi, 0.05, 8};
    test::Scene scene(seed, laser);
    const Vec2 at = scene.random_free(rng, 0.25);
    LaserBeams beams(laser);
    beams.read(scene.scan(at, rng.uniform(-4, 4), Time{}, {}, {}, rng), {});
    Visibility visibility({0.15, 0.01});
    visibility.update(beams, known_in(scene, rng));
    CHECK(visibility.was_seen_free(at));
    for (int i = 0; i < 1000; ++i) {
      const double x = rng.uniform(-5, 5), y = rng.uniform(-5, 5);
      const Vec2 point = at + Vec2(x, y);
      if (!scene.is_free(at, point, 0.05)) {
        if (!scene.is_free(at, point, 0)) CHECK_FALSE(visibility.was_seen_free(point));
        continue;
      }
      ++in_view;
      free += visibility.was_seen_free(point);
    }
  }
  CHECK(in_view > 2000);
  CHECK(free > 0.95 * in_view);
}

/// A scan of shapes from the origin.
struct View {
  LaserBeams beams;
  Visibility visibility;

  View(const LaserSettings& laser, const std::vector<Shape>& shapes, const VisibilitySettings& settings,
       std::span<const Circle> robots = {}, bool stand = true, double dropouts = 0)
      : beams(laser), visibility(settings) {
    const ObstacleWorld world(shapes);
    std::vector<float> ranges(static_cast<std::size_t>(laser.beams));
    LaserScanner(laser).scan({nullptr, nullptr, &world, robots}, {0, 0}, 0, ranges);
    Rng rng(1);
    for (float& range_m : ranges)
      if (rng.chance(dropouts)) range_m = test::kNoRange;
    beams.read({{0, 0}, 0, Time{}, ranges}, robots);
    const PriorMap floor{nullptr, &world};
    visibility.update(beams, [&](const Vec2& p, double within_m) {
      return stand ? floor.nearest_m(p, within_m) : std::nullopt;
    });
  }
  /// The distance from the origin to the nearest frontier in this direction.
  double frontier_m(double angle_rad) const {
    double nearest = 1e9;
    const Segment line{{0, 0}, rotated({100, 0}, angle_rad)};
    for (const Frontier& frontier : visibility.frontiers())
      if (intersect(line, frontier.segment))
        nearest = std::min(nearest, squared_distance(Vec2(0, 0), frontier.segment));
    return std::sqrt(nearest);
  }
};

//            |   |          posts that stand at x = 3, d apart
//   robot    :   :
TEST_CASE("a gap is closed if it is too narrow and both of its sides are stationary") {
  const LaserSettings laser{1440, 2 * kPi, 0.05, 8};
  const VisibilitySettings settings{0.25, 0.01};
  const auto room = [](double gap_m) {
    const double middle_m = 3 * std::tan(kPi / 1440);  // between two beams
    return std::vector<Shape>{Segment{{3, -3}, {3, middle_m - gap_m / 2}},
                              Segment{{3, middle_m + gap_m / 2}, {3, 3}}, Segment{{-3, -3}, {3, -3}},
                              Segment{{-3, 3}, {3, 3}}, Segment{{-3, -3}, {-3, 3}}};
  };
  // Beams pass through both gaps: 0.6 m is wide enough for a person, 0.3 m is too narrow.
  const View open(laser, room(0.6), settings), fence(laser, room(0.3), settings);
  CHECK(open.frontier_m(0.01) < 8);
  CHECK(open.visibility.was_seen_free({4, 0.01}));
  CHECK(fence.visibility.frontiers().empty());
  CHECK(fence.visibility.was_seen_free({4, 0.01}));
  CHECK(View(laser, room(0.3), settings, {}, false).frontier_m(0.01) < 8);
  // A gap between two beams is closed.
  const View narrow(laser, room(0.005), settings);
  CHECK(narrow.visibility.frontiers().empty());
  CHECK(narrow.visibility.closed_gaps().size() == 1440);
  CHECK(narrow.visibility.was_seen_free({2.9, 0}));
  CHECK_FALSE(narrow.visibility.was_seen_free({3.1, 0}));
  // If the same walls may move, every hit is a frontier.
  const View loose(laser, room(0.005), settings, {}, false);
  CHECK(loose.visibility.closed_gaps().empty());
  CHECK(loose.frontier_m(0.3) < 3.2);
  CHECK(loose.visibility.was_seen_free({2.9, 0}));
  // A gap is closed only if both sides are known; here, only one side is known.
  const ObstacleWorld half({Segment{{3, -3}, {3, 0}}});
  Visibility lone(settings);
  lone.update(fence.beams, [&](const Vec2& p, double within_m) {
    return PriorMap{nullptr, &half}.nearest_m(p, within_m);
  });
  const auto is_open_at = [&](double y_m) {
    return std::ranges::any_of(lone.frontiers(), [&](const Frontier& frontier) {
      return intersect(Segment{{0, 0}, {100, 100 * y_m / 3}}, frontier.segment);
    });
  };
  CHECK_FALSE(is_open_at(-0.5));
  CHECK_FALSE(is_open_at(0.1));  // still too near to the end of the known half
  CHECK(is_open_at(0.4));
  CHECK(is_open_at(0.5));
  // Dropouts leave gaps of a few beams, which are too narrow for a person.
  const View gaps(laser, room(0.005), settings, {}, true, 0.3);
  CHECK(gaps.visibility.frontiers().empty());
  CHECK(gaps.visibility.was_seen_free({2.9, 0.05}));
  // With coarse beams, gaps of 0.4 m in the middle of the wall are closed, gaps of 0.6 m are not.
  const View coarse({48, 2 * kPi, 0.05, 8}, room(0.005), settings);
  CHECK(coarse.frontier_m(0.05) > 1e3);
  const View coarser({30, 2 * kPi, 0.05, 8}, room(0.005), settings);
  CHECK(coarser.frontier_m(0.05) < 3);
}

//   wall |  |  wall        a person O stands in the doorway
//        | O|              and almost touches its walls
//        o  robot
TEST_CASE("the surface of a person in a passable doorway is a frontier, however near the walls are") {
  const LaserSettings laser{720, 2 * kPi, 0.05, 8};
  for (const double radius_m : {0.1, 0.15, 0.25, 0.35}) {
    for (const double more_m : {0.001, 0.02, 0.05, 0.1, 0.2}) {
      CAPTURE(radius_m, more_m);
      const double half_m = radius_m + more_m / 2;
      const std::vector<Shape> walls{Box{{-3, 1}, {-half_m, 1.3}}, Box{{half_m, 1}, {3, 1.3}}};
      const Circle person{{0, 1 + radius_m / 2}, radius_m};
      const View view(laser, walls, {radius_m, 0.03}, {&person, 1});
      const bool is_open = std::ranges::any_of(view.visibility.frontiers(), [&](const Frontier& frontier) {
        return intersect(Segment{{0, 0}, person.centre_m}, frontier.segment);
      });
      CHECK(is_open);
    }
    // No person fits through a narrower doorway, so what is seen in it does not matter.
    const double half_m = radius_m - 0.01;
    const View view(laser, {Box{{-3, 1}, {-half_m, 1.3}}, Box{{half_m, 1}, {3, 1.3}}}, {radius_m, 0.005});
    CHECK(std::ranges::none_of(view.visibility.frontiers(), [&](const Frontier& frontier) {
      return intersect(Segment{{0, 0}, {0, 1.1}}, frontier.segment);
    }));
  }
}

TEST_CASE("no person can hide behind a thin post") {
  const LaserSettings laser{1440, 2 * kPi, 0.05, 8};
  const auto room = [](double radius_m) {
    return std::vector<Shape>{Segment{{3, -3}, {3, 3}}, Segment{{-3, -3}, {3, -3}}, Segment{{-3, 3}, {3, 3}},
                              Segment{{-3, -3}, {-3, 3}}, Circle{{1, 0.1}, radius_m}};
  };
  const View thin(laser, room(0.03), {0.25, 0.01}), thick(laser, room(0.2), {0.25, 0.01});
  CHECK(thin.visibility.frontiers().empty());
  CHECK(thin.visibility.was_seen_free({2, 0.2}));
  CHECK(thick.visibility.frontiers().size() > 1);
  CHECK_FALSE(thick.visibility.was_seen_free({2, 0.2}));
}

TEST_CASE("a frontier lies behind a known robot that hides people, as near as their size permits") {
  const LaserSettings laser{720, 2 * kPi, 0.05, 8};
  const std::vector<Shape> walls{Segment{{3, -3}, {3, 3}}, Segment{{-3, -3}, {3, -3}},
                                 Segment{{-3, 3}, {3, 3}}, Segment{{-3, -3}, {-3, 3}}};
  const std::vector<Circle> robots{{{2, 0}, 0.3}};
  const View view(laser, walls, {0.2, 0.01}, robots);
  // A disc with a radius of 0.2 m can hide behind a robot with a radius of 0.3 m, but not between the wall
  // and a robot with a radius of 0.1 m.
  CHECK(view.frontier_m(0.01) == Approx(1.69).margin(0.02));
  const std::vector<Circle> small{{{2, 0}, 0.1}};
  const View beside(laser, walls, {0.2, 0.01}, small);
  CHECK(beside.visibility.was_seen_free({2.8, 0}));
  CHECK(view.frontier_m(0.5) > 1e3);
  CHECK_FALSE(view.visibility.was_seen_free({2.8, 0}));
  CHECK(view.visibility.was_seen_free({1.5, 0}));
}

TEST_CASE("unseen sectors and empty scans count as frontiers") {
  // The laser does not see a sector of 90 degrees behind the robot.
  const View view({271, 1.5 * kPi, 0.05, 8}, {}, {0.2, 0});
  CHECK(view.frontier_m(kPi - 0.001) == Approx(0.2 / std::sin(kPi / 4) - 0.2).margin(0.01));
  CHECK(view.frontier_m(0.001) == Approx(8).margin(0.01));
  CHECK(view.visibility.was_seen_free({-0.05, 0}));
  CHECK_FALSE(view.visibility.was_seen_free({-0.3, 0}));
  // With a field of view of half a turn or less, a person may stand directly behind the scanner.
  const View half({181, kPi, 0.05, 8}, {}, {0.2, 0});
  CHECK_FALSE(half.visibility.was_seen_free({-0.001, 0}));
  CHECK(half.visibility.was_seen_free({0.1, 0}));
  // If all beams are dropouts, no space is seen free.
  const LaserSettings laser{90, 2 * kPi, 0.05, 8};
  LaserBeams beams(laser);
  const std::vector<float> dropouts(90, test::kNoRange);
  beams.read({{1, 1}, 0, Time{}, dropouts}, {});
  Visibility blind({0.2, 0});
  CHECK_FALSE(blind.was_seen_free({1, 1}));
  blind.update(beams, kNothing);
  CHECK_FALSE(blind.was_seen_free({1, 1}));
  REQUIRE(blind.frontiers().size() == 1);
  CHECK(blind.frontiers()[0].segment.from_m == Vec2(1, 1));
  CHECK_FALSE(blind.is_enclosed_by_frontiers({1, 1}));
}

TEST_CASE("the border encloses the scanner without gaps") {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const LaserSettings laser = test::random_laser(rng);
    test::Scene scene(seed, laser);
    const Vec2 at = scene.random_free(rng, 0.25);
    LaserBeams beams(laser);
    beams.read(scene.scan(at, 0, Time{}, {}, {0.01, 0.03, 0.1}, rng), {});
    Visibility visibility({0.2, 0.03});
    visibility.update(beams, known_in(scene, rng, 0.3));
    std::vector<Segment> border;
    for (const Frontier& frontier : visibility.frontiers()) border.push_back(frontier.segment);
    for (const Frontier& gap : visibility.closed_gaps()) border.push_back(gap.segment);
    // The border separates every point seen free from every point not seen free.
    for (int i = 0; i < 100; ++i) {
      const double x = rng.uniform(-6, 6), y = rng.uniform(-6, 6), x2 = rng.uniform(-6, 6),
                   y2 = rng.uniform(-6, 6);
      const Segment line{at + Vec2(x, y), at + Vec2(x2, y2)};
      if (!visibility.was_seen_free(line.from_m) || visibility.was_seen_free(line.to_m)) continue;
      double nearest_m = 1e9;
      for (std::size_t k = 0; k < border.size(); ++k)
        nearest_m = std::min(nearest_m, std::sqrt(squared_distance(line, border[k])));
      // Points inside bulges do not count as seen free although they lie within the border.
      CHECK(nearest_m < 0.2);
    }
  }
}

TEST_CASE("visibility refuses invalid settings") {
  CHECK_THROWS_AS(Visibility({0, 0}), std::invalid_argument);
  CHECK_THROWS_AS(Visibility({0.2, -1}), std::invalid_argument);
  CHECK_THROWS_AS(Visibility({std::nan(""), 0}), std::invalid_argument);
  CHECK_THROWS_AS(Visibility({0.2, kInfinite}), std::invalid_argument);
  CHECK_THROWS_AS(Visibility({0.2, 0, -1}), std::invalid_argument);
  CHECK_THROWS_AS(Visibility({0.2, 0, 0, kInfinite}), std::invalid_argument);
  CHECK_THROWS_AS(Visibility({0.2, 0, 0, 0, std::nan("")}), std::invalid_argument);
}

}  // namespace sidestep::visibility_test
