// SPDX-License-Identifier: Apache-2.0
#include "vision/league/league_source.hpp"

#include <algorithm>
#include <numeric>

namespace sidestep {
namespace {

constexpr std::size_t kMostSenders = 16;
/// Robots are at most 180 mm wide.
constexpr double kLeagueRadius_m = 0.09;

std::size_t index_of(Team team) { return team == Team::kBlue ? 0 : 1; }

}  // namespace

LeagueSource::LeagueSource(const Scenario& scenario) {
  require_own_numbers(scenario);
  for (const RobotSpec& robot : scenario.robots) ids_[index_of(robot.team)][number_of(robot.id)] = robot.id;
  senders_.reserve(kMostSenders);
}

std::uint64_t LeagueSource::refused() const {
  return std::accumulate(counts_.refused.begin(), counts_.refused.end(), std::uint64_t{0});
}

std::uint64_t LeagueSource::clock_jumps() const {
  std::uint64_t sum = 0;
  for (const Sender& sender : senders_) sum += sender.clock.jumps();
  return sum;
}

const msg::DetectionFrame* LeagueSource::take(std::span<const std::byte> datagram,
                                              const league::Endpoint& from, Time now) {
  ++counts_.packets;
  const auto decoded = league::decode_vision(datagram);
  refusal_ = decoded.refusal;
  if (!decoded.packet) {
    ++counts_.refused[static_cast<std::size_t>(refusal_)];
    return nullptr;
  }
  if (decoded.packet->geometry) field_ = decoded.packet->geometry->field;
  if (!decoded.packet->detection) return nullptr;

  const league::Detection& detection = *decoded.packet->detection;
  Sender& who = sender(from, now);
  if (is_doubled(who, detection)) {
    ++counts_.doubled;
    return nullptr;
  }
  const auto captured_at = who.clock.add(detection.captured, detection.sent, now);
  if (!captured_at) {
    ++counts_.undated;
    return nullptr;
  }
  fill(detection, *captured_at);
  ++counts_.frames;
  return &frame_;
}

LeagueSource::Sender& LeagueSource::sender(const league::Endpoint& endpoint, Time now) {
  auto found = std::find_if(senders_.begin(), senders_.end(),
                            [&](const Sender& sender) { return sender.endpoint == endpoint; });
  if (found == senders_.end() && senders_.size() < kMostSenders) {
    found = senders_.insert(senders_.end(), Sender{endpoint});
  } else if (found == senders_.end()) {
    found = std::min_element(senders_.begin(), senders_.end(),
                             [](const Sender& a, const Sender& b) { return a.heard < b.heard; });
    *found = Sender{endpoint};
  }
  found->heard = now;
  return *found;
}

bool LeagueSource::is_doubled(Sender& sender, const league::Detection& detection) {
  const FrameKey key{detection.camera, detection.frame_number, detection.captured};
  if (std::find(sender.recent.begin(), sender.recent.end(), key) != sender.recent.end()) return true;
  sender.recent[sender.next_recent] = key;
  sender.next_recent = (sender.next_recent + 1) % sender.recent.size();
  return false;
}

void LeagueSource::fill(const league::Detection& detection, Time captured_at) {
  frame_.camera(detection.camera);
  frame_.captured_at_ns(to_ns(captured_at));
  frame_.robots().clear();
  frame_.obstacle_count(0);
  for (const league::SeenRobot& robot : detection.yellow) add(Team::kYellow, robot);
  for (const league::SeenRobot& robot : detection.blue) add(Team::kBlue, robot);
  add_balls(detection.balls);
}

void LeagueSource::add(Team team, const league::SeenRobot& robot) {
  const auto id = robot.number ? ids_[index_of(team)][*robot.number] : std::nullopt;
  if (!id) return add_obstacle(robot.position_m);
  if (!robot.heading_rad) {
    ++counts_.detections;
    return;
  }
  msg::RobotDetection seen;
  seen.robot(*id);
  seen.x_m(robot.position_m.x());
  seen.y_m(robot.position_m.y());
  seen.heading_rad(*robot.heading_rad);
  seen.confidence(robot.confidence);
  frame_.robots().push_back(seen);
}

void LeagueSource::add_obstacle(const Vec2& position_m) {
  const std::uint8_t count = frame_.obstacle_count();
  if (count == msg::MAX_OBSTACLES) {
    ++counts_.detections;
    return;
  }
  msg::ObstacleDetection& seen = frame_.obstacles()[count];
  seen.x_m(position_m.x());
  seen.y_m(position_m.y());
  seen.radius_m(kLeagueRadius_m);
  frame_.obstacle_count(static_cast<std::uint8_t>(count + 1));
}

void LeagueSource::add_balls(std::span<const league::SeenBall> balls) {
  by_confidence_.clear();
  for (const league::SeenBall& ball : balls) by_confidence_.push_back(&ball);
  const std::size_t count = std::min<std::size_t>(balls.size(), msg::MAX_DETECTED_BALLS);
  counts_.detections += balls.size() - count;
  std::stable_sort(by_confidence_.begin(), by_confidence_.end(),
                   [](const auto* a, const auto* b) { return a->confidence > b->confidence; });
  for (std::size_t i = 0; i < count; ++i) {
    msg::BallDetection& seen = frame_.balls()[i];
    seen.x_m(by_confidence_[i]->position_m.x());
    seen.y_m(by_confidence_[i]->position_m.y());
    seen.confidence(by_confidence_[i]->confidence);
  }
  frame_.ball_count(static_cast<std::uint8_t>(count));
}

}  // namespace sidestep
