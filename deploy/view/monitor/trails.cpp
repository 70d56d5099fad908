// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor/trails.hpp"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "deploy/view/monitor/floor_frame.hpp"
#include "deploy/view/monitor/unix_time.hpp"

namespace sidestep {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxPoints = 20'000;  // of all robots
constexpr std::size_t kMinSteps = 10, kMaxSteps = 50;

}  // namespace

Json trails_json(const History& history, Time at) {
  std::map<RobotId, Json> points;
  if (!history.empty()) {
    const Time end = std::clamp(at, history.first().at, history.last().at);
    const std::size_t robots = std::max<std::size_t>(places_in(*history.at(end).frame).size(), 1);
    const auto steps = static_cast<int>(std::clamp(kMaxPoints / robots, kMinSteps, kMaxSteps));
    const Snapshot* previous = nullptr;
    for (int i = 0; i <= steps; ++i) {
      const Time moment = end - kTrail + i * (kTrail / steps);
      const Snapshot& snapshot = history.at(moment);
      if (moment < history.first().at || &snapshot == std::exchange(previous, &snapshot)) continue;
      for (const RobotPlace& place : places_in(*snapshot.frame))
        points[place.id].push_back({unix_seconds(snapshot.at), place.position_m.x(), place.position_m.y()});
    }
  }
  Json trails = Json::array();
  for (auto& [id, of_robot] : points) trails.push_back({{"id", id}, {"points", std::move(of_robot)}});
  return {{"robots", std::move(trails)}};
}

}  // namespace sidestep
