// SPDX-License-Identifier: Apache-2.0
#include "agents/perception/laser_tracks.hpp"

namespace sidestep {
namespace {

constexpr double kExplainedWithin_m = 0.12;  ///< a hit this near to something stationary belongs to it
/// Cells that have been occupied for this long count as stationary.
constexpr Duration kStandingAfter{2'000'000'000};
constexpr double kJoin_m = 0.15;          ///< hits this near to each other belong to one object
constexpr int kMinHits = 2;               ///< minimum number of hits in a cluster
constexpr double kMaxPerson_m = 0.6;      ///< larger clusters are not people
constexpr double kClusterNoise_m = 0.03;  ///< standard deviation of a cluster's centre, on each axis
/// Standard deviation of a cluster's centre if part of the cluster is hidden.
constexpr double kPartialNoise_m = 0.1;
constexpr MotionNoise kPersonMotion{0.15, 1};
constexpr double kStartSpeed_mps = 1;  ///< standard deviation of a new track's velocity, on each axis
constexpr double kGate_m = 0.4;        ///< maximum distance of a cluster from the prediction
constexpr int kConfirmScans = 4;
constexpr Duration kDropAfter{1'000'000'000};  ///< time without an observation after which a track ends
constexpr double kMinSpeed_mps = 0.25;         ///< tracks slower than this count as not moving
/// Tracks whose speed is below this many standard deviations count as not moving.
constexpr double kSpeedDeviations = 2.5;
constexpr double kMinMoved_m = 0.3;  ///< tracks that have moved less than this count as not moving
/// How long a place counts as seen free after a beam crossed it.
constexpr Duration kCrossingMemory{10'000'000'000};
/// Fraction of a place that beams must cross for it to count as seen free.
constexpr double kCrossedPart = 0.8;

/// The mean of the hits on a disc is this much nearer than its centre, in radii: the mean of sqrt(1 - y²)
/// over y.
constexpr double kMeanDepth = std::numbers::pi / 4;
constexpr double kRadiusGain = 0.2;
/// A hit may belong to a track if it is at most this far beyond the track's radius.
constexpr double kTrackSlack_m = 0.15;

}  // namespace

LaserTracks::LaserTracks() : clusters_(kJoin_m) {
  entries_.reserve(kMaxTracks);
  listed_.reserve(kMaxTracks);
}

bool LaserTracks::update(const LaserBeams& beams, const LocalGrid& grid, const PriorMap& floor) {
  if (beams.captured_at() <= now_) return false;
  now_ = beams.captured_at();
  std::erase_if(entries_, [&](const Entry& entry) { return now_ - entry.seen_at > kDropAfter; });
  classify(beams, grid, floor);
  clusters_.find(beams, is_unexplained_);
  associate(grid);
  for (std::size_t i = 0; i < clusters_.all().size(); ++i)
    if (is_used_[i] == 0 && is_trackable(clusters_.all()[i])) start(clusters_.all()[i]);
  list();
  return true;
}

void LaserTracks::classify(const LaserBeams& beams, const LocalGrid& grid, const PriorMap& floor) {
  kinds_.assign(beams.all().size(), kOther);
  is_unexplained_.assign(beams.all().size(), 0);
  for (std::size_t i = 0; i < kinds_.size(); ++i) {
    const Beam& beam = beams.all()[i];
    if (beam.end != BeamEnd::kHit) continue;
    const Vec2 hit = beams.end_m(beam);
    kinds_[i] = floor.is_near(hit, kExplainedWithin_m) || is_explained(hit, grid) ? kStanding : kUnexplained;
    is_unexplained_[i] = kinds_[i] == kUnexplained;
  }
}

bool LaserTracks::is_explained(const Vec2& hit, const LocalGrid& grid) const {
  bool is_found = false;
  grid.for_each_occupied(inflated({hit, hit}, kExplainedWithin_m), [&](const Cell& cell) {
    const Duration occupied_for = grid.occupied_for(cell);
    is_found = is_found || (occupied_for >= kStandingAfter &&
                            signed_distance(hit, grid.box_of(cell)) <= kExplainedWithin_m &&
                            !is_of_moving_track(hit, grid.updated_at() - occupied_for));
  });
  return is_found;
}

/// Whether a track that has moved is at the hit, which means that the object may have arrived recently.
bool LaserTracks::is_of_moving_track(const Vec2& hit, Time occupied_since) const {
  return std::ranges::any_of(entries_, [&](const Entry& entry) {
    const double reach_m = entry.radius_m + kTrackSlack_m;
    return entry.has_moved() && occupied_since >= entry.started_at &&
           (hit - predicted_m(entry)).squaredNorm() < reach_m * reach_m;
  });
}

Vec2 LaserTracks::predicted_m(const Entry& entry) const {
  return entry.filter.position() + to_seconds(now_ - entry.seen_at) * entry.filter.velocity();
}

Vec2 LaserTracks::centre_m(const ScanCluster& cluster, double radius_m) const {
  return cluster.mean_m + kMeanDepth * radius_m * cluster.away;
}

bool LaserTracks::is_trackable(const ScanCluster& cluster) const {
  return cluster.hits >= kMinHits && cluster.radius_m <= kMaxPerson_m;
}

void LaserTracks::associate(const LocalGrid& grid) {
  const auto clusters = clusters_.all();
  pairs_.clear();
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    const Vec2 predicted = predicted_m(entries_[e]);
    for (std::size_t c = 0; c < clusters.size(); ++c) {
      const double distance_m = (centre_m(clusters[c], entries_[e].radius_m) - predicted).norm();
      if (distance_m <= kGate_m && is_trackable(clusters[c])) pairs_.push_back({distance_m, e, c});
    }
  }
  std::ranges::sort(pairs_, {}, &Pair::distance_m);
  is_used_.assign(clusters.size(), 0);
  is_updated_.assign(entries_.size(), 0);
  for (const Pair& pair : pairs_) {
    if (is_updated_[pair.entry] != 0 || is_used_[pair.cluster] != 0) continue;
    is_updated_[pair.entry] = is_used_[pair.cluster] = 1;
    observe(entries_[pair.entry], clusters[pair.cluster], grid);
  }
}

void LaserTracks::observe(Entry& entry, const ScanCluster& cluster, const LocalGrid& grid) {
  if (!cluster.is_partial) entry.radius_m += kRadiusGain * (cluster.radius_m - entry.radius_m);
  const Vec2 centre = centre_m(cluster, entry.radius_m);
  const double noise_m = cluster.is_partial ? kPartialNoise_m : kClusterNoise_m;
  entry.filter.predict(to_seconds(now_ - entry.seen_at), kPersonMotion);
  entry.filter.correct(centre - entry.filter.position(), noise_m * noise_m);
  entry.seen_at = now_;
  ++entry.scans;
  if (is_fast(entry) && shows_motion(entry, grid)) ++entry.evidence;
}

bool LaserTracks::is_fast(const Entry& entry) const {
  const double error = std::sqrt(entry.filter.covariance()(1, 1));
  return entry.filter.velocity().norm() > std::max(kMinSpeed_mps, kSpeedDeviations * error);
}

bool LaserTracks::shows_motion(const Entry& entry, const LocalGrid& grid) const {
  const Vec2& here = entry.filter.position();
  return (here - entry.start_m).norm() >= kMinMoved_m &&
         (was_crossed({here, entry.radius_m}, now_ - kCrossingMemory, grid) ||
          was_crossed({entry.start_m, entry.radius_m}, entry.started_at, grid));
}

/// Whether beams have crossed nearly all cells of a disc since a time.
bool LaserTracks::was_crossed(const Circle& disc, Time since, const LocalGrid& grid) const {
  const double radius_m = std::max(disc.radius_m, 2 * LocalGrid::kResolution_m);
  const Cell first = grid.cell_at(disc.centre_m - Vec2(radius_m, radius_m));
  const Cell last = grid.cell_at(disc.centre_m + Vec2(radius_m, radius_m));
  int cells = 0, crossed = 0;
  for (int row = first.row; row <= last.row; ++row) {
    for (int column = first.column; column <= last.column; ++column) {
      const Box box = grid.box_of({column, row});
      if (((box.min_m + box.max_m) / 2 - disc.centre_m).norm() > radius_m) continue;
      ++cells;
      crossed += grid.crossed_at({column, row}) > since;
    }
  }
  return crossed > kCrossedPart * cells;
}

void LaserTracks::start(const ScanCluster& cluster) {
  if (entries_.size() == kMaxTracks) return;
  const Vec2 centre = centre_m(cluster, cluster.radius_m);
  Entry entry;
  entry.number = ++last_number_;
  entry.scans = 1;
  entry.started_at = entry.seen_at = now_;
  entry.radius_m = cluster.radius_m;
  entry.filter = {centre, kClusterNoise_m * kClusterNoise_m, kStartSpeed_mps * kStartSpeed_mps};
  entry.start_m = centre;
  entries_.push_back(entry);
}

void LaserTracks::list() {
  listed_.clear();
  for (const Entry& entry : entries_) {
    if (entry.scans < kConfirmScans) continue;
    listed_.push_back({entry.number, entry.filter.position(), entry.filter.velocity(), entry.radius_m,
                       std::sqrt(entry.filter.covariance()(0, 0)), std::sqrt(entry.filter.covariance()(1, 1)),
                       entry.seen_at, entry.has_moved() && is_fast(entry)});
  }
}

}  // namespace sidestep
