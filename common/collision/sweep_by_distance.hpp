// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <stdexcept>
#include <utility>

namespace sidestep {

/// Nearer to a touch than this is a touch: it bounds how often distances are asked for along a way that
/// grazes.
inline constexpr double kGrazing_m = 1e-6;

/// What moves straight from one place to another, of which nothing but the clearance is known: the distance
/// of what is at a place, or a lower bound, from the nearest obstacle. It may not change faster than the
/// place does, as that of any body that does not turn. Place: a vector of Eigen.
template <typename Place, typename Clearance>
class SweepByDistance {
 public:
  /// Throws std::invalid_argument where a number is not finite, the radius is negative or grazing is not
  /// above 0.
  SweepByDistance(const Place& from, const Place& to, double radius_m, Clearance clearance_m,
                  double grazing_m = kGrazing_m)
      : from_(from),
        way_(to - from),
        length_m_(way_.norm()),
        radius_m_(radius_m),
        grazing_m_(grazing_m),
        clearance_m_(std::move(clearance_m)) {
    if (!std::isfinite(length_m_) || !std::isfinite(radius_m + grazing_m))
      throw std::invalid_argument("a way's ends and the radius have to be finite");
    if (radius_m < 0 || !(grazing_m > 0))
      throw std::invalid_argument("a radius is negative, or what counts as grazing is not above 0");
  }

  /// Whether a disc or ball of the radius touches on its way. The clearance in the middle says how far on
  /// both sides nothing can touch; the same goes for the two parts left (Bruce 2006, chapter 3).
  bool touches() const { return touches(0, length_m_); }

  /// How far it goes before it touches: from where it is as far as the clearance there (Lecture 9 of
  /// Autonomous Mobile Robots has this form).
  double free_way_m() const {
    for (double gone_m = 0; gone_m < length_m_;) {
      const double free_m = free_at(gone_m);
      if (!(free_m > grazing_m_)) return gone_m;
      gone_m += free_m;
    }
    return length_m_;
  }

 private:
  double free_at(double along_m) const {
    const double part = length_m_ > 0 ? along_m / length_m_ : 0;
    return clearance_m_(Place(from_ + part * way_)) - radius_m_;
  }

  bool touches(double begin_m, double end_m) const {
    const double middle_m = 0.5 * (begin_m + end_m), free_m = free_at(middle_m);
    // Also where there is no number.
    if (!(free_m > grazing_m_)) return true;
    if (free_m >= middle_m - begin_m) return false;
    return touches(begin_m, middle_m - free_m) || touches(middle_m + free_m, end_m);
  }

  Place from_, way_;
  double length_m_, radius_m_, grazing_m_;
  Clearance clearance_m_;
};

}  // namespace sidestep
