// SPDX-License-Identifier: Apache-2.0
#include "agents/perception/laser_beams.hpp"

#include "tests/catch.hpp"
#include "tests/unit/agents/perception/scene.hpp"

namespace sidestep::laser_beams_test {

constexpr double kPi = std::numbers::pi;
constexpr float kInfinite = std::numeric_limits<float>::infinity();

TEST_CASE("the range of a beam is read as a hit, a known robot, a clear beam or an unknown beam") {
  LaserBeams beams({8, 2 * kPi, 0.1, 5}, 0.1);
  const std::vector<float> ranges{1, kInfinite, -kInfinite, test::kNoRange, 6, 0.05F, -1, 2};
  const std::vector<Circle> robots{{{-1.5, 0}, 0.45}};
  beams.read({{0, 0}, 0, Time{}, ranges}, robots);
  const std::vector<BeamEnd> expected{BeamEnd::kRobot,   BeamEnd::kClear, BeamEnd::kUnknown,
                                      BeamEnd::kUnknown, BeamEnd::kClear, BeamEnd::kUnknown,
                                      BeamEnd::kUnknown, BeamEnd::kHit};
  const std::vector<double> free_m{1, 5, 0, 0, 5, 0, 0, 2};
  for (int i = 0; i < 8; ++i) {
    CAPTURE(i);
    CHECK(beams[i].end == expected[static_cast<std::size_t>(i)]);
    CHECK(beams[i].free_m == free_m[static_cast<std::size_t>(i)]);
  }
  CHECK((beams.end_m(beams[0]) - Vec2(-1, 0)).norm() < 1e-12);
}

TEST_CASE("decoded beams have the directions of the scanner's beams") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    LaserSettings settings;
    settings.beams = 1 + static_cast<int>(rng.below(300));
    if (rng.chance(0.5)) settings.field_of_view_rad = rng.uniform(0.1, 6);
    const LaserScanner scanner(settings);
    LaserBeams beams(settings);
    const std::vector<float> ranges(static_cast<std::size_t>(settings.beams), 1.0F);
    const double heading_rad = rng.uniform(-10, 10);
    beams.read({{3, -2}, heading_rad, Time{}, ranges}, {});
    double sum_rad = 0;
    for (int i = 0; i < settings.beams; ++i) {
      const double angle_rad = heading_rad + scanner.beam_angle_rad(i);
      CHECK((beams[i].direction - Vec2(std::cos(angle_rad), std::sin(angle_rad))).norm() < 1e-9);
      CHECK((beams.end_m(beams[i]) - beams[i].direction - Vec2(3, -2)).norm() < 1e-12);
      if (i > 0)
        CHECK(beams.gap_rad(i - 1) == Approx(scanner.beam_angle_rad(i) - scanner.beam_angle_rad(i - 1)));
      sum_rad += beams.gap_rad(i);
    }
    CHECK(sum_rad == Approx(2 * kPi));
  }
}

TEST_CASE("invalid scans are refused") {
  const double nan = std::nan("");
  CHECK_THROWS_AS(LaserBeams({0, 1, 0, 1}), std::invalid_argument);
  CHECK_THROWS_AS(LaserBeams({3, 1, 0, 1}, -1), std::invalid_argument);
  LaserBeams beams({3, 1, 0, 1});
  std::vector<float> ranges(3);
  const std::vector<Circle> bad{{{0, 0}, -1}}, far{{{nan, 0}, 1}};
  CHECK_THROWS_AS(beams.read({{nan, 0}, 0, Time{}, ranges}, {}), std::invalid_argument);
  CHECK_THROWS_AS(beams.read({{0, 0}, nan, Time{}, ranges}, {}), std::invalid_argument);
  CHECK_THROWS_AS(beams.read({{0, 0}, 0, Time{}, ranges}, bad), std::invalid_argument);
  CHECK_THROWS_AS(beams.read({{0, 0}, 0, Time{}, ranges}, far), std::invalid_argument);
  ranges.pop_back();
  CHECK_THROWS_AS(beams.read({{0, 0}, 0, Time{}, ranges}, {}), std::invalid_argument);
}

}  // namespace sidestep::laser_beams_test
