// SPDX-License-Identifier: Apache-2.0
#include "agents/perception/laser_tracks.hpp"
#include "agents/perception/visibility.hpp"
#include "tests/catch.hpp"
#include "tests/counted_allocations.hpp"
#include "tests/unit/agents/perception/scene.hpp"

namespace sidestep::perception_allocation_test {

TEST_CASE("perception does not allocate memory after a warm-up") {
  Rng rng(3);
  const LaserSettings laser{360, 2 * std::numbers::pi, 0.05, 8};
  test::Scene scene(3, laser);
  test::Walker robot(scene, rng, 0.25, 0.8);
  std::vector<test::Walker> people;
  for (int i = 0; i < 8; ++i) people.emplace_back(scene, rng, 0.25, 1.2);
  LaserBeams beams(laser);
  LocalGrid grid;
  LaserTracks tracks;
  Visibility visibility;
  const PriorMap walls{&scene.map()};
  std::vector<Circle> discs(people.size());
  double sum = 0;
  std::size_t allocations = 0;
  // Random scans first enlarge every buffer to its maximum size. Then the robot drives.
  std::vector<float> ranges(360);
  for (int i = 0; i < 600; ++i) {
    robot.step(scene, rng, 0.1);
    for (std::size_t k = 0; k < people.size(); ++k) {
      people[k].step(scene, rng, 0.1);
      discs[k] = people[k].disc();
    }
    LaserScan scan = scene.scan(robot.at_m(), robot.heading_rad(), time_from_ns((i + 1) * 100'000'000LL),
                                discs, {0.02, 0.06, 0.05}, rng);
    if (i < 200 && i % 2 == 0) {
      for (float& range_m : ranges) range_m = static_cast<float>(rng.uniform(0.1, 7));
      scan.ranges_m = ranges;
    }
    const std::size_t before = allocation_count();
    beams.read(scan, std::span(discs).subspan(0, 2));
    tracks.update(beams, grid, {&scene.map()});
    grid.update(beams);
    visibility.update(beams, [&](const Vec2& p, double within_m) { return walls.nearest_m(p, within_m); });
    sum += visibility.is_enclosed_by_frontiers(robot.at_m());
    grid.for_each_occupied({{-1, -1}, {1, 1}}, [&](const Cell&) { sum += 1; });
    sum += static_cast<double>(tracks.tracks().size());
    if (i >= 300) allocations += allocation_count() - before;
  }
  CHECK(allocations == 0);
  CHECK(sum > 0);
}

}  // namespace sidestep::perception_allocation_test
