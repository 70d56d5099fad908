// SPDX-License-Identifier: Apache-2.0
#include "agents/tactics/referee_node.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "common/messaging/version_codec.hpp"

namespace sidestep {
namespace {

// False for a NaN.
bool is_plausible(const Vec2& vector, double bound) {
  return std::abs(vector.x()) <= bound && std::abs(vector.y()) <= bound;
}

}  // namespace

RefereeNode::RefereeNode(Bus& bus, const Scenario& scenario, const RefereeSettings& settings)
    : bus_(bus),
      rules_(scenario.field, settings),
      client_(bus, static_cast<ClientId>(Sender::kReferee)),
      heard_at_(bus.now()) {
  client_.on_change([this](const SentOrder& sent) {
    if (sent.phase == OrderPhase::kRefused) warn(bus_.now(), "a coordinator has refused an order");
    // Holds and resumes also replace each other.
    if (sent.phase == OrderPhase::kReplaced && sent.order.kind == msg::OrderKind::ORDER_ZONE)
      warn(bus_.now(), "another referee has replaced a zone");
  });
  bus_.subscribe(topics::kWorld, [this](const msg::WorldState& world) { on_world_state(world); });
  update_periodically();
}

void RefereeNode::warn(Time now, const std::string& text) {
  if (warnings_.admit(now)) events_.report(LogLevel::kWarning, std::nullopt, "{}", text);
}

void RefereeNode::on_datagram(std::span<const std::byte> bytes, const league::Endpoint& from) {
  const Time now = bus_.now();
  const auto decoded = league::decode_referee(bytes);
  if (!decoded.packet) {
    bus_.count_drop(DropReason::kMalformedLeaguePacket);
    return warn(now, fmt::format("rejected a packet from {}: {}", to_text(from), describe(decoded.error)));
  }
  const auto outcome = stream_.add(*decoded.packet, from, now);
  if (outcome == RefereeStream::Outcome::kForeign)
    warn(now, fmt::format("ignored a packet from {}: the referee is {}", to_text(from),
                          to_text(*stream_.referee())));
  if (outcome != RefereeStream::Outcome::kAccepted) return;
  heard_at_ = now;
  is_silent_ = false;
  const league::RefereeCommand command = decoded.packet->command;
  if (!packet_ || packet_->command != command)
    events_.report(LogLevel::kInfo, std::nullopt, "{}", name_of(command));
  packet_ = *decoded.packet;
  if (command == league::RefereeCommand::kHalt) update();
}

void RefereeNode::on_world_state(const msg::WorldState& world) {
  const BallState ball{{world.ball().x_m(), world.ball().y_m()},
                       {world.ball().vx_mps(), world.ball().vy_mps()}};
  const bool is_seen = world.ball().is_visible() && is_plausible(ball.position_m, kMaxCoordinate_m) &&
                       is_plausible(ball.velocity_mps, kMaxSpeed_mps);
  if (is_seen) ball_ = ball;
}

void RefereeNode::update_periodically() {
  bus_.at(bus_.now() + kPeriod, [this] { update_periodically(); });
  report_silence();
  update();
}

void RefereeNode::report_silence() {
  if (is_silent_ || bus_.now() - heard_at_ <= kSilenceTimeout) return;
  is_silent_ = true;
  events_.report(LogLevel::kWarning, std::nullopt, "no packet from the referee for {} s: {}",
                 to_seconds(kSilenceTimeout),
                 packet_ ? fmt::format("{} stays in force", name_of(packet_->command))
                         : std::string("no orders are in force"));
}

void RefereeNode::update() {
  if (!packet_) return;
  const RefereeDemands demands = rules_.demands(*packet_, ball_);
  if (demands.holds && is_held_ != true) client_.hold(kAllRobots);
  for (const std::uint32_t number : kRefereeZones) update_zone(number, demands);
  if (!demands.holds && is_held_ != false) client_.resume(kAllRobots);
  is_held_ = demands.holds;
}

void RefereeNode::update_zone(std::uint32_t number, const RefereeDemands& demands) {
  const auto wanted = demands.zones.find(number);
  const auto ordered = zones_.find(number);
  if (wanted == demands.zones.end()) {
    if (ordered != zones_.end() && !ordered->second) return;
    client_.remove_zone(number);
    zones_[number] = std::nullopt;
  } else if (ordered == zones_.end() || !ordered->second || !are_close(*ordered->second, wanted->second)) {
    client_.zone(number, wanted->second);
    zones_[number] = wanted->second;
  }
}

}  // namespace sidestep
