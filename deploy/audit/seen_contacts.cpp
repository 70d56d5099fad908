// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/seen_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sidestep {
namespace {

constexpr double kErrorPerDeviation = 4;
// Standard deviation of positions found in images, per axis.
constexpr double kImageNoise_m = 0.001;
constexpr double kMaxTimeDifference_s = 0.02;
// A contact ends when the distance exceeds that of touching bodies by more than this.
constexpr double kEndOfContact_m = 0.001;
constexpr int kMinObservations = 2;

}  // namespace

double position_error_m(const VisionSpec& vision) {
  return kErrorPerDeviation * std::max(vision.position_noise_m, vision.images ? kImageNoise_m : 0);
}

SeenContacts::SeenContacts(const Scenario& scenario)
    : radius_m_(scenario.radius_m),
      obstacles_(scenario.obstacles.begin(), scenario.obstacles.end()),
      map_(scenario.map),
      position_error_m_(position_error_m(scenario.vision)),
      acceleration_mps2_(std::max(scenario.limits.acceleration_mps2, scenario.limits.deceleration_mps2)),
      guaranteed_m_(scenario.margin_m - 2 * scenario.tracking_bound_m),
      guaranteed_to_obstacle_m_(scenario.margin_m - scenario.tracking_bound_m) {}

double SeenContacts::robot_allowance_m(double time_difference_s) const {
  const double extrapolation_m = acceleration_mps2_ / 2 * time_difference_s * time_difference_s;
  return std::max(0.0, std::sqrt(2.0) * position_error_m_ + extrapolation_m - guaranteed_m_);
}

double SeenContacts::distance_from_map_m(const Vec2& position_m) const {
  const Vec2 reach = Vec2::Constant(radius_m_ + 2 * kEndOfContact_m);
  double nearest_m = std::numeric_limits<double>::infinity();
  map_->cells().for_each_box({position_m - reach, position_m + reach}, [&](const Box& cells) {
    nearest_m = std::min(nearest_m, AuditShape(cells).distance_m(position_m.x(), position_m.y()));
    return true;
  });
  return nearest_m;
}

bool SeenContacts::observe(const Pair& pair, double distance_m, double contact_distance_m, double allowance_m,
                           std::int64_t at_ns) {
  if (distance_m > contact_distance_m + kEndOfContact_m) {
    apart_ns(pair) = at_ns;
    if (!observations_.empty()) observations_.erase(pair);
    return false;
  }
  if (distance_m >= contact_distance_m - allowance_m) return false;
  return ++observations_[pair] == kMinObservations;
}

void SeenContacts::on_missed() {
  std::erase_if(observations_, [](const auto& entry) { return entry.second < kMinObservations; });
}

std::vector<SeenContact> SeenContacts::update(const std::vector<VisionSighting>& sights) {
  std::vector<SeenContact> began;
  seen_ = sights.size() + obstacles_.size() + 1;
  apart_ns_.resize(sights.size() * seen_, SeenContact().apart_ns);
  for (std::size_t i = 0; i < sights.size(); ++i) {
    const VisionSighting& a = sights[i];
    for (std::size_t j = i + 1; j < sights.size(); ++j) {
      const VisionSighting& b = sights[j];
      if (!a.is_new && !b.is_new) continue;
      const double later_s =
          (static_cast<double>(b.observed_at_ns) - static_cast<double>(a.observed_at_ns)) * 1e-9;
      if (std::abs(later_s) > kMaxTimeDifference_s) continue;
      // The earlier observation is extrapolated to the time of the later one.
      const Vec2 moved_m = later_s > 0 ? Vec2(a.velocity_mps * later_s) : Vec2(b.velocity_mps * later_s);
      const double distance_m = (a.position_m + moved_m - b.position_m).norm();
      const std::int64_t at_ns = std::max(a.observed_at_ns, b.observed_at_ns);
      if (observe({i, j}, distance_m, 2 * radius_m_, robot_allowance_m(later_s), at_ns))
        began.push_back({i, j, distance_m, apart_ns({i, j})});
    }
    const double allowance_m = std::max(0.0, position_error_m_ - guaranteed_to_obstacle_m_);
    for (std::size_t k = 0; a.is_new && k < obstacles_.size() + (map_ ? 1 : 0); ++k) {
      const double distance_m = k < obstacles_.size()
                                    ? obstacles_[k].distance_m(a.position_m.x(), a.position_m.y())
                                    : distance_from_map_m(a.position_m);
      const Pair pair(i, sights.size() + k);
      if (observe(pair, distance_m, radius_m_, allowance_m, a.observed_at_ns))
        began.push_back({i, std::nullopt, distance_m, apart_ns(pair)});
    }
  }
  return began;
}

}  // namespace sidestep
