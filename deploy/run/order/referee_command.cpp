// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/order/referee_command.hpp"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <memory>
#include <string>

#include "common/geometry/coordinate_bound.hpp"
#include "common/league/multicast.hpp"
#include "common/league/referee_packet.hpp"
#include "common/messaging/dds/event_loop.hpp"
#include "common/process/exit_code.hpp"
#include "common/process/stop_signals.hpp"
#include "deploy/run/order/goal_text.hpp"

namespace sidestep {
namespace {

constexpr Duration kPacketPeriod = std::chrono::milliseconds(100);

struct PlayedReferee {
  std::string endpoint = league::kRefereeEndpoint;
  std::string interface = league::kLeagueInterface;
  league::RefereePacket packet;
};

/// Parses the name of a command. Throws UsageError if the referee has no such command.
league::RefereeCommand parse_command(const std::string& text) {
  std::string names;
  for (std::size_t i = 0; i < league::kRefereeCommands; ++i) {
    const auto command = static_cast<league::RefereeCommand>(i);
    if (name_of(command) == text) return command;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", name_of(command));
  }
  throw UsageError(fmt::format("\"{}\" is not a command of the referee: expected one of {}", text, names));
}

/// Parses a place within kMaxCoordinate_m. Throws UsageError.
Vec2 parse_ball_place(const std::string& text) {
  const Vec2 place_m = parse_place(text, "place for the ball");
  if (place_m.cwiseAbs().maxCoeff() <= kMaxCoordinate_m) return place_m;
  throw UsageError(fmt::format("\"{}\": expected coordinates from {:g} to {:g} m", text, -kMaxCoordinate_m,
                               kMaxCoordinate_m));
}

int play(PlayedReferee& referee) {
  league::MulticastSender sender(league::parse_multicast_endpoint(referee.endpoint), referee.interface);
  EventLoop loop;
  const StopSignals stop_signals([&loop] { loop.stop(); });
  referee.packet.commanded = Duration{to_ns(EventLoop::now())};
  const std::function<void()> send = [&] {
    referee.packet.sent = Duration{to_ns(EventLoop::now())};
    (void)sender.send(encode(referee.packet));  // failures are reported at the end
    loop.at(EventLoop::now() + kPacketPeriod, send);
  };
  send();
  fmt::print(stderr, "sidestep referee: {} to {}, stop with SIGINT\n", name_of(referee.packet.command),
             referee.endpoint);
  loop.run_until(Time::max());
  if (sender.failed() == 0) return 0;
  fmt::print(stderr, "sidestep referee: {} of {} packets could not be sent\n", sender.failed(),
             sender.sent() + sender.failed());
  return kExitFailure;
}

}  // namespace

void add_referee_command(const CliCommand& root, std::function<int()>& action) {
  const auto referee = std::make_shared<PlayedReferee>();
  const CliCommand command = root.add_subcommand(
      "referee", "Plays the Small Size League's referee: repeats one command until Ctrl-C");
  command
      .add_option(
          "COMMAND", [referee](const std::string& text) { referee->packet.command = parse_command(text); },
          "e.g. HALT, STOP, FORCE_START or BALL_PLACEMENT_BLUE")
      .required();
  command.add_option(
      "--place",
      [referee](const std::string& text) { referee->packet.designated_position_m = parse_ball_place(text); },
      "X,Y in metres: where the ball is to be placed");
  command.add_option("--referee", referee->endpoint, "ADDRESS:PORT to send the packets to").show_default();
  command.add_option("--league-interface", referee->interface, "address of the network interface to use")
      .show_default();
  command.on_parsed([referee, &action] { action = [referee] { return play(*referee); }; });
}

}  // namespace sidestep
