// SPDX-License-Identifier: Apache-2.0
// Fuzzes the messages that browsers send to the monitor's planning page.
// Messages are separated by zero bytes.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"
#include "deploy/view/planning_scene/planning_scene.hpp"
#include "deploy/view/server/viewer_json.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace sidestep::fuzz {
namespace {

/// Checks that an answer is not larger than a browser can draw, and contains finite numbers only.
void check_answer(const PlanningScene& scene) {
  const nlohmann::ordered_json answer = scene.json();
  SIDESTEP_REQUIRE(answer.at("obstacles").size() <= PlanningScene::kMaxObstacles);
  SIDESTEP_REQUIRE(answer.at("nodes").size() <= 10'000);
  SIDESTEP_REQUIRE(json_text(answer).find("null") == std::string::npos);  // JSON's form of NaN and infinity
}

}  // namespace

bool try_input(View input) {
  static const PlanningScene new_scene;  // planning takes longer than copying
  PlanningScene scene = new_scene;
  while (!input.empty()) {
    const auto end = std::ranges::find(input, 0);
    if (!scene.apply(parse_viewer_json(text_of({input.begin(), end})))) return false;
    check_answer(scene);
    input = {end == input.end() ? end : end + 1, input.end()};
  }
  return true;
}

std::vector<Bytes> seeds() {
  return {bytes_of(R"({"op":"move","what":0,"x":1,"y":0.5})"),
          bytes_of(R"({"op":"move","what":"goal","x":3,"y":-2})"),
          bytes_of(R"({"op":"scene","seed":7,"obstacles":3})"),
          bytes_of(R"({"op":"planner","name":"errt"})")};
}

}  // namespace sidestep::fuzz
