// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/map/laser_scanner.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// A laser scan, with the place and time at which it was taken.
struct LaserScan {
  Vec2 at_m{0, 0};  ///< position of the scanner
  double heading_rad = 0;
  Time captured_at{};
  std::span<const float> ranges_m;  ///< as written by LaserScanner::scan(); NaN is a dropout
};

enum class BeamEnd : std::uint8_t {
  kUnknown,  ///< nothing is known: a dropout, or something nearer than the minimum range
  kHit,
  kRobot,  ///< a hit on a known robot
  kClear,  ///< no hit up to the maximum range
};

struct Beam {
  Vec2 direction{1, 0};  ///< unit vector in the world frame
  double free_m = 0;     ///< free distance from the scanner; 0 if nothing is known
  BeamEnd end = BeamEnd::kUnknown;
};

/// The beams of the last scan, in the world's frame. Known robots are distinguished, because they report
/// their own positions. Does not allocate after the constructor.
class LaserBeams {
 public:
  /// A hit belongs to a robot if it is within the robot's radius plus the tolerance. Throws
  /// std::invalid_argument for invalid settings (see LaserScanner), or if the tolerance is negative or not
  /// finite.
  explicit LaserBeams(const LaserSettings& settings, double robot_tolerance_m = 0.1);

  /// `robots` are the known robots at the time of the scan, without the robot that carries the scanner.
  /// Throws std::invalid_argument if the number of ranges differs from the number of beams, a robot or the
  /// pose is not finite, or a radius is negative. Finite ranges beyond the limits are clamped to the limits.
  void read(const LaserScan& scan, std::span<const Circle> robots);

  std::span<const Beam> all() const { return beams_; }
  int count() const { return static_cast<int>(beams_.size()); }
  const Beam& operator[](int beam) const { return beams_[static_cast<std::size_t>(beam)]; }
  Vec2 end_m(const Beam& beam) const { return at_m_ + beam.free_m * beam.direction; }

  const Vec2& at_m() const { return at_m_; }
  Time captured_at() const { return captured_at_; }
  const LaserSettings& settings() const { return scanner_.settings(); }
  /// The counter-clockwise angle from a beam to the next beam; for the last beam, to the first beam.
  double gap_rad(int beam) const { return beam + 1 < count() ? spacing_rad_ : last_gap_rad_; }

 private:
  Beam interpreted(float range_m, const Vec2& direction, std::span<const Circle> robots) const;

  LaserScanner scanner_;
  double robot_tolerance_m_;
  double spacing_rad_, last_gap_rad_;
  std::vector<Vec2> directions_;  // indexed by beam; relative to the heading
  std::vector<Beam> beams_;
  Vec2 at_m_{0, 0};
  Time captured_at_{};
};

}  // namespace sidestep
