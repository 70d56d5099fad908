// SPDX-License-Identifier: Apache-2.0
#include "simulator/bases/start_places.hpp"

#include <algorithm>
#include <stdexcept>

#include "tests/catch.hpp"

namespace sidestep::start_places_test {
namespace {

constexpr Time kBegin = time_from_ns(1'000'000'000'000);

Scenario four_blue() {
  Scenario scenario;
  for (RobotId id = 0; id < 4; ++id) {
    RobotSpec robot;
    robot.id = id;
    robot.start_m = {-3 + 1.5 * id, 0.5};
    robot.start_heading_rad = 0.1 * id;
    scenario.robots.push_back(robot);
  }
  return scenario;
}

std::vector<Vec2> places_of(const BaseWorld& world) {
  std::vector<Vec2> places_m;
  for (const Body& body : world.bodies()) places_m.push_back(body.position_m());
  return places_m;
}

}  // namespace

TEST_CASE("in a line, both teams stand 0.3 m apart along the upper edge, by their numbers") {
  BaseWorld world(four_blue(), 11, {}, kBegin);
  place_robots(world, StartPlaces::kLine, 1);
  std::vector<double> xs_m;
  for (const Vec2& place_m : places_of(world)) {
    CHECK(place_m.y() == Approx(3 - 1.2 * 0.09));
    xs_m.push_back(place_m.x());
  }
  std::ranges::sort(xs_m);
  REQUIRE(xs_m.size() == 22);
  for (std::size_t i = 1; i < xs_m.size(); ++i) CHECK(xs_m[i] - xs_m[i - 1] == Approx(0.3));
  CHECK(world.bodies()[*world.find(Team::kBlue, 3)].position_m().x() == Approx(-1.05));
  CHECK(world.bodies()[*world.find(Team::kYellow, 10)].position_m().x() == Approx(3.15));
}

TEST_CASE("a line that is longer than the field is refused") {
  Scenario scenario = four_blue();
  scenario.name = "small";
  scenario.field = {1.5, 3};
  for (RobotSpec& robot : scenario.robots) robot.start_m.x() /= 10;
  BaseWorld world(scenario, 0, {}, kBegin);
  CHECK_THROWS_WITH(
      place_robots(world, StartPlaces::kLine, 1),
      ContainsSubstring("robot 2 would stand at (-0.75, 1.39), outside the field of scenario small"));
}

TEST_CASE("shuffled, each robot of the scenario stands at another one's place, and opponents stay") {
  const Scenario scenario = four_blue();
  const auto shuffled = [&](std::uint64_t seed) {
    BaseWorld world(scenario, 6, {}, kBegin);
    const std::vector<Vec2> before_m = places_of(world);
    world.remove(2);
    place_robots(world, StartPlaces::kShuffled, seed);
    std::vector<Vec2> places_m = places_of(world);
    for (const std::size_t robot : {0U, 1U, 3U}) {
      CHECK(places_m[robot] != before_m[robot]);
      CHECK(std::ranges::count(places_m, before_m[robot]) == 1);
      CHECK(world.bodies()[robot].heading_rad() == Approx(0.1 * static_cast<double>(robot)));
    }
    CHECK_FALSE(world.bodies()[2].is_on_floor());
    for (std::size_t robot = 4; robot < places_m.size(); ++robot) CHECK(places_m[robot] == before_m[robot]);
    return places_m;
  };
  const std::vector<Vec2> first = shuffled(1);
  CHECK(first == shuffled(1));
  int different = 0;
  for (std::uint64_t seed = 2; seed < 30; ++seed) different += shuffled(seed) != first ? 1 : 0;
  CHECK(different > 0);
}

}  // namespace sidestep::start_places_test
