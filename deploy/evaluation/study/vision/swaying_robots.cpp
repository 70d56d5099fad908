// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/study/vision/swaying_robots.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace sidestep {
namespace {

constexpr std::size_t kPatterns = 16;
constexpr double kBody_m = 0.1;  // that stays within its cell, and a little
constexpr double kLeastReach_m = 0.05;
constexpr double kFastest_mps = 1.6;
constexpr double kTurns_radps = 4;

std::vector<Vec2> cells_of(const Field& field, std::size_t count, Vec2& size_m) {
  std::size_t rows = 1;
  const auto columns = [&] { return (count + rows - 1) / rows; };
  while (field.length_m / static_cast<double>(columns()) < field.width_m / static_cast<double>(rows)) ++rows;
  size_m = {field.length_m / static_cast<double>(columns()), field.width_m / static_cast<double>(rows)};
  std::vector<Vec2> cells;
  for (std::size_t i = 0; i < columns() * rows; ++i) {
    const Vec2 place(static_cast<double>(i % columns()) + 0.5, static_cast<double>(i / columns()) + 0.5);
    cells.push_back(size_m.cwiseProduct(place) - 0.5 * Vec2(field.length_m, field.width_m));
  }
  return cells;
}

}  // namespace

SwayingRobots::SwayingRobots(const Field& field, std::size_t each, Rng& rng) {
  Vec2 size_m;
  std::vector<Vec2> cells = cells_of(field, 2 * each + 1, size_m);
  rng.shuffle(cells);
  const Vec2 reach_m = 0.5 * size_m - Vec2::Constant(kBody_m);
  if (each > kPatterns || reach_m.minCoeff() < kLeastReach_m)
    throw std::invalid_argument("no room for so many robots");
  for (const Team team : {Team::kBlue, Team::kYellow}) {
    std::vector<std::uint32_t> ids;
    for (std::uint32_t id = 0; id < kPatterns; ++id) ids.push_back(id);
    rng.shuffle(ids);
    for (std::size_t i = 0; i < each; ++i) worn_.push_back({team, ids[i]});
  }
  for (std::size_t i = 0; i <= worn_.size(); ++i) {
    const auto drawn = [&](double low, double high) {
      const double x = rng.uniform(low, high);
      return Vec2(x, rng.uniform(low, high));
    };
    const Vec2 speed_mps = drawn(0, kFastest_mps / std::numbers::sqrt2);
    const Vec2 phase_rad = drawn(0, 2 * std::numbers::pi);
    const double heading_rad = rng.uniform(0, 2 * std::numbers::pi);
    sways_.push_back({cells[i], reach_m, speed_mps.cwiseQuotient(reach_m), phase_rad, heading_rad,
                      rng.uniform(-kTurns_radps, kTurns_radps)});
  }
}

Vec2 SwayingRobots::Sway::position_m(double time_s) const {
  return middle_m + reach_m.cwiseProduct(Vec2((time_s * radps + phase_rad).array().sin()));
}

Vec2 SwayingRobots::Sway::velocity_mps(double time_s) const {
  return reach_m.cwiseProduct(radps).cwiseProduct(Vec2((time_s * radps + phase_rad).array().cos()));
}

std::vector<SceneRobot> SwayingRobots::robots_at(double time_s) const {
  std::vector<SceneRobot> robots = worn_;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    robots[i].position_m = sways_[i].position_m(time_s);
    robots[i].velocity_mps = sways_[i].velocity_mps(time_s);
    robots[i].heading_rad = sways_[i].heading_rad + time_s * sways_[i].angular_radps;
    robots[i].angular_radps = sways_[i].angular_radps;
  }
  return robots;
}

SceneBall SwayingRobots::ball_at(double time_s) const {
  const Vec2 position_m = sways_.back().position_m(time_s);
  return {{position_m.x(), position_m.y(), SceneBall().position_m.z()}, sways_.back().velocity_mps(time_s)};
}

}  // namespace sidestep
