// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>
#include <memory>
#include <nanoflann.hpp>

#include "agents/planning/trees/kd_tree.hpp"
#include "agents/planning/trees/linear_nearest.hpp"
#include "common/random/rng.hpp"

namespace sidestep {
namespace {

using Point = std::array<double, 2>;

Point sample_point(Rng& rng) { return {rng.uniform(-5, 5), rng.uniform(-5, 5)}; }

/// The peer: nanoflann's dynamic index, a set of static K-D trees. Points are added one by one.
class NanoflannTree {
 public:
  using Index =
      nanoflann::KDTreeSingleIndexDynamicAdaptor<nanoflann::L2_Simple_Adaptor<double, NanoflannTree>,
                                                 NanoflannTree, 2>;

  void clear() {
    points_.clear();
    index_ = std::make_unique<Index>(2, *this, nanoflann::KDTreeSingleIndexAdaptorParams(16));
  }
  void add(const Point& point) {
    points_.push_back(point);
    index_->addPoints(points_.size() - 1, points_.size() - 1);
  }
  std::uint32_t nearest(const Point& point) const {
    std::size_t index = 0;
    double distance2 = 0;
    nanoflann::KNNResultSet<double> found(1);
    found.init(&index, &distance2);
    index_->findNeighbors(found, point.data(), {});
    return static_cast<std::uint32_t>(index);
  }

  std::size_t kdtree_get_point_count() const { return points_.size(); }
  double kdtree_get_pt(std::size_t i, std::size_t axis) const { return points_[i][axis]; }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }

 private:
  std::vector<Point> points_;
  std::unique_ptr<Index> index_;
};

/// Works like a tree planner: finds the nearest stored point, then adds a point.
template <typename Set>
void grow_set(benchmark::State& state) {
  const auto points = static_cast<std::size_t>(state.range(0));
  Set set;
  Rng rng(1);
  for (auto _ : state) {
    set.clear();
    set.add(sample_point(rng));
    for (std::size_t i = 1; i < points; ++i) {
      benchmark::DoNotOptimize(set.nearest(sample_point(rng)));
      set.add(sample_point(rng));
    }
  }
  state.counters["per_point_ns"] =
      benchmark::Counter(static_cast<double>(state.iterations() * state.range(0)) * 1e-9,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

BENCHMARK_TEMPLATE(grow_set, LinearNearest<2>)->RangeMultiplier(4)->Range(16, 16384);
BENCHMARK_TEMPLATE(grow_set, KdTree<2>)->RangeMultiplier(4)->Range(16, 16384);
BENCHMARK_TEMPLATE(grow_set, NanoflannTree)->RangeMultiplier(4)->Range(16, 16384);

}  // namespace
}  // namespace sidestep
