// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/picture/opponent_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace sidestep {
namespace {

constexpr double kSamePoint_m = 0.001;
constexpr std::size_t kMaxCorners = 2000;

/// One round of the opponent: the corners until it is at the first one again.
std::vector<Vec2> round_of(const OpponentSpec& opponent) {
  std::vector<Vec2> corners = opponent.path_m;
  const bool is_loop = corners.size() > 2 && (corners.back() - corners.front()).norm() < kSamePoint_m;
  if (!is_loop)
    for (std::size_t i = opponent.path_m.size() - 1; i-- > 0;) corners.push_back(opponent.path_m[i]);
  return corners;
}

}  // namespace

std::vector<FloorTrace::Point> opponent_path(const OpponentSpec& opponent, double from_s, double to_s) {
  const std::vector<Vec2> corners = round_of(opponent);
  std::vector<double> at_s{0};  // times of the corners in the first round
  for (std::size_t i = 1; i < corners.size(); ++i)
    at_s.push_back(at_s.back() + (corners[i] - corners[i - 1]).norm() / opponent.speed_mps);
  const double round_s = at_s.back();
  if (!(round_s > 0) || !std::isfinite(round_s))
    return {{from_s, corners.front(), 0}, {to_s, corners.front(), 0}};
  std::vector<FloorTrace::Point> round;
  for (std::size_t i = 0; i < corners.size(); ++i) round.push_back({at_s[i], corners[i], opponent.speed_mps});
  const auto place = [&](double time_s) {
    return position_at(round, time_s - round_s * std::floor(time_s / round_s));
  };
  std::vector<FloorTrace::Point> path{{from_s, place(from_s), opponent.speed_mps}};
  // Rounds are counted because adding a short round to a large time would not advance it.
  const double first_round = std::floor(from_s / round_s);
  const std::size_t turns = corners.size() - 1;
  for (std::size_t i = 0; i < turns + kMaxCorners; ++i) {
    const double round_number = first_round + static_cast<double>(i / turns);
    const std::size_t corner = 1 + i % turns;
    const double time_s = std::max(round_s * round_number + at_s[corner], path.back().at_s);
    if (time_s >= to_s) break;
    if (time_s > from_s) path.push_back({time_s, corners[corner], opponent.speed_mps});
  }
  path.push_back({to_s, place(to_s), opponent.speed_mps});
  return path;
}

std::string svg_opponents(const FloorTrace& trace, const FloorView& view, const RunTiming& timing) {
  std::string svg;
  for (const OpponentSpec& opponent : trace.opponents) {
    svg +=
        svg_polyline(view, opponent.path_m,
                     fmt::format("stroke='{}' stroke-opacity='0.6' stroke-width='1.5' stroke-dasharray='6 5'",
                                 kOpponentColour));
    const double since_s = trace.opponents_since_s.value_or(0);
    std::vector<TimedPlace> places;
    if (trace.opponents_since_s && timing.plays()) {
      for (const FloorTrace::Point& point :
           opponent_path(opponent, timing.begin_s - since_s, timing.end_s - since_s))
        places.push_back({since_s + point.at_s, view.px(point.position_m)});
    } else {
      places.push_back({0, view.px(opponent.path_m.front())});
    }
    const Vec2 end = places.back().px;
    svg += fmt::format(
        "<g transform='translate({:.1f},{:.1f})'><circle r='{:.1f}' fill='{}' fill-opacity='0.6'/>{}</g>\n",
        end.x(), end.y(), view.px(opponent.radius_m), kOpponentColour,
        places.size() > 1 ? svg_motion(timing, places) : "");
  }
  return svg;
}

}  // namespace sidestep
