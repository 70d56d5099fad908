// SPDX-License-Identifier: Apache-2.0
#include "common/map/laser_scanner.hpp"

#include "tests/catch.hpp"
#include "tests/unit/common/collision/random_world.hpp"
#include "tests/unit/common/map/random_map.hpp"

namespace sidestep::laser_scanner_test {

constexpr double kPi = std::numbers::pi;
constexpr float kInfinite = std::numeric_limits<float>::infinity();

TEST_CASE("beams divide the field of view evenly") {
  const LaserScanner half({181, kPi, 0.05, 8});
  CHECK(half.beam_angle_rad(0) == Approx(-kPi / 2));
  CHECK(half.beam_angle_rad(90) == Approx(0).margin(1e-12));
  CHECK(half.beam_angle_rad(180) == Approx(kPi / 2));
  const LaserScanner full({360, 2 * kPi, 0.05, 8});
  CHECK(full.beam_angle_rad(0) == Approx(-kPi));
  CHECK(full.beam_angle_rad(180) == Approx(0).margin(1e-12));
  CHECK(full.beam_angle_rad(359) == Approx(kPi - kPi / 180));
  CHECK(LaserScanner({1, 1, 0, 8}).beam_angle_rad(0) == 0);
}

TEST_CASE("every beam of a scan is a ray in the beam's direction") {
  const std::uint64_t seed = GENERATE(range(1, 60));
  CAPTURE(seed);
  Rng rng(seed);
  LaserSettings settings;
  settings.beams = 1 + static_cast<int>(rng.below(200));
  settings.field_of_view_rad = rng.chance(0.5) ? 2 * kPi : rng.uniform(0.1, 2 * kPi);
  settings.min_range_m = rng.chance(0.5) ? 0 : 0.3;
  settings.max_range_m = rng.uniform(1, 8);
  const LaserScanner scanner(settings);
  const OccupancyMap map({200, 200, 0.05, {-5, -5}}, test::noise(rng, 200, 200, 0.001));
  const DistanceField field(map);
  const ObstacleWorld shapes(random_shapes(rng, rng.below(40), 5));
  std::vector<Circle> discs;
  for (std::size_t i = rng.below(10); i > 0; --i)
    discs.push_back({random_position(rng, 5), rng.uniform(0, 0.5)});
  const bool has_map = rng.chance(0.7);
  const RayScene scene{has_map ? &map : nullptr, has_map ? &field : nullptr, &shapes, discs};
  std::vector<float> ranges_m(static_cast<std::size_t>(settings.beams));
  int seen = 0, different = 0, all = 0;
  for (int i = 0; i < 10; ++i) {
    const Vec2 at = random_position(rng, 5);
    const double heading_rad = rng.uniform(-10, 10);
    scanner.scan(scene, at, heading_rad, ranges_m);
    for (int beam = 0; beam < settings.beams; ++beam, ++all) {
      const float range_m = ranges_m[static_cast<std::size_t>(beam)];
      const double angle_rad = heading_rad + scanner.beam_angle_rad(beam);
      // A ray that grazes an obstacle may miss it, so the range of a slightly shifted ray is also accepted.
      bool agrees = false;
      for (const double turn_rad : {0.0, -1e-7, 1e-7}) {
        const double ray_m = cast_ray(scene, at, rotated({1, 0}, angle_rad + turn_rad), settings.max_range_m);
        const double expected_m = ray_m < settings.min_range_m ? -kInfinite : ray_m;
        agrees = agrees || range_m == static_cast<float>(expected_m) || std::abs(range_m - expected_m) < 1e-4;
      }
      seen += std::isfinite(range_m);
      different += !agrees;
    }
  }
  CHECK(different == 0);
  if (has_map && settings.max_range_m > 3) CHECK(seen > all / 10);
}

TEST_CASE("ranges beyond the limits are infinite") {
  const std::vector<Circle> disc{{{3, 0}, 1}};
  const RayScene scene{nullptr, nullptr, nullptr, disc};
  const auto range_m = [&](const LaserSettings& settings, const Vec2& at) {
    float range = 0;
    LaserScanner(settings).scan(scene, at, 0, std::span(&range, 1));
    return range;
  };
  CHECK(range_m({1, 1, 0.5, 8}, {0, 0}) == Approx(2));
  CHECK(range_m({1, 1, 0.5, 1.9}, {0, 0}) == kInfinite);
  CHECK(range_m({1, 1, 2.1, 8}, {0, 0}) == -kInfinite);
  CHECK(range_m({1, 1, 0, 8}, {3, 0.5}) == 0);
  CHECK(range_m({1, 1, 0, 8}, {5, 0}) == kInfinite);
}

TEST_CASE("invalid scanners and scans are rejected") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const LaserSettings& settings :
       {LaserSettings{0, 1, 0, 1}, LaserSettings{100'001, 1, 0, 1}, LaserSettings{1, 0, 0, 1},
        LaserSettings{1, 6.3, 0, 1}, LaserSettings{1, nan, 0, 1}, LaserSettings{1, 1, -1, 1},
        LaserSettings{1, 1, 1, 1}, LaserSettings{1, 1, 0, nan}, LaserSettings{1, 1, nan, 1}})
    CHECK_THROWS_AS(LaserScanner(settings), std::invalid_argument);
  const LaserScanner scanner({3, 1, 0, 1});
  std::vector<float> ranges(3);
  CHECK_THROWS_AS(scanner.scan({}, {nan, 0}, 0, ranges), std::invalid_argument);
  CHECK_THROWS_AS(scanner.scan({}, {0, 0}, nan, ranges), std::invalid_argument);
  const std::vector<Circle> discs{{{0, 0}, -1}};
  CHECK_THROWS_AS(scanner.scan({nullptr, nullptr, nullptr, discs}, {0, 0}, 0, ranges), std::invalid_argument);
  ranges.pop_back();
  CHECK_THROWS_AS(scanner.scan({}, {0, 0}, 0, ranges), std::invalid_argument);
}

}  // namespace sidestep::laser_scanner_test
