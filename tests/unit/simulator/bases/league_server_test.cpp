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

/// A floor with one robot, its server, and a client.
struct ServedFloor {
  explicit ServedFloor(const LeagueServerSettings& settings) : server(node, ports, settings) {
    node.on_event(LogLevel::kInfo, [this](const LogEvent& event) { events.push_back(event.text); });
    server.start([this](int descriptor, std::function<void()> callback) {
      readable[descriptor] = std::move(callback);
    });
  }
  static Scenario one_robot() {
    Scenario scenario;
    scenario.robots.emplace_back();
    return scenario;
  }
  /// Waits until datagrams have arrived at the server, and lets it read them.
  void serve() {
    std::vector<pollfd> descriptors;
    for (const auto& [descriptor, callback] : readable) descriptors.push_back({descriptor, POLLIN, 0});
    REQUIRE(poll(descriptors.data(), descriptors.size(), 2000) >= 1);
    for (const pollfd& event : descriptors) {
      if (event.revents != 0) readable.at(event.fd)();
    }
  }
  std::optional<std::vector<std::byte>> answer() {
    pollfd event{client.descriptor(), POLLIN, 0};
    if (poll(&event, 1, 200) != 1) return std::nullopt;
    std::optional<std::vector<std::byte>> bytes;
    client.receive([&](std::span<const std::byte> datagram, const league::Endpoint&) {
      bytes.emplace(datagram.begin(), datagram.end());
    });
    return bytes;
  }

  SimNetwork network{1, kBegin, {}};
  SimBus bus{network};
  VelocityRobotSimNode node{bus, one_robot(), {}, 1, 1};
  std::vector<std::string> events;
  TestEndpoint test;
  LeagueServerPorts ports{test.unicast(0), test.unicast(1), test.unicast(2)};
  LeagueServer server;
  std::map<int, std::function<void()>> readable;
  league::UnicastSocket client{std::nullopt};
};

league::TeamCommands forward() {
  league::TeamCommands commands;
  commands.robots.emplace_back();
  commands.robots.front().move = league::RobotMove{league::RobotMove::Kind::kLocal, {1, 0}, 0};
  return commands;
}

}  // namespace

TEST_CASE("the league's protocol is served on its three ports, and malformed datagrams get no answer") {
  ServedFloor floor(LeagueServerSettings{});
  CHECK(floor.readable.size() == 3);
  const league::TeamCommands commands = forward();
  REQUIRE(floor.client.send(encode(commands), floor.ports.blue));
  floor.serve();
  auto bytes = floor.answer();
  REQUIRE(bytes);
  CHECK(league::decode_team_response(*bytes).packet->feedback.size() == 1);
  floor.network.run_until(kBegin + 150ms);
  CHECK(floor.node.world_now().bodies()[0].velocity_mps().x() > 0.1);
  REQUIRE(floor.client.send(encode(commands), floor.ports.yellow));
  floor.serve();
  bytes = floor.answer();
  REQUIRE(bytes);
  CHECK(league::decode_team_response(*bytes).packet->errors.front().code == "UNKNOWN_ROBOT");
  league::SimulatorCommand control;
  control.speed = 0.5;
  REQUIRE(floor.client.send(encode(control), floor.ports.control));
  floor.serve();
  CHECK(floor.answer());
  const Time simulated = floor.node.simulated_now();
  floor.network.run_until(floor.network.now() + 1s);
  CHECK(floor.node.simulated_now() - simulated == 500ms);

  const std::byte garbage[]{std::byte{0xff}, std::byte{0x01}};
  for (const league::Endpoint& port : {floor.ports.control, floor.ports.blue, floor.ports.yellow}) {
    REQUIRE(floor.client.send(garbage, port));
    floor.serve();
  }
  CHECK_FALSE(floor.answer());
  CHECK(floor.events.size() == 1);
}

TEST_CASE("a server that answers packets together answers each team's last one, with all feedback") {
  LeagueServerSettings settings;
  settings.packets_per_answer = 3;
  ServedFloor floor(settings);
  for (int packet = 1; packet <= 6; ++packet) {
    REQUIRE(floor.client.send(encode(forward()), floor.ports.blue));
    floor.serve();
    // Packets of the other team do not count.
    if (packet == 1) REQUIRE(floor.client.send(encode(forward()), floor.ports.yellow));
    if (packet == 1) floor.serve();
    const auto bytes = floor.answer();
    REQUIRE(bytes.has_value() == (packet % 3 == 0));
    if (!bytes) continue;
    const auto response = league::decode_team_response(*bytes);
    REQUIRE(response.packet);
    CHECK(response.packet->feedback.size() == 3);
    CHECK(response.packet->errors.empty());
  }
}

}  // namespace sidestep::league_server_test
