// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/contacts.hpp"

#include <map>
#include <utility>
#include <vector>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/map/random_map.hpp"

namespace sidestep::contacts_test {

constexpr double kRadius_m = 0.09;

// Slow reference: checks every pair in every step.
struct BruteForce {
  std::vector<Shape> obstacles;
  std::shared_ptr<const FloorMap> map;
  ContactTotals totals;
  std::map<std::pair<std::size_t, std::size_t>, bool> touching;

  double map_distance_m(const Vec2& p) const {
    const Vec2 size_m = map->cells().extent().max_m, inside = size_m - p.cwiseAbs();
    double nearest_m = std::min(inside.x(), inside.y());
    for (const Box& cell : test::blocked_boxes(map->cells()))
      nearest_m = std::min(nearest_m, signed_distance(p, cell));
    return nearest_m;
  }

  void check(std::size_t a, std::size_t b, double clearance) {
    totals.min_clearance_m = std::min(totals.min_clearance_m, clearance);
    bool& touches = touching[{a, b}];
    if (clearance < 0) {
      if (!touches) ++totals.contacts;
      touches = true;
      totals.penetration_m_s -= clearance * kPhysicsStepSeconds;
    } else if (clearance > Contacts::kContactHysteresis_m) {
      touches = false;
    }
  }

  void step(const std::vector<Body>& bodies) {
    for (std::size_t a = 0; a < bodies.size(); ++a) {
      for (std::size_t b = a + 1; b < bodies.size(); ++b) {
        check(a, b, (bodies[a].position_m() - bodies[b].position_m()).norm() - 2 * kRadius_m);
      }
      for (std::size_t k = 0; k < obstacles.size(); ++k) {
        check(a, bodies.size() + k, signed_distance(bodies[a].position_m(), obstacles[k]) - kRadius_m);
      }
      if (map) check(a, bodies.size() + obstacles.size(), map_distance_m(bodies[a].position_m()) - kRadius_m);
    }
  }
};

/// A map centred at the origin, with single blocked cells outside a square.
std::shared_ptr<const FloorMap> posts_around(double side_m) {
  constexpr double kCell_m = 0.25;
  MapGrid grid;
  grid.columns = grid.rows = 2 * static_cast<int>((side_m + 1) / kCell_m);
  grid.resolution_m = kCell_m;
  grid.origin_m = Vec2::Constant(-grid.columns * kCell_m / 2);
  BitGrid blocked(grid.columns, grid.rows);
  for (int row = 0; row < grid.rows; row += 3)
    for (int column = 0; column < grid.columns; column += 3)
      if (grid.box_of({column, row}).min_m.cwiseAbs().maxCoeff() > side_m / 2 + 0.5) blocked.set(column, row);
  return std::make_shared<const FloorMap>(OccupancyMap(grid, std::move(blocked)));
}

TEST_CASE("contacts, penetration and clearance agree with a check of every pair in every step") {
  const std::uint64_t seed = GENERATE(range<std::uint64_t>(1, 21));
  CAPTURE(seed);
  Rng rng(seed);
  const double side = seed % 2 == 0 ? 4 : 12;
  std::vector<Body> bodies;
  const auto is_free = [&bodies](const Vec2& p) {
    for (const Body& other : bodies) {
      if ((other.position_m() - p).norm() < 0.3) return false;
    }
    return true;
  };
  while (bodies.size() < 25) {
    const double y = rng.uniform(-side / 2, side / 2), x = rng.uniform(-side / 2, side / 2);
    const Vec2 p(x, y);
    if (is_free(p)) bodies.emplace_back(p, 0.0, BodySettings{});
  }
  const double beside = side / 2 + 0.6;
  BruteForce slow{{Circle{{side, side}, 0.2}, Circle{{-beside, 0}, 0.3}, Box{{beside, -1}, {beside + 0.3, 1}},
                   ConvexPolygon{{{-1, beside}, {0.5, beside + 0.1}, {0, beside + 0.5}}},
                   Segment{{-1, -beside}, {1, -beside - 0.3}}},
                  seed % 4 == 0 ? posts_around(side) : nullptr,
                  {},
                  {}};
  Contacts contacts(slow.obstacles, slow.map, kRadius_m, BodySettings{}.speed_mps);
  std::vector<Vec2> desired_accelerations(bodies.size(), Vec2(0, 0));
  for (int step = 0; step < 3000; ++step) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (step % 100 == 0) desired_accelerations[i] = rotated(Vec2(6, 0), rng.uniform(-3.14, 3.14));
      if (bodies[i].position_m().norm() > side)
        desired_accelerations[i] = -6 * bodies[i].position_m().normalized();
      bodies[i].step({desired_accelerations[i], 0});
    }
    slow.step(bodies);
    contacts.step(bodies);
    REQUIRE(contacts.totals().min_clearance_m == Approx(slow.totals.min_clearance_m).margin(1e-12));
  }
  CHECK(contacts.totals().contacts == slow.totals.contacts);
  CHECK(contacts.totals().penetration_m_s == Approx(slow.totals.penetration_m_s));
  if (side == 4) CHECK(slow.totals.contacts > 4);
}

TEST_CASE("two robots that drive at each other touch once and do not pass through each other") {
  std::vector<Body> bodies{Body({-1, 0}, 0, {}), Body({1, 0}, 0, {})};
  Contacts contacts({}, nullptr, kRadius_m, BodySettings{}.speed_mps);
  for (int step = 0; step < 3000; ++step) {
    bodies[0].step({Vec2(3, 0), 0});
    bodies[1].step({Vec2(-3, 0), 0});
    contacts.step(bodies);
    REQUIRE((bodies[0].position_m() - bodies[1].position_m()).norm() > 2 * kRadius_m - 0.006);
    REQUIRE(bodies[0].position_m().x() < bodies[1].position_m().x());
  }
  CHECK(contacts.totals().contacts == 1);
  CHECK(contacts.totals().penetration_m_s > 0);
  CHECK(contacts.totals().min_clearance_m < 0);
}

TEST_CASE("robots that separate and meet again touch twice") {
  std::vector<Body> bodies{Body({-0.2, 0}, 0, {}), Body({0.2, 0}, 0, {})};
  Contacts contacts({}, nullptr, kRadius_m, BodySettings{}.speed_mps);
  for (const double direction : {1.0, -1.0, 1.0}) {
    for (int step = 0; step < (direction > 0 ? 1500 : 1000); ++step) {
      bodies[0].step({Vec2(2 * direction, 0), 0});
      bodies[1].step({Vec2(-2 * direction, 0), 0});
      contacts.step(bodies);
    }
    for (int step = 0; step < 2000; ++step) {
      for (Body& body : bodies) body.step({-10 * body.velocity_mps(), 0});
      contacts.step(bodies);
    }
  }
  CHECK(contacts.totals().contacts == 2);
  for (std::size_t i : {0, 1}) {
    CHECK(contacts.totals().recent_contacts[i].first == 0);
    CHECK(contacts.totals().recent_contacts[i].second == 1);
  }
}

TEST_CASE("an obstacle stops a robot and does not move") {
  const Shape obstacle = GENERATE(Shape(Circle{{1, 0}, 0.25}), Shape(Box{{0.75, -1}, {1, 1}}),
                                  Shape(Segment{{0.75, -1}, {0.75, 1}}));
  std::vector<Body> bodies{Body({0, 0}, 0, {})};
  Contacts contacts({&obstacle, 1}, nullptr, kRadius_m, BodySettings{}.speed_mps);
  for (int step = 0; step < 3000; ++step) {
    bodies[0].step({Vec2(3, 0), 0});
    contacts.step(bodies);
  }
  CHECK(contacts.totals().contacts == 1);
  CHECK(contacts.totals().recent_contacts[0].first == 0);
  CHECK(contacts.totals().recent_contacts[0].second == bodies.size());
  CHECK(bodies[0].position_m().x() == Approx(1 - 0.25 - kRadius_m).margin(1e-3));
}

TEST_CASE("blocked cells and the border of a map stop a robot") {
  const double direction = GENERATE(1.0, -1.0);
  MapGrid grid;
  grid.columns = 8, grid.rows = 20, grid.resolution_m = 0.25, grid.origin_m = {-1, -2.5};
  BitGrid blocked(grid.columns, grid.rows);
  for (int row = 0; row < grid.rows; ++row) blocked.set(7, row);
  const auto map = std::make_shared<const FloorMap>(OccupancyMap(grid, blocked));
  std::vector<Body> bodies{Body({0, 0}, 0, {})};
  Contacts contacts({}, map, kRadius_m, BodySettings{}.speed_mps);
  for (int step = 0; step < 3000; ++step) {
    bodies[0].step({Vec2(3 * direction, 0), 0});
    contacts.step(bodies);
  }
  CHECK(contacts.totals().contacts == 1);
  CHECK(contacts.totals().recent_contacts[0].second == bodies.size());
  const double edge_m = direction > 0 ? 0.75 : -1;
  CHECK(bodies[0].position_m().x() == Approx(edge_m - direction * kRadius_m).margin(1e-3));
}

TEST_CASE("the smallest clearance is retained after the robots separate again") {
  std::vector<Body> bodies{Body({-0.5, 0}, 0, {}), Body({0, 0.4}, 0, {})};
  Contacts contacts({}, nullptr, kRadius_m, BodySettings{}.speed_mps);
  for (int step = 0; step < 2000; ++step) {
    bodies[0].step({Vec2(2, 0), 0});
    contacts.step(bodies);
  }
  CHECK(contacts.totals().contacts == 0);
  CHECK(contacts.totals().min_clearance_m == Approx(0.4 - 2 * kRadius_m).margin(1e-4));
}

}  // namespace sidestep::contacts_test
