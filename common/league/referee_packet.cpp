// SPDX-License-Identifier: Apache-2.0
#include "common/league/referee_packet.hpp"

#include <array>

#include "common/league/packet_validator.hpp"
#include "common/league/wire.hpp"

#include "league/referee.pb.h"

namespace sidestep::league {
namespace {

constexpr double kMetres = 0.001;  // metres per millimetre
constexpr double kSeconds = 1e-6;  // seconds per microsecond
constexpr std::int32_t kFirstHalf = 1;

constexpr std::array<std::string_view, kRefereeCommands> kNames{"HALT",
                                                                "STOP",
                                                                "NORMAL_START",
                                                                "FORCE_START",
                                                                "PREPARE_KICKOFF_YELLOW",
                                                                "PREPARE_KICKOFF_BLUE",
                                                                "PREPARE_PENALTY_YELLOW",
                                                                "PREPARE_PENALTY_BLUE",
                                                                "DIRECT_FREE_YELLOW",
                                                                "DIRECT_FREE_BLUE",
                                                                "INDIRECT_FREE_YELLOW",
                                                                "INDIRECT_FREE_BLUE",
                                                                "TIMEOUT_YELLOW",
                                                                "TIMEOUT_BLUE",
                                                                "GOAL_YELLOW",
                                                                "GOAL_BLUE",
                                                                "BALL_PLACEMENT_YELLOW",
                                                                "BALL_PLACEMENT_BLUE"};

std::uint64_t microseconds(Duration time) {
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::microseconds>(time).count());
}

RefereeCommand command_of(std::int32_t number, PacketValidator& validator) {
  const bool is_known = number >= 0 && static_cast<std::size_t>(number) < kRefereeCommands;
  validator.require(is_known, DecodeError::kCommand);
  return is_known ? static_cast<RefereeCommand>(number) : RefereeCommand::kHalt;
}

void write_team(wire::referee::TeamInfo& to) {
  to.set_name("");
  to.set_score(0);
  to.set_red_cards(0);
  to.set_yellow_cards(0);
  to.set_timeouts(0);
  to.set_timeout_time(0);
  to.set_goalkeeper(0);
}

}  // namespace

std::string_view name_of(RefereeCommand command) { return kNames[static_cast<std::size_t>(command)]; }

std::optional<Team> team_of(RefereeCommand command) {
  if (command < RefereeCommand::kPrepareKickoffYellow) return std::nullopt;
  return static_cast<unsigned>(command) % 2 == 0 ? Team::kYellow : Team::kBlue;
}

std::vector<std::byte> encode(const RefereePacket& packet) {
  wire::referee::Packet message;
  message.set_packet_timestamp(microseconds(packet.sent));
  message.set_stage(kFirstHalf);
  message.set_command(static_cast<std::int32_t>(packet.command));
  message.set_command_counter(packet.command_counter);
  message.set_command_timestamp(microseconds(packet.commanded));
  write_team(*message.mutable_yellow());
  write_team(*message.mutable_blue());
  if (packet.designated_position_m) {
    auto& point = *message.mutable_designated_position();
    point.set_x(static_cast<float>(packet.designated_position_m->x() / kMetres));
    point.set_y(static_cast<float>(packet.designated_position_m->y() / kMetres));
  }
  return bytes_of(message);
}

Decoded<RefereePacket> decode_referee(std::span<const std::byte> bytes) {
  wire::referee::Packet message;
  if (const DecodeError error = parse(bytes, message); error != DecodeError::kNone) return {{}, error};
  PacketValidator validator;
  RefereePacket packet;
  packet.sent = validator.time(kSeconds * static_cast<double>(message.packet_timestamp()));
  packet.command = command_of(message.command(), validator);
  packet.command_counter = message.command_counter();
  packet.commanded = validator.time(kSeconds * static_cast<double>(message.command_timestamp()));
  if (message.has_designated_position()) {
    const auto& point = message.designated_position();
    packet.designated_position_m = Vec2(validator.within(kMetres * point.x(), kMaxCoordinate_m),
                                        validator.within(kMetres * point.y(), kMaxCoordinate_m));
  }
  if (!validator.is_valid()) return {{}, validator.error()};
  return {packet, DecodeError::kNone};
}

}  // namespace sidestep::league
