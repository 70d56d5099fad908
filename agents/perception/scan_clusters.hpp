// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/perception/laser_beams.hpp"

namespace sidestep {

/// Neighbouring hits of a scan that may belong to one object.
struct ScanCluster {
  Vec2 mean_m{0, 0};    ///< mean of the hits
  Vec2 away{1, 0};      ///< unit vector from the scanner to the mean
  double radius_m = 0;  ///< radius of the disc that would fill the cluster's angle at its distance
  int hits = 0;
  bool is_partial = false;  ///< a nearer object hides one end, or the field of view ends there
};

/// Finds the clusters among selected hits: consecutive hits that are at most `join_m` apart, or farther apart
/// at larger distances, where beams diverge (adaptive breakpoints: Borges, Aldon 2004). Dropouts do not
/// separate clusters. Does not allocate once warm.
class ScanClusters {
 public:
  explicit ScanClusters(double join_m) : join_m_(join_m) {}

  /// `is_selected`, indexed by beam, is not 0 for the hits to be clustered.
  void find(const LaserBeams& beams, std::span<const std::uint8_t> is_selected);
  std::span<const ScanCluster> all() const { return clusters_; }

 private:
  /// The hits of the current cluster.
  struct Run {
    int first = 0, last = 0, hits = 0;  // beam numbers continue beyond the end of the scan
    Vec2 sum_m{0, 0};
    double nearest_m = 0;
  };

  bool joins(const LaserBeams& beams, const Beam& last, const Beam& next) const;
  bool is_hidden_beside(const LaserBeams& beams, int beam, int step) const;
  void close(const LaserBeams& beams, Run& run);

  double join_m_;
  std::vector<ScanCluster> clusters_;
};

}  // namespace sidestep
