// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/laser_scan_decoder.hpp"

#include <algorithm>
#include <cmath>

#include "common/messaging/version_codec.hpp"

namespace sidestep {

LaserScanDecoder::LaserScanDecoder(RobotId robot, const LaserSettings& laser)
    : robot_(robot), laser_(laser), ranges_m_(static_cast<std::size_t>(laser.beams)) {}

bool LaserScanDecoder::is_possible(const msg::LaserScan& message, Time now) const {
  const bool is_of_laser = message.ranges_m().size() == ranges_m_.size() &&
                           message.field_of_view_rad() == laser_.field_of_view_rad &&
                           message.min_range_m() == laser_.min_range_m &&
                           message.max_range_m() == laser_.max_range_m;
  // The comparisons are false for NaN.
  return message.robot() == robot_ && message.header().sender() == robot_ && is_of_laser &&
         std::abs(message.x_m()) <= kMaxCoordinate_m && std::abs(message.y_m()) <= kMaxCoordinate_m &&
         std::isfinite(message.heading_rad()) && is_plausible(time_from_ns(message.captured_at_ns()), now);
}

std::optional<LaserScan> LaserScanDecoder::decode(const msg::LaserScan& message, Time now) {
  if (!is_possible(message, now)) return std::nullopt;
  std::ranges::copy(message.ranges_m(), ranges_m_.begin());
  return LaserScan{{message.x_m(), message.y_m()},
                   message.heading_rad(),
                   time_from_ns(message.captured_at_ns()),
                   ranges_m_};
}

}  // namespace sidestep
