// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/perception/laser_beams.hpp"
#include "common/map/floor_plan.hpp"
#include "common/random/rng.hpp"

namespace sidestep::test {

inline constexpr float kNoRange = std::numeric_limits<float>::quiet_NaN();

/// Errors of a laser.
struct ScanNoise {
  double deviation_m = 0;
  double largest_m = 1e9;  ///< maximum absolute error
  double dropouts = 0;     ///< fraction of beams without a range
};

/// A floor plan of 12 m x 12 m with a scanner.
class Scene {
 public:
  explicit Scene(std::uint64_t seed, const LaserSettings& laser = {})
      : map_(make_floor_plan(seed, {240, 240, 0.05, {-6, -6}})),
        field_(map_),
        scanner_(laser),
        ranges_m_(static_cast<std::size_t>(laser.beams)) {}

  const OccupancyMap& map() const { return map_; }
  const LaserSettings& laser() const { return scanner_.settings(); }
  std::span<const float> ranges_m() const { return ranges_m_; }

  bool is_free(const Vec2& from, const Vec2& to, double radius_m) const {
    return !touches(map_, field_, from, to, radius_m);
  }
  Vec2 random_free(Rng& rng, double radius_m) const {
    while (true) {
      const double x = rng.uniform(-6, 6), y = rng.uniform(-6, 6);
      if (is_free({x, y}, {x, y}, radius_m)) return {x, y};
    }
  }
  /// The scan's ranges stay valid until the next scan.
  LaserScan scan(const Vec2& at, double heading_rad, Time captured_at, std::span<const Circle> discs,
                 const ScanNoise& noise, Rng& rng) {
    scanner_.scan({&map_, &field_, nullptr, discs}, at, heading_rad, ranges_m_);
    for (float& range_m : ranges_m_) {
      const double error_m = noise.deviation_m * rng.normal();
      if (std::isfinite(range_m))
        range_m += static_cast<float>(std::clamp(error_m, -noise.largest_m, noise.largest_m));
      if (rng.chance(noise.dropouts)) range_m = kNoRange;
    }
    return {at, heading_rad, captured_at, ranges_m_};
  }

 private:
  OccupancyMap map_;
  DistanceField field_;
  LaserScanner scanner_;
  std::vector<float> ranges_m_;
};

/// A disc that walks straight from one random free position to the next, with a limited turn rate.
class Walker {
 public:
  Walker(const Scene& scene, Rng& rng, double radius_m, double speed_mps)
      : radius_m_(radius_m), speed_mps_(speed_mps), at_m_(scene.random_free(rng, radius_m)), to_m_(at_m_) {}

  void step(const Scene& scene, Rng& rng, double seconds) {
    for (int i = 0; i < 100 && (to_m_ - at_m_).norm() < 0.1; ++i) {
      const Vec2 to = scene.random_free(rng, radius_m_);
      if (scene.is_free(at_m_, to, radius_m_)) to_m_ = to;
    }
    const Vec2 offset = to_m_ - at_m_;
    if (offset.norm() < 0.1) return;
    const double turn_rad = wrapped_rad(std::atan2(offset.y(), offset.x()) - heading_rad_);
    constexpr double kTurn_radps = 2.5;
    heading_rad_ += std::clamp(turn_rad, -kTurn_radps * seconds, kTurn_radps * seconds);
    is_walking_ = std::abs(turn_rad) <= kTurn_radps * seconds;
    if (is_walking_) at_m_ += std::min(speed_mps_ * seconds, offset.norm()) * offset.normalized();
  }

  Circle disc() const { return {at_m_, radius_m_}; }
  const Vec2& at_m() const { return at_m_; }
  double heading_rad() const { return heading_rad_; }
  Vec2 velocity_mps() const {
    return is_walking_ ? Vec2(speed_mps_ * (to_m_ - at_m_).normalized()) : Vec2(0, 0);
  }

 private:
  double radius_m_, speed_mps_;
  Vec2 at_m_, to_m_;
  double heading_rad_ = 0;
  bool is_walking_ = false;
};

}  // namespace sidestep::test
