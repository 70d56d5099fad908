// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/ending.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <utility>

#include "common/protocol/moving_text.hpp"

namespace sidestep {
namespace {

/// Minimum time over which a speed is measured.
constexpr Duration kSpeedTime = std::chrono::milliseconds(100);

}  // namespace

bool RestWatch::see(const RobotSighting& sighting, double tolerance_m) {
  if (sighting.at <= last_.at) return false;
  last_ = sighting;
  const double distance_m = (last_.position_m - anchor_.position_m).norm();
  // A position that is not finite never agrees.
  if (!(distance_m <= tolerance_m)) anchor_ = last_;
  const Duration elapsed = last_.at - earlier_.at;
  if (elapsed >= kSpeedTime) {
    speed_mps_ = (last_.position_m - earlier_.position_m).norm() / to_seconds(elapsed);
    earlier_ = last_;
  }
  return true;
}

Ending::Ending(const EndingSettings& settings, Time begin)
    : settings_(settings), step_ends_by_(begin + settings.time_to_rest + kGrace), heard_at_(begin) {}

void Ending::see(Time now, std::span<const RobotSighting> sightings) {
  if (!std::exchange(has_begun_, true)) {
    Time latest = Time::min();
    for (const RobotSighting& sighting : sightings) latest = std::max(latest, sighting.at);
    for (const RobotSighting& sighting : sightings) {
      if (latest - sighting.at <= kMaxSilence) robots_.emplace(sighting.robot, RestWatch(sighting));
    }
  }
  std::erase_if(robots_, [&](const auto& watched) {
    return std::ranges::find(sightings, watched.first, &RobotSighting::robot) == sightings.end();
  });
  for (const RobotSighting& sighting : sightings) {
    const auto found = robots_.find(sighting.robot);
    if (found != robots_.end() && found->second.see(sighting, settings_.tolerance_m)) heard_at_ = now;
  }
  is_blind_ = is_blind(now);
}

Ending::Step Ending::update(Time now, std::span<const RobotSighting> sightings,
                            const MovingProcesses& running) {
  see(now, sightings);
  const bool is_settled = robots_.empty() || is_blind_ || moving_robots().empty();
  if (step_ == Step::kRobotsStop && ((is_settled && !running.agents) || now >= step_ends_by_)) {
    step_ = Step::kDriversEnd;
    step_ends_by_ = now + settings_.time_to_rest + kGrace;
  }
  if (step_ == Step::kDriversEnd && !running.drivers && is_settled) step_ = Step::kOver;
  if (step_ == Step::kDriversEnd && now >= step_ends_by_) step_ = Step::kOver;
  return step_;
}

std::vector<RobotId> Ending::moving_robots() const {
  std::vector<RobotId> moving;
  for (const auto& [robot, watch] : robots_) {
    if (!watch.is_at_rest()) moving.push_back(robot);
  }
  return moving;
}

std::string Ending::problem() const {
  const std::vector<RobotId> moving = moving_robots();
  if (moving.empty()) return {};
  double fastest_mps = 0;
  for (const RobotId robot : moving) fastest_mps = std::max(fastest_mps, robots_.at(robot).speed_mps());
  const char* const up_to = moving.size() == 1 ? "" : "up to ";
  if (is_blind_)
    return fmt::format("nobody saw robot{} {} come to rest from {}{:.2f} m/s", moving.size() == 1 ? "" : "s",
                       fmt::join(moving, ", "), up_to, fastest_mps);
  return fmt::format("{} at {}{:.2f} m/s", still_moving_text(moving), up_to, fastest_mps);
}

}  // namespace sidestep
