// SPDX-License-Identifier: Apache-2.0
#include "agents/perception/scan_clusters.hpp"

#include "tests/catch.hpp"
#include "tests/unit/agents/perception/scene.hpp"

namespace sidestep::scan_clusters_test {

constexpr LaserSettings kLaser{720, 2 * std::numbers::pi, 0.05, 8};

/// A scan of discs from the origin. Selects the hits for which `select(end)` holds.
struct View {
  LaserBeams beams{kLaser};
  ScanClusters clusters{0.15};

  template <typename Select>
  View(std::span<const Circle> discs, double heading_rad, double dropouts, const Select& select) {
    std::vector<float> ranges(720);
    LaserScanner(kLaser).scan({nullptr, nullptr, nullptr, discs}, {0, 0}, heading_rad, ranges);
    Rng rng(1);
    for (float& range_m : ranges)
      if (rng.chance(dropouts)) range_m = test::kNoRange;
    beams.read({{0, 0}, heading_rad, Time{}, ranges}, {});
    std::vector<std::uint8_t> selected(720);
    for (int i = 0; i < 720; ++i)
      selected[static_cast<std::size_t>(i)] = beams[i].end == BeamEnd::kHit && select(beams.end_m(beams[i]));
    clusters.find(beams, selected);
  }
};

const auto kAll = [](const Vec2&) { return true; };

TEST_CASE("each disc is one cluster with its radius and mean hit, wherever the scan starts") {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    std::vector<Circle> discs;
    for (int i = 0; i < 5; ++i) {
      const double radius_m = rng.uniform(0.1, 0.3), distance_m = rng.uniform(1.5, 4);
      discs.push_back({rotated({distance_m, 0}, 1.2 * i), radius_m});
    }
    const View view(discs, rng.uniform(-4, 4), rng.chance(0.5) ? 0.05 : 0, kAll);
    REQUIRE(view.clusters.all().size() == 5);
    for (const Circle& disc : discs) {
      const auto found = std::ranges::find_if(view.clusters.all(), [&](const ScanCluster& cluster) {
        return (cluster.mean_m - disc.centre_m).norm() < disc.radius_m;
      });
      REQUIRE(found != view.clusters.all().end());
      CHECK(found->radius_m == Approx(disc.radius_m).epsilon(0.2).margin(0.04));
      CHECK(found->away.dot(disc.centre_m.normalized()) > 0.999);
      CHECK_FALSE(found->is_partial);
      CHECK(found->hits >= 4);
      const double depth_m = disc.centre_m.norm() - found->mean_m.norm();
      CHECK(depth_m == Approx(std::numbers::pi / 4 * disc.radius_m).epsilon(0.2).margin(0.02));
    }
  }
}

TEST_CASE("clusters end where hits are far apart or are not selected") {
  // Two discs; the nearer disc hides half of the farther disc.
  const std::vector<Circle> discs{{{2, 0}, 0.2}, {{4, 0.4}, 0.25}};
  const View both(discs, 1, 0, kAll);
  REQUIRE(both.clusters.all().size() == 2);
  CHECK_FALSE(both.clusters.all()[0].is_partial);
  CHECK(both.clusters.all()[1].is_partial);
  const View far(discs, 1, 0, [](const Vec2& end) { return end.x() > 3; });
  REQUIRE(far.clusters.all().size() == 1);
  CHECK(far.clusters.all()[0].is_partial);
  const View halves(discs, 1, 0, [](const Vec2& end) { return std::abs(end.y()) > 0.03; });
  CHECK(halves.clusters.all().size() == 3);
  CHECK(View(discs, 1, 0, [](const Vec2&) { return false; }).clusters.all().empty());
  CHECK(View({}, 1, 0, kAll).clusters.all().empty());
}

TEST_CASE("a cluster that spans the whole scan is found") {
  LaserBeams beams(kLaser);
  const std::vector<float> ranges(720, 1.5F);
  beams.read({{0, 0}, 0, Time{}, ranges}, {});
  ScanClusters clusters(0.15);
  clusters.find(beams, std::vector<std::uint8_t>(720, 1));
  REQUIRE(clusters.all().size() == 1);
  CHECK(clusters.all()[0].hits == 720);
  CHECK(clusters.all()[0].mean_m.norm() < 1e-6);
  CHECK(clusters.all()[0].radius_m > 1);
}

}  // namespace sidestep::scan_clusters_test
