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

Point draw(Rng& rng) { return {rng.uniform(-5, 5), rng.uniform(-5, 5)}; }

/// The peer: a K-D tree of static trees, that takes points one by one as ours does.
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
    std::size_t number = 0;
    double distance2 = 0;
    nanoflann::KNNResultSet<double> found(1);
    found.init(&number, &distance2);
    index_->findNeighbors(found, point.data(), nanoflann::SearchParams());
    return static_cast<std::uint32_t>(number);
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

/// As a tree planner does: asks for the nearest of what it has, and adds a point.
template <typename Set>
void grow(benchmark::State& state) {
  const auto points = static_cast<std::size_t>(state.range(0));
  Set set;
  Rng rng(1);
  for (auto _ : state) {
    set.clear();
    set.add(draw(rng));
    for (std::size_t i = 1; i < points; ++i) {
      benchmark::DoNotOptimize(set.nearest(draw(rng)));
      set.add(draw(rng));
    }
  }
  state.counters["per_point_ns"] =
      benchmark::Counter(static_cast<double>(state.iterations() * state.range(0)) * 1e-9,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

BENCHMARK_TEMPLATE(grow, LinearNearest<2>)->RangeMultiplier(4)->Range(16, 16384);
BENCHMARK_TEMPLATE(grow, KdTree<2>)->RangeMultiplier(4)->Range(16, 16384);
BENCHMARK_TEMPLATE(grow, NanoflannTree)->RangeMultiplier(4)->Range(16, 16384);

}  // namespace
}  // namespace sidestep
