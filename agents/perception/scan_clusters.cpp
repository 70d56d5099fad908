// SPDX-License-Identifier: Apache-2.0
#include "agents/perception/scan_clusters.hpp"

namespace sidestep {
namespace {

/// Maximum number of missing beams within a cluster. If more are missing beside it, its surroundings count as
/// unknown.
constexpr int kMissing = 2;

bool is_full_turn(const LaserBeams& beams) {
  return beams.gap_rad(beams.count() - 1) < 1.5 * beams.gap_rad(0);
}

}  // namespace

bool ScanClusters::joins(const LaserBeams& beams, const Beam& last, const Beam& next) const {
  const double spread_m = (kMissing + 1) * beams.gap_rad(0) * std::max(last.free_m, next.free_m);
  return (beams.end_m(last) - beams.end_m(next)).norm() <= join_m_ + spread_m;
}

/// Whether the beam beside an end of a cluster is nearer, which means that it may hide more of the object.
bool ScanClusters::is_hidden_beside(const LaserBeams& beams, int beam, int step) const {
  for (int i = 1; i <= kMissing + 1; ++i) {
    int beside = beam + i * step;
    if (is_full_turn(beams)) beside = (beside + beams.count()) % beams.count();
    if (beside < 0 || beside >= beams.count()) return true;
    if (beams[beside].end != BeamEnd::kUnknown) return beams[beside].free_m < beams[beam].free_m - join_m_;
  }
  return true;
}

void ScanClusters::close(const LaserBeams& beams, Run& run) {
  if (run.hits > 0) {
    ScanCluster cluster;
    cluster.hits = run.hits;
    cluster.mean_m = run.sum_m / run.hits;
    const Vec2 offset = cluster.mean_m - beams.at_m();
    cluster.away = offset / std::max(offset.norm(), 1e-9);
    const double half_rad = std::min((run.last - run.first + 1) * beams.gap_rad(0) / 2, std::numbers::pi / 3);
    cluster.radius_m = run.nearest_m * std::sin(half_rad) / (1 - std::sin(half_rad));
    cluster.is_partial = is_hidden_beside(beams, run.first % beams.count(), -1) ||
                         is_hidden_beside(beams, run.last % beams.count(), 1);
    clusters_.push_back(cluster);
  }
  run = {};
}

void ScanClusters::find(const LaserBeams& beams, std::span<const std::uint8_t> is_selected) {
  clusters_.clear();
  const int count = beams.count();
  const auto selected = [&](int beam) { return is_selected[static_cast<std::size_t>(beam)] != 0; };
  // A scan of a full turn is searched from a beam outside all clusters, so no cluster is divided.
  int start = 0;
  if (is_full_turn(beams))
    while (start < count && (selected(start) || beams[start].end == BeamEnd::kUnknown)) ++start;
  Run run;
  for (int i = start; i < start + count; ++i) {
    const Beam& beam = beams[i % count];
    if (beam.end == BeamEnd::kUnknown) continue;
    const bool is_separate = run.hits > 0 && !joins(beams, beams[run.last % count], beam);
    if (is_separate || !selected(i % count)) close(beams, run);
    if (!selected(i % count)) continue;
    if (run.hits == 0) run = {i, i, 0, {0, 0}, beam.free_m};
    run.last = i;
    ++run.hits;
    run.sum_m += beams.end_m(beam);
    run.nearest_m = std::min(run.nearest_m, beam.free_m);
  }
  close(beams, run);
}

}  // namespace sidestep
