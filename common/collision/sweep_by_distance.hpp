// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <stdexcept>
#include <utility>

namespace sidestep {

/// Default distance below which a near miss counts as contact. It bounds the number of distance queries along
/// a path that grazes an obstacle.
inline constexpr double kGrazing_m = 1e-6;

/// Swept collision queries for a body that translates in a straight line, built from distance queries only.
/// The function `clearance_m(position)` returns the distance between the body at that position and the
/// nearest obstacle, or a lower bound of that distance. Its rate of change must not exceed the body's speed;
/// this holds for any body that does not rotate. `Position` is an Eigen vector.
template <typename Position, typename Clearance>
class SweepByDistance {
 public:
  /// Throws std::invalid_argument if a number is not finite, the radius is negative, or `grazing_m` <= 0.
  SweepByDistance(const Position& from, const Position& to, double radius_m, Clearance clearance_m,
                  double grazing_m = kGrazing_m)
      : from_(from),
        displacement_(to - from),
        length_m_(displacement_.norm()),
        radius_m_(radius_m),
        grazing_m_(grazing_m),
        clearance_m_(std::move(clearance_m)) {
    if (!std::isfinite(length_m_) || !std::isfinite(radius_m + grazing_m))
      throw std::invalid_argument("a path's ends and the radius have to be finite");
    if (radius_m < 0 || !(grazing_m > 0))
      throw std::invalid_argument("the radius has to be >= 0 and the grazing distance > 0");
  }

  /// Whether the body, inflated by the radius, touches an obstacle along its path. The clearance at the
  /// midpoint excludes contact on a stretch to either side; the two remaining parts are checked recursively
  /// (Bruce 2006, chapter 3).
  bool touches() const { return touches(0, length_m_); }

  /// The distance that the body moves before contact, found by conservative advancement: each step advances
  /// by the clearance at the current position.
  double free_path_m() const {
    for (double travelled_m = 0; travelled_m < length_m_;) {
      const double free_m = free_at(travelled_m);
      if (!(free_m > grazing_m_)) return travelled_m;
      travelled_m += free_m;
    }
    return length_m_;
  }

 private:
  double free_at(double along_m) const {
    const double fraction = length_m_ > 0 ? along_m / length_m_ : 0;
    return clearance_m_(Position(from_ + fraction * displacement_)) - radius_m_;
  }

  bool touches(double begin_m, double end_m) const {
    const double middle_m = 0.5 * (begin_m + end_m), free_m = free_at(middle_m);
    // Negated, so that NaN counts as contact.
    if (!(free_m > grazing_m_)) return true;
    if (free_m >= middle_m - begin_m) return false;
    return touches(begin_m, middle_m - free_m) || touches(middle_m + free_m, end_m);
  }

  Position from_, displacement_;
  double length_m_, radius_m_, grazing_m_;
  Clearance clearance_m_;
};

}  // namespace sidestep
