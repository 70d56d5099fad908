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
      begin_(bus.now()),
      sender_(league::parse_multicast_endpoint(endpoint), interface) {
  if (traits.geometry_period > Duration::zero()) bus_.at(bus_.now(), [this] { send_geometry(); });
}

void LeagueOutput::send(const msg::DetectionFrame& frame) {
  send(frame, {time_from_ns(frame.captured_at_ns()) - begin_, bus_.now() - begin_});
}

void LeagueOutput::send(const msg::DetectionFrame& frame, const FrameStamps& simulated) {
  if (rng_.chance(traits_.loss)) {
    ++lost_;
    return;
  }
  const Time now = bus_.now();
  league::VisionPacket packet = frames_.detection(frame, now);
  const FrameStamps real{Duration{frame.captured_at_ns()}, now.time_since_epoch()};
  const FrameStamps times = packet_times(traits_.times, real, simulated);
  packet.detection->captured = times.captured;
  packet.detection->sent = times.sent;
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
