// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/league/league_driver.hpp"

namespace sidestep {

LeagueDriver::LeagueDriver(const Scenario& scenario, const std::vector<RobotId>& robots,
                           const LeaguePorts& ports)
    : ports_(ports) {
  require_unique_numbers(scenario);
  for (const RobotId id : robots) names_[id] = {find_robot(scenario, id)->team, number_in_team(id)};
}

void LeagueDriver::send(std::span<const BaseCommand> commands) {
  for (league::TeamCommands& packet : packets_) packet.robots.clear();
  for (const BaseCommand& command : commands) {
    const Name& name = names_.at(command.robot);
    league::RobotCommand robot;
    robot.number = name.number;
    robot.move = {league::RobotMove::Kind::kLocal, command.velocity.linear_mps, command.velocity.turn_radps};
    packets_[static_cast<std::size_t>(name.team)].robots.push_back(robot);
  }
  for (const Team team : {Team::kBlue, Team::kYellow}) {
    const league::TeamCommands& packet = packets_[static_cast<std::size_t>(team)];
    // A datagram that cannot be sent is counted; the next datagram replaces it.
    if (!packet.robots.empty())
      (void)socket_.send(encode(packet), team == Team::kBlue ? ports_.blue : ports_.yellow);
  }
}

void LeagueDriver::receive() {
  socket_.receive([this](std::span<const std::byte> datagram, const league::Endpoint& from) {
    if (from != ports_.blue && from != ports_.yellow) {
      ++malformed_;
      return;
    }
    const auto answer = league::decode_team_response(datagram);
    if (!answer.packet) {
      ++malformed_;
      return;
    }
    ++answers_;
    for (const league::SimulatorError& error : answer.packet->errors) report_error(error, from);
  });
}

void LeagueDriver::report_error(const league::SimulatorError& error, const league::Endpoint& from) {
  if (++errors_ < next_error_report_) return;
  next_error_report_ *= 10;
  events_.report(LogLevel::kWarning, {}, "{} error(s) received so far; latest, from {}: {} {}", errors_,
                 to_text(from), error.code, error.message);
}

void LeagueDriver::count_drops(DropCounters& drops) const {
  drops.count(DropReason::kMalformedLeaguePacket, std::nullopt, malformed_);
  drops.count(DropReason::kUnsentLeaguePacket, std::nullopt, socket_.failed());
  drops.count(DropReason::kRejectedByBase, std::nullopt, errors_);
}

}  // namespace sidestep
