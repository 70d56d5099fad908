// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/free_space.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace sidestep {
namespace {

typedef float FourFloats __attribute__((vector_size(16)));
typedef std::int32_t FourInts __attribute__((vector_size(16)));

// Position of empty lanes: farther away than any obstacle.
constexpr float kNowhere_m = 1e15F, kNone_m2 = 1e30F;

FourFloats load_floats(const float* lanes) {
  FourFloats v;
  std::memcpy(&v, lanes, sizeof v);
  return v;
}

/// The nearest points so far, one in each lane.
struct NearestFour {
  FourFloats least2_m2 = kNone_m2 - FourFloats{};
  FourInts block{};

  void add(const FourFloats& distance2_m2, const FourInts& number) {
    block = distance2_m2 < least2_m2 ? number : block;
    least2_m2 = distance2_m2 < least2_m2 ? distance2_m2 : least2_m2;
  }
};

}  // namespace

void ObstaclePoints::set(std::span<const Vec2> points_m, const Vec2& robot_m) {
  origin_m_ = robot_m;
  blocks_.clear();
  std::size_t lane = kLanes;
  for (const Vec2& point : points_m) {
    if (!point.allFinite()) continue;
    if (lane == kLanes) {
      Block& block = blocks_.emplace_back();
      std::fill_n(block.x_m, kLanes, kNowhere_m);
      std::fill_n(block.y_m, kLanes, kNowhere_m);
      std::fill_n(block.from_robot2_m2, kLanes, kNone_m2);
      lane = 0;
    }
    Block& block = blocks_.back();
    const Vec2 off = point - origin_m_;
    block.x_m[lane] = static_cast<float>(off.x());
    block.y_m[lane] = static_cast<float>(off.y());
    block.from_robot2_m2[lane] = static_cast<float>(off.squaredNorm());
    ++lane;
  }
}

FreeDistance ObstaclePoints::operator()(const Vec2& at_m, double masked_m) const {
  if (masked_m <= 0) return nearest<false>(at_m, 0);
  return nearest<true>(at_m, static_cast<float>(masked_m * masked_m));
}

template <bool kMasks>
FreeDistance ObstaclePoints::nearest(const Vec2& at_m, float masked2_m2) const {
  constexpr std::size_t kHalf = kLanes / 2;
  const Vec2 at = at_m - origin_m_;
  const auto x = static_cast<float>(at.x()), y = static_cast<float>(at.y());
  const FourFloats none = kNone_m2 - FourFloats{};
  NearestFour found[2];  // two: the processor need not wait for the previous comparison
  FourInts number{};
  for (const Block& block : blocks_) {
    for (std::size_t half = 0; half < 2; ++half) {
      const FourFloats dx = load_floats(block.x_m + half * kHalf) - x;
      const FourFloats dy = load_floats(block.y_m + half * kHalf) - y;
      FourFloats distance2 = dx * dx + dy * dy;
      if constexpr (kMasks)
        distance2 = load_floats(block.from_robot2_m2 + half * kHalf) >= masked2_m2 ? distance2 : none;
      found[half].add(distance2, number);
    }
    number += 1;
  }
  float least2 = kNone_m2;
  std::size_t lane = 0, block = 0;
  for (std::size_t i = 0; i < kLanes; ++i) {
    const NearestFour& half = found[i / kHalf];
    if (half.least2_m2[i % kHalf] >= least2) continue;
    least2 = half.least2_m2[i % kHalf];
    lane = i;
    block = static_cast<std::size_t>(half.block[i % kHalf]);
  }
  if (least2 == kNone_m2) return {};
  const Block& points = blocks_[block];
  const Vec2 off = at - Vec2(static_cast<double>(points.x_m[lane]), static_cast<double>(points.y_m[lane]));
  const double distance_m = off.norm();
  return {distance_m, distance_m > 0 ? Vec2(off / distance_m) : Vec2(0, 0)};
}

}  // namespace sidestep
