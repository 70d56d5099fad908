// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/local_methods/scenes.hpp"

#include <algorithm>
#include <limits>

#include "agents/navigation/dynamic_window/disc_cell_times.hpp"

namespace sidestep {
namespace {

struct Post {
  Vec2 centre_m;
  double radius_m;
};

std::vector<Post> random_posts(Rng& rng, double nearest_m) {
  std::vector<Post> posts;
  while (posts.size() < 8) {
    const double x = rng.uniform(-3, 3), y = rng.uniform(-3, 3), radius = rng.uniform(0.02, 0.3);
    if (std::hypot(x, y) > radius + nearest_m) posts.push_back({{x, y}, radius});
  }
  return posts;
}

}  // namespace

ConvexPolygon octagon(double inner_radius_m) {
  ConvexPolygon polygon;
  const double outer_m = inner_radius_m / std::cos(std::numbers::pi / 8);
  for (int i = 0; i < 8; ++i)
    polygon.corners_m.push_back(rotated(Vec2(outer_m, 0), (i + 0.5) * std::numbers::pi / 4));
  return polygon;
}

std::vector<Vec2> laser_scan(Rng& rng, std::size_t beams, double nearest_m) {
  double walls_m[4];
  for (double& wall : walls_m) wall = nearest_m + std::abs(rng.normal()) * 1.5;
  const std::vector<Post> posts = random_posts(rng, nearest_m);
  std::vector<Vec2> points;
  for (std::size_t beam = 0; beam < beams; ++beam) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(beam) / static_cast<double>(beams);
    const Vec2 along(std::cos(angle), std::sin(angle));
    double range = std::min(walls_m[along.x() > 0 ? 0 : 1] / std::max(std::abs(along.x()), 1e-9),
                            walls_m[along.y() > 0 ? 2 : 3] / std::max(std::abs(along.y()), 1e-9));
    for (const Post& post : posts)
      range = std::min(range, disc_time_to_collision_s(post.centre_m, post.radius_m, along));
    points.push_back(range * along);
  }
  return points;
}

Corridor Corridor::random(Rng& rng, double robot_radius_m, double length_m) {
  const double half_width = robot_radius_m * rng.uniform(1.5, 1.7), amplitude = rng.uniform(0.1, 0.4);
  const double wave = rng.uniform(3, 6), phase = rng.uniform(0, 2 * std::numbers::pi);
  return {length_m, half_width, amplitude, wave, phase};
}

Vec2 Corridor::middle_m(double x_m) const {
  return {x_m, amplitude_m * std::sin(2 * std::numbers::pi * x_m / wave_m + phase_rad)};
}

std::vector<Vec2> Corridor::wall_points(std::size_t count) const {
  std::vector<Vec2> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = -1 + (length_m + 2) * static_cast<double>(i / 2) / static_cast<double>(count / 2);
    const Vec2 along = (middle_m(x + 1e-4) - middle_m(x - 1e-4)).normalized();
    points.push_back(middle_m(x) + (i % 2 == 0 ? half_width_m : -half_width_m) * left_of(along));
  }
  return points;
}

std::vector<Vec2> Corridor::path() const {
  std::vector<Vec2> points;
  for (double x = 0; x < length_m; x += 0.25) points.push_back(middle_m(x));
  points.push_back(middle_m(length_m));
  return points;
}

}  // namespace sidestep
