// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/league/league_driver.hpp"

#include <map>
#include <poll.h>

#include "tests/catch.hpp"
#include "tests/test_endpoint.hpp"

namespace sidestep::league_driver_test {
namespace {

Scenario two_teams() {
  Scenario scenario;
  for (const auto& [id, team] :
       {std::pair(0u, Team::kBlue), std::pair(3u, Team::kBlue), std::pair(16u, Team::kYellow)}) {
    RobotSpec robot;
    robot.id = id;
    robot.team = team;
    scenario.robots.push_back(robot);
  }
  return scenario;
}

/// Waits until the socket is readable. Returns false after two seconds.
bool is_readable(int descriptor) {
  pollfd event{descriptor, POLLIN, 0};
  return poll(&event, 1, 2000) == 1;
}

}  // namespace

TEST_CASE("each team receives its robots' local velocities in one datagram, and errors are counted") {
  const TestEndpoint test;
  const LeaguePorts ports{test.unicast(0), test.unicast(1)};
  league::UnicastSocket blue(ports.blue), yellow(ports.yellow);
  LeagueDriver driver(two_teams(), {0, 3, 16}, ports);
  std::vector<std::string> events;
  driver.on_event(LogLevel::kInfo, [&](const LogEvent& event) { events.push_back(event.text); });
  const std::vector<BaseCommand> commands{{0, {{1, -0.5}, 2}}, {3, {}}, {16, {{0.25, 0}, 0}}};
  driver.send(commands);
  std::optional<league::Endpoint> sender;
  for (const auto& [socket, numbers] : {std::pair(&blue, std::vector<std::uint32_t>{0, 3}),
                                        std::pair(&yellow, std::vector<std::uint32_t>{0})}) {
    REQUIRE(is_readable(socket->descriptor()));
    int datagrams = 0;
    socket->receive([&, wanted = numbers](std::span<const std::byte> datagram, const league::Endpoint& from) {
      ++datagrams;
      sender = from;
      const auto packet = league::decode_team_commands(datagram);
      REQUIRE(packet.packet);
      REQUIRE(packet.packet->robots.size() == wanted.size());
      for (std::size_t i = 0; i < wanted.size(); ++i) {
        CHECK(packet.packet->robots[i].number == wanted[i]);
        REQUIRE(packet.packet->robots[i].move);
        CHECK(packet.packet->robots[i].move->kind == league::RobotMove::Kind::kLocal);
      }
      if (wanted.size() == 2) {
        CHECK(packet.packet->robots[0].move->linear_mps.y() == Approx(-0.5));
        CHECK(packet.packet->robots[0].move->turn_radps == Approx(2));
      }
    });
    CHECK(datagrams == 1);
  }
  REQUIRE(sender);
  REQUIRE(blue.send(league::encode(league::TeamResponse{{{"UNSUPPORTED_VELOCITY", "no"}}, {{0, true}}}),
                    *sender));
  REQUIRE(is_readable(driver.descriptor()));
  driver.receive();
  CHECK(driver.answers() == 1);
  // An answer from an unknown sender, then a malformed one.
  league::UnicastSocket stranger(std::nullopt);
  REQUIRE(stranger.send(league::encode(league::TeamResponse{{{"X", "y"}}, {}}), *sender));
  REQUIRE(is_readable(driver.descriptor()));
  driver.receive();
  const std::byte garbage[3]{std::byte{0xff}, std::byte{0xff}, std::byte{0xff}};
  REQUIRE(yellow.send(garbage, *sender));
  REQUIRE(is_readable(driver.descriptor()));
  driver.receive();
  DropCounters drops;
  driver.count_drops(drops);
  CHECK(driver.answers() == 1);
  CHECK(drops.total(DropReason::kRejectedByBase) == 1);
  CHECK(drops.total(DropReason::kMalformedLeaguePacket) == 2);
  REQUIRE(events.size() == 1);
  CHECK_THAT(events.front(), ContainsSubstring("UNSUPPORTED_VELOCITY no"));
}

}  // namespace sidestep::league_driver_test
