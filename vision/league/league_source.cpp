// SPDX-License-Identifier: Apache-2.0
#include "vision/league/league_source.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "common/messaging/detected_obstacles.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kMaxSenders = 16;
/// Radius of a league robot; the rules limit the diameter to 180 mm.
constexpr double kLeagueRadius_m = 0.09;

std::size_t index_of(Team team) { return team == Team::kBlue ? 0 : 1; }

}  // namespace

LeagueSource::LeagueSource(const Scenario& scenario, std::vector<league::Endpoint> senders)
    : choice_(std::move(senders)) {
  require_unique_numbers(scenario);
  for (const RobotSpec& robot : scenario.robots)
    ids_[index_of(robot.team)][number_in_team(robot.id)] = robot.id;
  senders_.reserve(kMaxSenders);
}

std::uint64_t LeagueSource::rejected() const {
  return std::accumulate(counts_.rejected.begin(), counts_.rejected.end(), std::uint64_t{0});
}

void LeagueSource::count_drops(DropCounters& drops) const {
  drops.count(DropReason::kMalformedLeaguePacket, std::nullopt, rejected());
  drops.count(DropReason::kRepeatedLeagueFrame, std::nullopt, counts_.duplicates);
  drops.count(DropReason::kUndatedLeagueFrame, std::nullopt, counts_.unsynchronised);
  drops.count(DropReason::kUnusedLeagueDetection, std::nullopt, counts_.dropped);
  drops.count(DropReason::kOtherLeagueSender, std::nullopt, choice_.refused_packets());
}

std::uint64_t LeagueSource::clock_jumps() const {
  std::uint64_t sum = 0;
  for (const Sender& sender : senders_) sum += sender.clock.jumps();
  return sum;
}

const msg::DetectionFrame* LeagueSource::decode(std::span<const std::byte> datagram,
                                                const league::Endpoint& endpoint, Time now) {
  ++counts_.packets;
  const auto decoded = league::decode_vision(datagram);
  error_ = decoded.error;
  if (!decoded.packet) {
    ++counts_.rejected[static_cast<std::size_t>(error_)];
    return nullptr;
  }
  if (!choice_.admit(endpoint, now)) return nullptr;
  if (decoded.packet->geometry) field_ = decoded.packet->geometry->field;
  if (!decoded.packet->detection) return nullptr;

  const league::DetectionFrame& detection = *decoded.packet->detection;
  Sender& sender = sender_at(endpoint, now);
  if (is_duplicate(sender, detection)) {
    ++counts_.duplicates;
    return nullptr;
  }
  latest_ = static_cast<std::size_t>(&sender - senders_.data());
  const auto dated = sender.clock.add(detection.captured, detection.sent, now);
  if (!dated || dated->uncertainty > SenderClock::kMaxUncertainty) {
    ++counts_.unsynchronised;
    return nullptr;
  }
  date_uncertainty_ = dated->uncertainty;
  fill_frame(detection, dated->captured_at);
  ++counts_.frames;
  return &frame_;
}

LeagueSource::Sender& LeagueSource::sender_at(const league::Endpoint& endpoint, Time now) {
  auto found = std::find_if(senders_.begin(), senders_.end(),
                            [&](const Sender& sender) { return sender.endpoint == endpoint; });
  if (found == senders_.end() && senders_.size() < kMaxSenders) {
    found = senders_.insert(senders_.end(), Sender{endpoint});
  } else if (found == senders_.end()) {
    found = std::min_element(senders_.begin(), senders_.end(), [](const Sender& a, const Sender& b) {
      return a.last_received < b.last_received;
    });
    *found = Sender{endpoint};
  }
  found->last_received = now;
  return *found;
}

bool LeagueSource::is_duplicate(Sender& sender, const league::DetectionFrame& detection) {
  const FrameKey key{detection.camera, detection.frame_number, detection.captured};
  if (std::find(sender.recent.begin(), sender.recent.end(), key) != sender.recent.end()) return true;
  sender.recent[sender.next_recent] = key;
  sender.next_recent = (sender.next_recent + 1) % sender.recent.size();
  return false;
}

void LeagueSource::fill_frame(const league::DetectionFrame& detection, Time captured_at) {
  frame_.camera(detection.camera);
  frame_.captured_at_ns(to_ns(captured_at));
  frame_.robots().clear();
  obstacles_.clear();
  for (const league::DetectedRobot& robot : detection.yellow) add_robot(Team::kYellow, robot);
  for (const league::DetectedRobot& robot : detection.blue) add_robot(Team::kBlue, robot);
  set_obstacles(obstacles_, frame_);
  counts_.dropped += obstacles_.size() - frame_.obstacle_count();
  add_balls(detection.balls);
}

void LeagueSource::add_robot(Team team, const league::DetectedRobot& robot) {
  const auto id = robot.number ? ids_[index_of(team)][*robot.number] : std::nullopt;
  if (!id) {
    obstacles_.push_back({robot.position_m, kLeagueRadius_m});
    return;
  }
  if (!robot.heading_rad) {
    ++counts_.dropped;
    return;
  }
  msg::RobotDetection converted;
  converted.robot(*id);
  converted.x_m(robot.position_m.x());
  converted.y_m(robot.position_m.y());
  converted.heading_rad(*robot.heading_rad);
  converted.confidence(robot.confidence);
  frame_.robots().push_back(converted);
}

void LeagueSource::add_balls(std::span<const league::DetectedBall> balls) {
  by_confidence_.clear();
  for (const league::DetectedBall& ball : balls) by_confidence_.push_back(&ball);
  const std::size_t count = std::min<std::size_t>(balls.size(), msg::MAX_DETECTED_BALLS);
  counts_.dropped += balls.size() - count;
  std::stable_sort(by_confidence_.begin(), by_confidence_.end(),
                   [](const auto* a, const auto* b) { return a->confidence > b->confidence; });
  for (std::size_t i = 0; i < count; ++i) {
    msg::BallDetection& ball = frame_.balls()[i];
    ball.x_m(by_confidence_[i]->position_m.x());
    ball.y_m(by_confidence_[i]->position_m.y());
    ball.confidence(by_confidence_[i]->confidence);
  }
  frame_.ball_count(static_cast<std::uint8_t>(count));
}

}  // namespace sidestep
