// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/planning_scene/planning_scene.hpp"

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

namespace sidestep {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxNodes = 4000, kMaxSamples = 20'000;

std::optional<double> number(const nlohmann::json& message, const char* key, double min, double max) {
  const auto found = message.find(key);
  if (found == message.end() || !found->is_number()) return std::nullopt;
  const double value = found->get<double>();
  return value >= min && value <= max ? std::optional(value) : std::nullopt;
}

Json point(const Vec2& p) { return {std::round(p.x() * 1e4) / 1e4, std::round(p.y() * 1e4) / 1e4}; }

enum EdgeState : int { kBlocked, kFree, kUnchecked };

}  // namespace

PlanningScene::PlanningScene(std::uint64_t seed) : rng_(seed) {
  sample(seed, 25);
  plan();
}

DiscDomain PlanningScene::domain() const {
  return {world_, Field{kLength_m, kWidth_m}, kRadius_m, start_m_, goal_m_};
}

void PlanningScene::sample(std::uint64_t seed, std::size_t obstacles) {
  rng_ = Rng(seed);
  obstacles_.clear();
  std::vector<Shape> shapes;
  while (obstacles_.size() < obstacles) {
    const Circle circle{{rng_.uniform(-3.3, 3.3), rng_.uniform(-2.8, 2.8)}, rng_.uniform(0.1, 0.45)};
    obstacles_.push_back(circle);
    shapes.emplace_back(circle);
  }
  world_ = ObstacleWorld(std::move(shapes));
  start_m_ = {-4, 0};
  goal_m_ = {4, 0};
  prm_.clear();
  errt_ = Errt<DiscDomain>();
}

void PlanningScene::plan() {
  const DiscDomain d = domain();
  Budget budget;
  budget.nodes = kMaxNodes;
  budget.samples = kMaxSamples;
  const auto begin = std::chrono::steady_clock::now();
  plan_ = planner_ == "errt" ? errt_.plan(d, start_m_, budget, rng_) : prm_.plan(d, start_m_, budget, rng_);
  time_us_ = std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count();
}

bool PlanningScene::apply(const nlohmann::json& message) {
  if (!message.is_object()) return false;
  const nlohmann::json op = message.value("op", nlohmann::json());
  if (op == "scene") {
    const auto seed = number(message, "seed", 0, 1e9), count = number(message, "obstacles", 0, kMaxObstacles);
    if (!seed || !count) return false;
    sample(static_cast<std::uint64_t>(*seed), static_cast<std::size_t>(*count));
  } else if (op == "planner") {
    const nlohmann::json name = message.value("name", nlohmann::json());
    if (name != "dynamic-prm" && name != "errt") return false;
    planner_ = name.get<std::string>();
  } else if (op == "move") {
    const auto x = number(message, "x", -kLength_m / 2, kLength_m / 2);
    const auto y = number(message, "y", -kWidth_m / 2, kWidth_m / 2);
    if (!x || !y) return false;
    const Vec2 to(*x, *y);
    const nlohmann::json what = message.value("what", nlohmann::json());
    if (what == "start") {
      start_m_ = to;
    } else if (what == "goal") {
      goal_m_ = to;
    } else if (what.is_number_unsigned() && what.get<std::uint64_t>() < obstacles_.size()) {
      const auto index = what.get<std::size_t>();
      world_.move(static_cast<ObstacleId>(index), to - obstacles_[index].centre_m);
      obstacles_[index].centre_m = to;
    } else {
      return false;
    }
  } else {
    return false;
  }
  plan();
  return true;
}

Json PlanningScene::json() const {
  Json obstacles = Json::array(), path = Json::array(), nodes = Json::array(), edges = Json::array();
  for (const Circle& o : obstacles_) obstacles.push_back({o.centre_m.x(), o.centre_m.y(), o.radius_m});
  for (const Vec2& p : plan_.states) path.push_back(point(p));
  if (planner_ == "errt") {
    // A plan along the straight line grows no tree.
    for (std::uint32_t i = 0; plan_.nodes > 0 && i < errt_.tree().size(); ++i) {
      nodes.push_back(point(errt_.tree()[i]));
      if (i > 0) edges.push_back({i, errt_.tree().parent(i), static_cast<int>(kFree)});
    }
  } else {
    const Roadmap<DiscDomain>& map = prm_.roadmap();
    std::uint32_t newest = 0;
    for (const auto& edge : map.edges()) newest = std::max(newest, edge.checked);
    for (std::uint32_t i = 0; i < map.size(); ++i) nodes.push_back(point(map[i]));
    for (const auto& edge : map.edges())
      edges.push_back({edge.a, edge.b,
                       static_cast<int>(edge.checked != newest ? kUnchecked
                                        : edge.is_free         ? kFree
                                                               : kBlocked)});
  }
  return {{"type", "plan"},
          {"planner", planner_},
          {"solved", plan_.arrives()},
          {"length_m", plan_.length},
          {"time_us", time_us_},
          {"field", {kLength_m, kWidth_m}},
          {"radius_m", kRadius_m},
          {"start", point(start_m_)},
          {"goal", point(goal_m_)},
          {"obstacles", obstacles},
          {"path", path},
          {"nodes", nodes},
          {"edges", edges}};
}

}  // namespace sidestep
