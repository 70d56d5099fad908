// SPDX-License-Identifier: Apache-2.0
#include "simulator/bases/league_server.hpp"

#include <map>
#include <poll.h>

#include "common/messaging/sim/bus.hpp"
#include "tests/catch.hpp"
#include "tests/test_endpoint.hpp"

namespace sidestep::league_server_test {
namespace {

using namespace std::chrono_literals;

constexpr Time kBegin = time_from_ns(1'000'000'000'000);

}  // namespace

TEST_CASE("the league's protocol is served on its three ports, and malformed datagrams get no answer") {
  Scenario scenario;
  scenario.robots.emplace_back();
  SimNetwork network(1, kBegin, {});
  SimBus bus(network);
  VelocityRobotSimNode node(bus, scenario, 0, {}, 1, 1, 1);
  std::vector<std::string> events;
  node.on_event(LogLevel::kInfo, [&](const LogEvent& event) { events.push_back(event.text); });
  const TestEndpoint test;
  const LeagueServerPorts ports{test.unicast(0), test.unicast(1), test.unicast(2)};
  LeagueServer server(node, ports, false);
  std::map<int, std::function<void()>> readable;
  server.start(
      [&](int descriptor, std::function<void()> callback) { readable[descriptor] = std::move(callback); });
  CHECK(readable.size() == 3);
  league::UnicastSocket client(std::nullopt);
  const auto serve = [&] {
    std::vector<pollfd> events_of;
    for (const auto& [descriptor, callback] : readable) events_of.push_back({descriptor, POLLIN, 0});
    REQUIRE(poll(events_of.data(), events_of.size(), 2000) >= 1);
    for (const pollfd& event : events_of) {
      if (event.revents != 0) readable.at(event.fd)();
    }
  };
  const auto answer = [&]() -> std::optional<std::vector<std::byte>> {
    pollfd event{client.descriptor(), POLLIN, 0};
    if (poll(&event, 1, 200) != 1) return std::nullopt;
    std::optional<std::vector<std::byte>> bytes;
    client.receive([&](std::span<const std::byte> datagram, const league::Endpoint&) {
      bytes.emplace(datagram.begin(), datagram.end());
    });
    return bytes;
  };
  league::TeamCommands commands;
  commands.robots.emplace_back();
  commands.robots.front().move = league::RobotMove{league::RobotMove::Kind::kLocal, {1, 0}, 0};
  REQUIRE(client.send(encode(commands), ports.blue));
  serve();
  auto bytes = answer();
  REQUIRE(bytes);
  CHECK(league::decode_team_response(*bytes).packet->feedback.size() == 1);
  network.run_until(kBegin + 150ms);
  CHECK(node.world_now().bodies()[0].velocity_mps().x() > 0.1);
  REQUIRE(client.send(encode(commands), ports.yellow));
  serve();
  bytes = answer();
  REQUIRE(bytes);
  CHECK(league::decode_team_response(*bytes).packet->errors.front().code == "UNKNOWN_ROBOT");
  league::SimulatorCommand control;
  control.speed = 0.5;
  REQUIRE(client.send(encode(control), ports.control));
  serve();
  CHECK(answer());
  const Time simulated = node.simulated_now();
  network.run_until(network.now() + 1s);
  CHECK(node.simulated_now() - simulated == 500ms);

  const std::byte garbage[]{std::byte{0xff}, std::byte{0x01}};
  for (const league::Endpoint& port : {ports.control, ports.blue, ports.yellow}) {
    REQUIRE(client.send(garbage, port));
    serve();
  }
  CHECK_FALSE(answer());
  CHECK(events.size() == 1);
}

}  // namespace sidestep::league_server_test
