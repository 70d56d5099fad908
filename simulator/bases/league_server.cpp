// SPDX-License-Identifier: Apache-2.0
#include "simulator/bases/league_server.hpp"

namespace sidestep {

LeagueServer::LeagueServer(VelocityRobotSimNode& node, const LeagueServerPorts& ports,
                           const LeagueServerSettings& settings)
    : node_(node),
      settings_(settings),
      control_(ports.control),
      blue_(ports.blue),
      yellow_(ports.yellow),
      blue_answers_(settings.packets_per_answer),
      yellow_answers_(settings.packets_per_answer) {
  node.add_drop_source([this](DropCounters& drops) {
    drops.count(DropReason::kMalformedLeaguePacket, std::nullopt, malformed_);
    drops.count(DropReason::kInjectedLoss, std::nullopt, lost_);
    drops.count(DropReason::kUnsentLeaguePacket, std::nullopt,
                control_.failed() + blue_.failed() + yellow_.failed());
  });
}

void LeagueServer::start(const std::function<void(int, std::function<void()>)>& watch) {
  watch(control_.descriptor(), [this] { receive_control(); });
  watch(blue_.descriptor(), [this] { receive_team(Team::kBlue, blue_, blue_answers_); });
  watch(yellow_.descriptor(), [this] { receive_team(Team::kYellow, yellow_, yellow_answers_); });
}

template <typename Packet>
bool LeagueServer::accept(const league::Decoded<Packet>& decoded, const league::Endpoint& from) {
  if (decoded.packet) return true;
  if (++malformed_ >= next_report_) {
    next_report_ *= 10;
    node_.events().report(LogLevel::kWarning, {}, "{} packet(s) rejected so far; latest, from {}: {}",
                          malformed_, to_text(from), describe(decoded.error));
  }
  return false;
}

void LeagueServer::receive_team(Team team, league::UnicastSocket& socket, AnswerBatch& answers) {
  BaseWorld& world = node_.world_now();
  socket.receive([&](std::span<const std::byte> datagram, const league::Endpoint& from) {
    if (rng_.chance(settings_.loss)) {
      ++lost_;
      return;
    }
    const auto commands = league::decode_team_commands(datagram);
    if (!accept(commands, from)) return;
    const auto response = LeagueCommands(world, settings_.accepts_global)
                              .on_team(team, *commands.packet, node_.simulated_now());
    // Failures are counted by the socket.
    if (const auto answer = answers.add(response)) (void)socket.send(encode(*answer), from);
  });
}

void LeagueServer::receive_control() {
  BaseWorld& world = node_.world_now();
  control_.receive([&](std::span<const std::byte> datagram, const league::Endpoint& from) {
    const auto command = league::decode_simulator_command(datagram);
    if (!accept(command, from)) return;
    std::optional<double> speed;
    const auto response = LeagueCommands(world, settings_.accepts_global).on_control(*command.packet, speed);
    if (speed) node_.set_speed(*speed);
    (void)control_.send(encode(response), from);  // failures are counted by the socket
  });
}

}  // namespace sidestep
