// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/planning_scene/planning_scene.hpp"

#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::planning_scene_test {

using Json = nlohmann::json;

/// Whether the path leads from start to goal and no point of it, checked every centimetre, is in an obstacle.
bool is_valid(const Json& plan) {
  const auto at = [](const Json& p) { return Vec2(p[0].get<double>(), p[1].get<double>()); };
  const Json& path = plan.at("path");
  if ((at(path.front()) - at(plan.at("start"))).norm() > 1e-3) return false;
  if ((at(path.back()) - at(plan.at("goal"))).norm() > 1e-3) return false;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Vec2 a = at(path[i - 1]), b = at(path[i]);
    const int steps = 1 + static_cast<int>((b - a).norm() / 0.01);
    for (int k = 0; k <= steps; ++k)
      for (const Json& o : plan.at("obstacles"))
        if ((a + (b - a) * k / steps - at(o)).norm() < o[2].get<double>() + PlanningScene::kRadius_m - 1e-3)
          return false;
  }
  return true;
}

TEST_CASE("while obstacles are dragged, each plan avoids them at their current positions") {
  const std::string planner = GENERATE("dynamic-prm", "errt");
  const std::uint64_t seed = GENERATE(1u, 2u, 3u, 4u);
  CAPTURE(planner, seed);
  PlanningScene scene(seed);
  REQUIRE(scene.apply({{"op", "planner"}, {"name", planner}}));
  Rng rng(seed);
  int solved = 0;
  for (int i = 0; i < 100; ++i) {
    REQUIRE(scene.apply(
        {{"op", "move"}, {"what", rng.below(25)}, {"x", rng.uniform(-3, 3)}, {"y", rng.uniform(-2.5, 2.5)}}));
    const Json plan = scene.json();
    if (!plan.at("solved")) continue;
    ++solved;
    REQUIRE(is_valid(plan));
  }
  CHECK(solved > 80);
}

TEST_CASE("the roadmap keeps its nodes while obstacles move and shows which parts are blocked") {
  PlanningScene scene(5);
  const Json before = scene.json();
  REQUIRE(scene.apply({{"op", "move"}, {"what", 0u}, {"x", 0}, {"y", 0}}));
  const Json after = scene.json();
  // The nodes of the roadmap, without start and goal of the query.
  REQUIRE(before.at("nodes").size() > 100);
  for (std::size_t i = 0; i < 100; ++i) CHECK(before.at("nodes")[i] == after.at("nodes")[i]);
  int states[3] = {};
  for (const Json& edge : after.at("edges")) ++states[edge[2].get<int>()];
  CHECK(states[1] > 0);
  CHECK(states[2] > states[1]);  // only edges that the search needed were checked
}

TEST_CASE("invalid messages change nothing") {
  PlanningScene scene(1);
  const std::string before = json_text(scene.json());
  for (const char* bad : {"3", "{}", R"({"op":"move"})", R"({"op":"move","what":"start","x":99,"y":0})",
                          R"({"op":"move","what":25,"x":0,"y":0})", R"({"op":"move","what":-1,"x":0,"y":0})",
                          R"({"op":"move","what":"x","x":0,"y":0})", R"({"op":"planner","name":"rrt*"})",
                          R"({"op":"scene","seed":-1,"obstacles":5})",
                          R"({"op":"scene","seed":1,"obstacles":1000000})", R"({"op":["move"]})"})
    CHECK_FALSE(scene.apply(parse_json(bad)));
  CHECK_FALSE(scene.apply(parse_json("", false)));
  CHECK(json_text(scene.json()) == before);
}

}  // namespace sidestep::planning_scene_test
