// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/picture/run_timing.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

#include "common/svg/axis.hpp"

namespace sidestep {
namespace {

constexpr double kMaxPlayed_s = 30;  // longer runs play faster

}  // namespace

double RunTiming::share(double at_s) const {
  return std::clamp((at_s - begin_s) / speed / round_s(), 0.0, 1.0);
}

RunTiming timing_of(const FloorTrace& trace) {
  double begin_s = std::numeric_limits<double>::infinity(), end_s = -begin_s;
  for (const FloorTrace::Robot& robot : trace.robots) {
    if (robot.path.empty()) continue;
    begin_s = std::min(begin_s, robot.path.front().at_s);
    end_s = std::max(end_s, robot.path.back().at_s);
  }
  if (!(begin_s < end_s)) return {};
  // Before the first grant nothing moves.
  if (end_s > 0) begin_s = std::max(begin_s, 0.0);
  const double played_s = end_s - begin_s;
  return {begin_s, end_s, played_s > kMaxPlayed_s ? round_step(played_s / kMaxPlayed_s) : 1};
}

Vec2 position_at(const std::vector<FloorTrace::Point>& path, double at_s) {
  const auto after = std::ranges::upper_bound(path, at_s, {}, &FloorTrace::Point::at_s);
  if (after == path.begin()) return path.front().position_m;
  if (after == path.end()) return path.back().position_m;
  const FloorTrace::Point &from = *std::prev(after), &to = *after;
  const double share = (at_s - from.at_s) / (to.at_s - from.at_s);
  return from.position_m + share * (to.position_m - from.position_m);
}

std::string animation_attributes(const RunTiming& timing, const std::vector<double>& at_s,
                                 const std::vector<std::string>& values) {
  std::string keys = "0";
  for (std::size_t i = 1; i < at_s.size(); ++i) keys += fmt::format(";{:.5g}", timing.share(at_s[i]));
  std::string text;
  for (const std::string& value : values) text += value + ";";
  return fmt::format("values='{}{}' keyTimes='{};1' dur='{:.2f}s' repeatCount='indefinite'", text,
                     values.back(), keys, timing.round_s());
}

std::string svg_motion(const RunTiming& timing, const std::vector<TimedPlace>& places) {
  std::vector<double> at_s;
  std::vector<std::string> values;
  for (const TimedPlace& place : places) {
    at_s.push_back(place.at_s);
    values.push_back(fmt::format("{:.1f},{:.1f}", place.px.x(), place.px.y()));
  }
  return fmt::format("<animateTransform attributeName='transform' type='translate' {}/>\n",
                     animation_attributes(timing, at_s, values));
}

}  // namespace sidestep
