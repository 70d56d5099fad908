// SPDX-License-Identifier: Apache-2.0
#include "simulator/league/league_output.hpp"

#include <cerrno>
#include <cstring>

namespace sidestep {

LeagueOutput::LeagueOutput(Bus& bus, const EventReporter& events, const Scenario& scenario,
                           std::span<const CameraView> views, const std::string& endpoint,
                           const std::string& interface, const LeagueTraits& traits)
    : bus_(bus),
      events_(events),
      frames_(scenario, views),
      traits_(traits),
      sender_(league::parse_multicast_endpoint(endpoint), interface) {
  if (traits.counts_from_start) epoch_ = bus.now().time_since_epoch();
  if (traits.geometry_period > Duration::zero()) bus_.at(bus_.now(), [this] { send_geometry(); });
}

void LeagueOutput::send(const msg::DetectionFrame& frame) {
  if (rng_.chance(traits_.loss)) {
    ++lost_;
    return;
  }
  league::VisionPacket packet = frames_.detection(frame, bus_.now());
  packet.detection->captured -= epoch_;
  packet.detection->sent -= epoch_;
  if (traits_.geometry_period == Duration::zero()) packet.geometry = frames_.geometry().geometry;
  send(packet);
}

void LeagueOutput::send(const league::VisionPacket& packet) {
  if (sender_.send(encode(packet)) || sender_.failed() < next_report_) return;
  next_report_ *= 10;
  events_.report(LogLevel::kWarning, {}, "{} league packet(s) not sent so far; last error: {}",
                 sender_.failed(), std::strerror(errno));
}

void LeagueOutput::send_geometry() {
  send(frames_.geometry());
  bus_.at(bus_.now() + traits_.geometry_period, [this] { send_geometry(); });
}

void LeagueOutput::count_drops(DropCounters& drops) const {
  drops.count(DropReason::kUnsentLeaguePacket, std::nullopt, sender_.failed());
  drops.count(DropReason::kInjectedLoss, std::nullopt, lost_);
}

}  // namespace sidestep
