// SPDX-License-Identifier: Apache-2.0
#include "agents/tactics/referee_node.hpp"

#include <limits>

#include "common/messaging/sim/bus.hpp"
#include "tests/catch.hpp"

namespace sidestep::referee_node_test {

using namespace std::chrono_literals;
using league::RefereeCommand;

constexpr league::Endpoint kReferee{0x7f000001, 4000}, kOther{0x7f000002, 4000};

/// The referee's node, vision, and a process that records the orders.
struct System {
  SimNetwork network{1, time_from_ns(1'000'000'000'000), NetworkSpec{}};
  SimBus bus{network}, other_bus{network};
  RefereeNode node{bus, Scenario{}, RefereeSettings{}};
  Writer<msg::WorldState> world_writer = other_bus.advertise(topics::kWorld);
  OrderBook book;
  std::vector<Order> orders;  ///< without repetitions
  std::vector<std::string> log;
  Duration sent{0};
  Vec2 ball_m{1, 1};
  bool is_ball_visible = true;
  std::uint32_t vision = static_cast<std::uint32_t>(Sender::kVision);

  System() {
    node.on_event(LogLevel::kInfo, [this](const LogEvent& event) { log.push_back(event.text); });
    other_bus.subscribe(topics::kOrder, [this](const msg::Order& message) {
      const auto order = decode(message, other_bus.now());
      REQUIRE(order);
      CHECK(order->client == static_cast<ClientId>(Sender::kReferee));
      if (book.merge({*order}) == OrderBook::Outcome::kStored) orders.push_back(*order);
    });
  }
  void say(RefereeCommand command, const league::Endpoint& from = kReferee) {
    sent += 10ms;
    node.on_datagram(league::encode({sent, command, 0, {}, Vec2(-1, 1)}), from);
  }
  void see_ball() {
    msg::WorldState world;
    world.vision(vision);
    world.header().sender(vision);
    world.ball().is_visible(is_ball_visible);
    world.ball().x_m(ball_m.x());
    world.ball().y_m(ball_m.y());
    world_writer.publish(world, other_bus.now());
  }
  /// Sends a command and a world state every 10 ms for `duration`.
  void play(RefereeCommand command, Duration duration) {
    for (Duration t{0}; t < duration; t += 10ms) {
      say(command);
      see_ball();
      run_for(10ms);
    }
  }
  void run_for(Duration duration) { network.run_until(network.now() + duration); }
  std::optional<Vec2> ball_zone_m() const {
    for (const Order& order : book.zones()) {
      if (order.zone_number == kBallZone) return order.zone.corners_m.front();
    }
    return std::nullopt;
  }
  bool has_logged(const std::string& text) const {
    return std::ranges::any_of(log, [&](const auto& line) { return line.find(text) != line.npos; });
  }
};

TEST_CASE("the node gives no orders before the first packet from the referee") {
  System system;
  system.see_ball();
  system.run_for(3s);
  CHECK(system.orders.empty());
  CHECK(system.has_logged("no packet from the referee for 2 s: no orders are in force"));
}

TEST_CASE("HALT is ordered immediately and ends with the next command") {
  System system;
  system.play(RefereeCommand::kForceStart, 1s);
  CHECK_FALSE(system.book.is_held(0));
  CHECK(system.book.zones().empty());
  system.say(RefereeCommand::kHalt);
  system.run_for(1ms);
  CHECK(system.book.is_held(0));
  system.play(RefereeCommand::kHalt, 1s);
  CHECK(system.book.is_held(0));
  system.play(RefereeCommand::kStop, 100ms);
  CHECK_FALSE(system.book.is_held(0));
  CHECK(system.book.zones().size() == 2);
  system.play(RefereeCommand::kForceStart, 100ms);
  CHECK_FALSE(system.book.is_held(0));
  CHECK(system.book.zones().empty());
  CHECK(system.log == std::vector<std::string>{"FORCE_START", "HALT", "STOP", "FORCE_START"});
}

TEST_CASE("a restarted referee program ends the orders that it gave before") {
  System system;
  Order hold{msg::OrderKind::ORDER_HOLD, kAllRobots, static_cast<ClientId>(Sender::kReferee), 1000};
  system.book.merge({hold});
  Order zone{msg::OrderKind::ORDER_ZONE, kAllRobots, static_cast<ClientId>(Sender::kReferee), 1000};
  zone.zone_number = kRightAreaZone;
  zone.zone = {{{1, 1}}, 1};
  system.book.merge({zone});
  system.play(RefereeCommand::kForceStart, 200ms);
  CHECK_FALSE(system.book.is_held(0));
  CHECK(system.book.zones().empty());
}

TEST_CASE("the zone around the ball follows the ball, and stays where the ball was lost") {
  System system;
  system.play(RefereeCommand::kStop, 200ms);
  CHECK(system.ball_zone_m() == Vec2(1, 1));
  system.ball_m = {1.01, 1};
  system.play(RefereeCommand::kStop, 200ms);
  CHECK(system.ball_zone_m() == Vec2(1, 1));
  system.ball_m = {2, 0.5};
  system.play(RefereeCommand::kStop, 100ms);
  CHECK(system.ball_zone_m() == Vec2(2, 0.5));
  system.is_ball_visible = false;
  system.ball_m = {0, 0};
  system.play(RefereeCommand::kStop, 1s);
  CHECK(system.ball_zone_m() == Vec2(2, 0.5));
}

TEST_CASE("a ball that never stops causes at most twenty orders per second") {
  System system;
  system.play(RefereeCommand::kStop, 100ms);
  system.orders.clear();
  for (int i = 0; i < 300; ++i) {
    system.ball_m.x() = 1 + 0.03 * i;
    system.play(RefereeCommand::kStop, 10ms);
  }
  CHECK(system.orders.size() <= 61);
  CHECK(system.orders.size() >= 58);
  CHECK((*system.ball_zone_m() - system.ball_m).norm() < 0.2);
}

TEST_CASE("commands that alternate in every packet cause a bounded number of orders") {
  System system;
  for (int i = 0; i < 10'000; ++i) {
    system.say(i % 2 ? RefereeCommand::kHalt : RefereeCommand::kForceStart);
    system.run_for(100us);
  }
  CHECK(system.orders.size() < 200);
}

TEST_CASE("if packets stop, the last command stays in force and this is logged") {
  System system;
  system.play(RefereeCommand::kStop, 200ms);
  for (int i = 0; i < 500; ++i) {
    system.see_ball();
    system.ball_m.y() -= 0.002;
    system.run_for(10ms);
  }
  CHECK(system.book.zones().size() == 2);
  CHECK((*system.ball_zone_m() - system.ball_m).norm() < 0.05);
  CHECK(std::ranges::count(system.log, "no packet from the referee for 2 s: STOP stays in force") == 1);
}

TEST_CASE("world states that are implausible or not from vision do not move the ball") {
  System system;
  system.play(RefereeCommand::kStop, 200ms);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Vec2& position : {Vec2(nan, 0), Vec2(0, 1e9)}) {
    system.ball_m = position;
    system.play(RefereeCommand::kStop, 200ms);
  }
  system.ball_m = {3, 3};
  system.vision = 3;
  system.play(RefereeCommand::kStop, 200ms);
  CHECK(system.ball_zone_m() == Vec2(1, 1));
}

TEST_CASE("invalid packets and packets of a second referee are ignored and logged") {
  System system;
  system.play(RefereeCommand::kForceStart, 200ms);
  system.say(RefereeCommand::kHalt, kOther);
  system.node.on_datagram(std::vector<std::byte>(20, std::byte{0xff}), kReferee);
  system.run_for(200ms);
  CHECK_FALSE(system.book.is_held(0));
  CHECK(system.has_logged("ignored a packet from 127.0.0.2:4000: the referee is 127.0.0.1:4000"));
  CHECK(system.has_logged("rejected a packet from 127.0.0.1:4000: it is not a message of this type"));
}

}  // namespace sidestep::referee_node_test
