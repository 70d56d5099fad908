// SPDX-License-Identifier: Apache-2.0
#include "tests/study/planning/terrain_problem.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/random/rng.hpp"

namespace sidestep {
namespace {

constexpr double kSide_m = 1000;
constexpr double kMaxStartHeight_m = 40, kMaxLength_m = 100;

/// A sum of waves in random directions.
class Hills {
 public:
  explicit Hills(Rng& rng) {
    for (Wave& wave : waves_) {
      const double wavelength_m = rng.uniform(100, 400);
      wave.frequency =
          rotated({2 * std::numbers::pi / wavelength_m, 0}, rng.uniform(0, 2 * std::numbers::pi));
      wave.phase = rng.uniform(0, 2 * std::numbers::pi);
      wave.height_m = 0.06 * wavelength_m;
    }
  }
  double height_m(double x, double y) const {
    double height_m = 0;
    for (const Wave& wave : waves_)
      height_m += wave.height_m * std::sin(wave.frequency.dot(Vec2(x, y)) + wave.phase);
    return height_m;
  }

 private:
  struct Wave {
    Vec2 frequency{0, 0};
    double phase = 0, height_m = 0;
  };
  std::array<Wave, 6> waves_;
};

}  // namespace

TerrainProblem::TerrainProblem(std::size_t squares, std::size_t flight_count, std::uint64_t seed) {
  Rng rng(seed);
  const Hills hills(rng);
  const auto side = static_cast<std::uint32_t>(squares + 1);
  const double spacing_m = kSide_m / static_cast<double>(squares);
  for (std::uint32_t row = 0; row < side; ++row)
    for (std::uint32_t column = 0; column < side; ++column) {
      const double x = column * spacing_m - kSide_m / 2, y = row * spacing_m - kSide_m / 2;
      points_m.emplace_back(x, y, hills.height_m(x, y));
    }
  for (std::uint32_t row = 0; row + 1 < side; ++row)
    for (std::uint32_t column = 0; column + 1 < side; ++column) {
      const std::uint32_t corner = row * side + column;
      triangles.push_back({corner, corner + 1, corner + side});
      triangles.push_back({corner + 1, corner + side + 1, corner + side});
    }
  const TerrainTree terrain(points_m, triangles);
  constexpr double kSky_m = 1000;
  while (flights.size() < flight_count) {
    // y is drawn first, because the evaluation order of arguments is unspecified.
    const double y = rng.uniform(-0.4, 0.4) * kSide_m, x = rng.uniform(-0.4, 0.4) * kSide_m;
    Vec3 from(x, y, kSky_m);
    from.z() -= terrain.min_height_m(from, from) - rng.uniform(0.1, kMaxStartHeight_m);
    const double angle_rad = rng.uniform(0, 2 * std::numbers::pi);
    const Vec2 horizontal = rotated({rng.uniform(0, kMaxLength_m), 0}, angle_rad);
    flights.push_back({from, from + Vec3(horizontal.x(), horizontal.y(), rng.uniform(-20, 20))});
  }
}

LinearTerrain::LinearTerrain(const TerrainProblem& problem) {
  for (const auto& [a, b, c] : problem.triangles)
    triangles_.push_back({problem.points_m[a], problem.points_m[b], problem.points_m[c]});
}

bool LinearTerrain::touches(const Vec3& from_m, const Vec3& to_m, double radius_m) const {
  return std::any_of(triangles_.begin(), triangles_.end(), [&](const Triangle& triangle) {
    return squared_distance(from_m, to_m, triangle) <= radius_m * radius_m;
  });
}

double LinearTerrain::clearance_m(const Vec3& from_m, const Vec3& to_m, double radius_m) const {
  double nearest2_m2 = std::numeric_limits<double>::infinity();
  for (const Triangle& triangle : triangles_)
    nearest2_m2 = std::min(nearest2_m2, squared_distance(from_m, to_m, triangle));
  return std::max(0.0, std::sqrt(nearest2_m2) - radius_m);
}

}  // namespace sidestep
