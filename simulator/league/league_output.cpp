// SPDX-License-Identifier: Apache-2.0
#include "simulator/league/league_output.hpp"

#include <cerrno>
#include <cstring>

namespace sidestep {
namespace {

constexpr Duration kGeometryPeriod{3'000'000'000};

}  // namespace

LeagueOutput::LeagueOutput(Bus& bus, const Scenario& scenario, SimulatorNode& simulator,
                           const std::string& endpoint, const std::string& interface)
    : bus_(bus),
      events_(simulator.events()),
      frames_(scenario, simulator.cameras().views()),
      sender_(league::parse_multicast_endpoint(endpoint), interface) {
  simulator.set_detection_listener(
      [this](const msg::DetectionFrame& frame) { send(frames_.detection(frame, bus_.now())); });
  simulator.add_drop_source([this](DropCounters& drops) {
    drops.count(DropReason::kUnsentLeaguePacket, std::nullopt, sender_.failed());
  });
  bus_.at(bus_.now(), [this] { send_geometry(); });
}

void LeagueOutput::send(const league::VisionPacket& packet) {
  if (sender_.send(encode(packet)) || sender_.failed() < next_report_) return;
  next_report_ *= 10;
  events_.report(LogLevel::kWarning, {}, "{} league packet(s) not sent so far; last error: {}",
                 sender_.failed(), std::strerror(errno));
}

void LeagueOutput::send_geometry() {
  send(frames_.geometry());
  bus_.at(bus_.now() + kGeometryPeriod, [this] { send_geometry(); });
}

}  // namespace sidestep
