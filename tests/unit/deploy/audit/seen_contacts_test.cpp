// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/seen_contacts.hpp"

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::seen_contacts_test {

constexpr std::int64_t kFrame_ns = 16'666'667;

/// Robots of 90 mm radius with a margin of 10 mm, and an obstacle of 100 mm radius at (0, 3).
Scenario scenario(double noise_m) {
  Scenario s;
  s.vision.position_noise_m = noise_m;
  s.obstacles.push_back(Circle{Vec2(0, 3), 0.1});
  return s;
}

/// Shows two robots to a contact detector, frame by frame.
struct Frames {
  explicit Frames(double noise_m = 0.0005) : contacts(scenario(noise_m)) {}

  /// Number of contacts that begin in the next frame.
  std::size_t show(const Vec2& first_m, const Vec2& second_m) {
    at_ns += kFrame_ns;
    return contacts.update({{at_ns, first_m, Vec2(0, 0), true}, {at_ns, second_m, Vec2(0, 0), true}}).size();
  }
  std::size_t show_at_distance(double distance_m) { return show(Vec2(0, 0), Vec2(distance_m, 0)); }

  SeenContacts contacts;
  std::int64_t at_ns = 1'000'000'000;
};

TEST_CASE("robots that overlap in two observations count as one contact until they part") {
  Frames frames;
  CHECK(frames.show_at_distance(0.179) == 0);
  CHECK(frames.show_at_distance(0.179) == 1);
  for (int i = 0; i < 10; ++i) CHECK(frames.show_at_distance(0.1795) == 0);
  CHECK(frames.show_at_distance(0.19) == 0);
  CHECK(frames.show_at_distance(0.179) == 0);
  CHECK(frames.show_at_distance(0.179) == 1);
}

TEST_CASE("a contact states when the robots were last seen apart, if ever") {
  Frames frames;
  const auto touch = [&](const Vec2& second_m) {
    std::vector<SeenContact> began;
    for (int i = 0; i < 2; ++i) {
      frames.at_ns += kFrame_ns;
      const VisionSighting first{frames.at_ns, Vec2(0, 2.82), Vec2(0, 0), true};
      for (const SeenContact& contact :
           frames.contacts.update({first, {frames.at_ns - 1, second_m, Vec2(0, 0), true}}))
        began.push_back(contact);
    }
    return began;
  };
  const auto at_first = touch({0.179, 2.82});
  REQUIRE(at_first.size() == 2);
  for (const SeenContact& contact : at_first) CHECK(contact.apart_ns == SeenContact().apart_ns);
  CHECK(frames.show({0, 2}, {0.5, 2}) == 0);
  const std::int64_t apart_ns = frames.at_ns;
  const auto then = touch({0.179, 2.82});
  REQUIRE(then.size() == 2);
  for (const SeenContact& contact : then) CHECK(contact.apart_ns == apart_ns);
}

TEST_CASE("a single false observation does not count as a contact") {
  Frames frames;
  CHECK(frames.show_at_distance(0.1) == 0);
  CHECK(frames.show_at_distance(0.3) == 0);
  CHECK(frames.show_at_distance(0.1) == 0);
}

TEST_CASE("a robot that touches an obstacle is found") {
  Frames frames;
  CHECK(frames.show(Vec2(0, 2.82), Vec2(2, 2)) == 0);
  CHECK(frames.show(Vec2(0, 2.82), Vec2(2, 2)) == 1);
}

TEST_CASE("a robot that touches a blocked map cell is found") {
  Scenario s;
  s.vision.position_noise_m = 0.0005;
  MapGrid grid;
  grid.columns = grid.rows = 80, grid.resolution_m = 0.1, grid.origin_m = {-4, -4};
  BitGrid blocked(grid.columns, grid.rows);
  blocked.set(40, 70);  // from (0, 3) to (0.1, 3.1)
  s.map = std::make_shared<const FloorMap>(OccupancyMap(grid, blocked));
  SeenContacts contacts(s);
  std::int64_t at_ns = 0;
  const auto show = [&](double y_m) {
    return contacts.update({{at_ns += kFrame_ns, Vec2(0.05, y_m), Vec2(0, 0), true}}).size();
  };
  CHECK(show(2.9) == 0);
  CHECK(show(2.92) == 0);
  CHECK(show(2.92) == 1);
  CHECK(show(2.9) == 0);
  CHECK(show(2.92) == 0);
  CHECK(show(2.92) == 1);
}

TEST_CASE("positions more than 20 ms apart in time are not compared") {
  const auto [apart_ns, begins] = GENERATE(table<std::int64_t, std::size_t>(
      {{19'900'000, 1}, {20'100'000, 0}, {-19'900'000, 1}, {-20'100'000, 0}}));
  CAPTURE(apart_ns);
  Scenario s = scenario(0.0005);
  s.margin_m = 0.05;
  SeenContacts contacts(s);
  std::size_t found = 0;
  for (std::int64_t at_ns = 1'000'000'000; at_ns < 1'200'000'000; at_ns += kFrame_ns) {
    found += contacts
                 .update({{at_ns, Vec2(0, 0), Vec2(0, 0), true},
                          {at_ns + apart_ns, Vec2(0.17, 0), Vec2(0, 0), true}})
                 .size();
  }
  CHECK(found == begins);
}

TEST_CASE("after missed world states, a contact must again be observed twice") {
  Frames frames;
  CHECK(frames.show_at_distance(0.17) == 0);
  frames.contacts.on_missed();
  CHECK(frames.show_at_distance(0.17) == 0);
  CHECK(frames.show_at_distance(0.17) == 1);
  // A contact that has begun is not forgotten.
  frames.contacts.on_missed();
  CHECK(frames.show_at_distance(0.17) == 0);
  CHECK(frames.show_at_distance(0.17) == 0);
}

TEST_CASE("positions observed at different times are extrapolated to one time") {
  SeenContacts contacts(scenario(0.0005));
  // The second robot follows the first one at 2 m/s, 0.21 m behind, and is observed 19 ms later.
  for (std::int64_t i = 1; i <= 5; ++i) {
    const std::int64_t at_ns = i * kFrame_ns;
    const double x_m = 2 * static_cast<double>(at_ns) * 1e-9;
    const Vec2 velocity_mps(2, 0);
    CHECK(contacts
              .update({{at_ns, Vec2(x_m, 0), velocity_mps, true},
                       {at_ns + 19'000'000, Vec2(x_m + 2 * 0.019 - 0.21, 0), velocity_mps, true}})
              .empty());
  }
  // Without extrapolation the robots would seem to overlap.
  CHECK(0.21 - 2 * 0.019 < 0.18);
}

TEST_CASE("robots at the guaranteed distance are never reported, and robots that touch are found soon") {
  for (const double noise_m : {0.0005, 0.001, 0.002}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      CAPTURE(noise_m, seed);
      Rng rng(seed);
      Frames apart(noise_m), touching(noise_m);
      std::size_t false_alarms = 0, found = 0;
      const auto noise = [&] { return Vec2(noise_m * rng.normal(), noise_m * rng.normal()); };
      for (int i = 0; i < 600; ++i) {
        // The margin of 10 mm minus twice the tracking bound of 3 mm.
        false_alarms += apart.show(noise(), Vec2(0.184, 0) + noise());
        // In contact without overlap.
        found += touching.show(noise(), Vec2(0.18, 0) + noise());
      }
      CHECK(false_alarms == 0);
      if (noise_m <= 0.0005) CHECK(found > 0);
    }
  }
}

}  // namespace sidestep::seen_contacts_test
