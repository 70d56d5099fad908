// SPDX-License-Identifier: Apache-2.0
#include "tests/study/vision/oscillating_robots.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace sidestep {
namespace {

constexpr std::size_t kPatterns = 16;
constexpr double kCellMargin_m = 0.1;  // keeps a robot inside its cell, with some clearance
constexpr double kMinAmplitude_m = 0.05;
constexpr double kMaxSpeed_mps = 1.6;
constexpr double kMaxAngularSpeed_radps = 4;

/// Returns the centres of a grid of at least `count` cells that covers the field, and sets the size of a
/// cell.
std::vector<Vec2> cell_centres(const Field& field, std::size_t count, Vec2& size_m) {
  std::size_t rows = 1;
  const auto columns = [&] { return (count + rows - 1) / rows; };
  while (field.length_m / static_cast<double>(columns()) < field.width_m / static_cast<double>(rows)) ++rows;
  size_m = {field.length_m / static_cast<double>(columns()), field.width_m / static_cast<double>(rows)};
  std::vector<Vec2> centres;
  for (std::size_t i = 0; i < columns() * rows; ++i) {
    const std::size_t column = i % columns(), row = i / columns();
    const Vec2 index(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
    centres.push_back(size_m.cwiseProduct(index) - 0.5 * Vec2(field.length_m, field.width_m));
  }
  return centres;
}

}  // namespace

OscillatingRobots::OscillatingRobots(const Field& field, std::size_t robots_per_team, Rng& rng) {
  Vec2 size_m;
  std::vector<Vec2> centres = cell_centres(field, 2 * robots_per_team + 1, size_m);
  rng.shuffle(centres);
  const Vec2 amplitude_m = 0.5 * size_m - Vec2::Constant(kCellMargin_m);
  if (robots_per_team > kPatterns || amplitude_m.minCoeff() < kMinAmplitude_m)
    throw std::invalid_argument("too many robots for the field or the patterns");
  for (const Team team : {Team::kBlue, Team::kYellow}) {
    std::vector<std::uint32_t> patterns;
    for (std::uint32_t pattern = 0; pattern < kPatterns; ++pattern) patterns.push_back(pattern);
    rng.shuffle(patterns);
    for (std::size_t i = 0; i < robots_per_team; ++i) robots_.push_back({team, patterns[i]});
  }
  for (std::size_t i = 0; i <= robots_.size(); ++i) {
    const auto sample = [&](double low, double high) {
      const double x = rng.uniform(low, high);
      return Vec2(x, rng.uniform(low, high));
    };
    const Vec2 speed_mps = sample(0, kMaxSpeed_mps / std::numbers::sqrt2);
    const Vec2 phase_rad = sample(0, 2 * std::numbers::pi);
    const double heading_rad = rng.uniform(0, 2 * std::numbers::pi);
    oscillations_.push_back({centres[i], amplitude_m, speed_mps.cwiseQuotient(amplitude_m), phase_rad,
                             heading_rad, rng.uniform(-kMaxAngularSpeed_radps, kMaxAngularSpeed_radps)});
  }
}

Vec2 OscillatingRobots::Oscillation::position_m(double time_s) const {
  return centre_m +
         amplitude_m.cwiseProduct(Vec2((time_s * angular_frequency_radps + phase_rad).array().sin()));
}

Vec2 OscillatingRobots::Oscillation::velocity_mps(double time_s) const {
  return amplitude_m.cwiseProduct(angular_frequency_radps)
      .cwiseProduct(Vec2((time_s * angular_frequency_radps + phase_rad).array().cos()));
}

std::vector<SceneRobot> OscillatingRobots::robots_at(double time_s) const {
  std::vector<SceneRobot> robots = robots_;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    robots[i].position_m = oscillations_[i].position_m(time_s);
    robots[i].velocity_mps = oscillations_[i].velocity_mps(time_s);
    robots[i].heading_rad = oscillations_[i].heading_rad + time_s * oscillations_[i].angular_radps;
    robots[i].angular_radps = oscillations_[i].angular_radps;
  }
  return robots;
}

SceneBall OscillatingRobots::ball_at(double time_s) const {
  const Oscillation& oscillation = oscillations_.back();
  const Vec2 position_m = oscillation.position_m(time_s);
  return {{position_m.x(), position_m.y(), SceneBall().position_m.z()}, oscillation.velocity_mps(time_s)};
}

}  // namespace sidestep
