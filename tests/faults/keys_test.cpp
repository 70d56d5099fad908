// SPDX-License-Identifier: Apache-2.0
// Attacks on the processes of a run with keys, by real participants.
#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <signal.h>

#include "common/client/client.hpp"
#include "common/client/order_client.hpp"
#include "common/file/write_file.hpp"
#include "common/messaging/dds/admission.hpp"
#include "common/messaging/order_codec.hpp"
#include "common/messaging/senders.hpp"
#include "common/random/rng.hpp"
#include "deploy/keys/permissions_text.hpp"
#include "tests/catch.hpp"
#include "tests/faults/attacker.hpp"
#include "tests/faults/datagrams.hpp"
#include "tests/faults/keyed_run.hpp"
#include "tests/needs_root.hpp"
#include "tests/test_keys.hpp"

namespace sidestep::keys_attack_test {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr double kMoving_mps = 0.1;
constexpr int kDatagramsPerSecond = 10'000;

/// An order to robot 0 that nobody who may give it has given.
msg::Order order_as(std::uint32_t sender, Time now) {
  msg::Order order;
  order.header().sender(sender);
  order.header().incarnation(1);
  order.header().stamp_ns(to_ns(now));
  order.robot(0);
  order.terms().order_kind(msg::OrderKind::ORDER_GO);
  order.terms().order_number(static_cast<OrderNumber>(to_ns(now)));
  order.poses().resize(1);
  order.poses()[0].x_m(2);
  order.poses()[0].y_m(-1);
  order.poses()[0].tolerance_m(0.05);
  return order;
}

/// Writes orders in the operator's name for some seconds. Returns whether a robot moved.
bool attack(LaunchedRun& run, Attacker& attacker, Duration duration = seconds(4),
            std::uint32_t sender = static_cast<std::uint32_t>(Sender::kOperator)) {
  const Time begin = run.bus().now();
  bool has_moved = false;
  REQUIRE(run.wait_until([&] {
    attacker.write(topics::kOrder, 0, order_as(sender, run.bus().now()));
    has_moved = has_moved || run.max_speed_mps() > kMoving_mps;
    return has_moved || run.bus().now() - begin > duration;
  }));
  return has_moved;
}

/// Replaces the permissions by some that another authority has signed: those of an operator, for the same
/// subject.
void use_own_permissions(AttackerSettings& settings, const TestKeys& others) {
  const Certificate certificate = Certificate::load(settings.keys->certificate);
  const std::string authority = others.folder() + "/public/" + key_files::kPermissionsAuthority;
  const Authority permissions(authority, others.folder() + "/private/permissions_ca.key.pem");
  settings.keys->permissions_authority = authority;
  settings.keys->governance = others.folder() + "/public/" + key_files::kGovernance;
  settings.keys->permissions = others.folder() + "/own-permissions.p7s";
  write_file(settings.keys->permissions,
             permissions.sign(permissions_text({Role::kOperator}, certificate.subject(),
                                               certificate.not_before(), certificate.not_after())));
}

TEST_CASE("without keys, anybody's order moves a robot") {
  LaunchedRun run(kThreeWaitingRobots);
  REQUIRE(run.wait_until([&] { return run.truth().robots().size() == 3; }));
  Attacker attacker({std::stoi(run.dds_arguments()[1])});
  INFO(run.output());
  CHECK(attack(run, attacker, seconds(20)));
  CHECK(run.logged("no keys: anybody on this network can command the robots"));
}

TEST_CASE("with keys, strangers are refused by name, and move no robot") {
  KeyedRun keyed;
  LaunchedRun& run = keyed.run;
  const TestKeys others(all_identities());
  INFO(run.output());
  SECTION("somebody without keys") {
    Attacker attacker({keyed.domain()});
    CHECK_FALSE(attack(run, attacker));
    CHECK(attacker.readers() == 0);
    CHECK(run.logged("keys: refuses a process at 127.0.0.1 that announces no key"));
  }
  SECTION("somebody without keys who repeats the announcement of the operator") {
    const auto genuine = keyed.with_keys(keyed.keys.folder_of("operator"));
    const Certificate certificate = Certificate::load(genuine.keys->certificate);
    Attacker attacker({keyed.domain(), std::nullopt, genuine.announced, certificate.prefix()});
    CHECK_FALSE(attack(run, attacker));
    CHECK(attacker.readers() == 0);
    CHECK(run.logged("keys: refuses a process that announces itself as operator"));
  }
  SECTION("somebody with keys of another authority") {
    Attacker attacker(keyed.with_keys(others.folder_of("operator")));
    CHECK_FALSE(attack(run, attacker));
    CHECK(attacker.readers() == 0);
    CHECK(run.logged("keys: refuses a process at 127.0.0.1, whose key another authority has issued"));
  }
  SECTION("somebody with keys of another authority who repeats the announcement of the operator") {
    AttackerSettings settings = keyed.with_keys(others.folder_of("operator"));
    settings.announced = keyed.with_keys(keyed.keys.folder_of("operator")).announced;
    Attacker attacker(settings);
    CHECK_FALSE(attack(run, attacker));
    CHECK(attacker.readers() == 0);
    // Authorities name the operator alike, so the two have the same prefix.
    CHECK(run.logged("keys: refuses a process that announces itself as operator"));
  }
  SECTION("a viewer who repeats the announcement of the operator") {
    AttackerSettings settings = keyed.with_keys(keyed.keys.folder_of("viewer"));
    settings.announced = keyed.with_keys(keyed.keys.folder_of("operator")).announced;
    use_own_permissions(settings, others);
    Attacker attacker(settings);
    CHECK_FALSE(attack(run, attacker));
    CHECK(attacker.readers() == 0);
    CHECK(run.logged("keys: refuses a process at 127.0.0.1 that announces the certificate of operator"));
  }
  SECTION("a viewer who has signed permissions to write everything") {
    AttackerSettings settings = keyed.with_keys(keyed.keys.folder_of("viewer"));
    use_own_permissions(settings, others);
    Attacker attacker(settings);
    CHECK_FALSE(attack(run, attacker));
    CHECK(attacker.readers() == 0);
    CHECK(run.wait_until(
        [&] { return run.logged("keys: refuses a process that announces itself as viewer"); }));
  }
  keyed.check_unharmed();
}

TEST_CASE("with keys, processes speak only for themselves") {
  KeyedRun keyed;
  LaunchedRun& run = keyed.run;
  INFO(run.output());
  SECTION("a client gives its own orders, and none of the operator's") {
    Attacker client(keyed.with_keys(keyed.keys.folder_of("client forklift")));
    CHECK_FALSE(attack(run, client));
    CHECK(client.readers() > 0);
    CHECK(run.logged("keys: refuses messages of client forklift on topic 'order' in the name of operator"));
    CHECK(attack(run, client, seconds(20), client_id("forklift")));
    keyed.check_safe();
  }
  SECTION("a program orders with its own keys, and not without any") {
    client::Settings settings;
    settings.name = "forklift";
    settings.domain = keyed.domain();
    client::Client stranger(settings);
    settings.keys = keyed.keys.folder();
    client::Client forklift(settings);
    const client::OrderId strange = stranger.go(1, {{2, 0}});
    const client::OrderId order = forklift.go(0, {{2, -1}});
    CHECK(run.wait_until([&] {
      const auto state = forklift.wait(order, milliseconds(1));
      return state && state->phase == client::OrderPhase::kArrived;
    }));
    const auto state = stranger.state(strange);
    REQUIRE(state);
    CHECK(state->phase == client::OrderPhase::kSent);
    settings.name = "nobody";
    CHECK_THROWS_WITH(client::Client(settings), ContainsSubstring("has no keys of client nobody"));
    keyed.check_safe();
  }
  SECTION("agent 1 writes nothing in the name of agent 0") {
    Attacker agent(keyed.with_keys(keyed.keys.folder_of("agent 1")));
    CHECK_THROWS(agent.write(topics::kCommand, 0, msg::Command()));
    const std::string refused = "keys: refuses messages of agent 1 on topic '{}' in the name of agent 0";
    REQUIRE(run.wait_until([&] {
      const auto header = order_as(0, run.bus().now()).header();
      msg::Registration registration;
      registration.header() = header;
      agent.write(topics::kRegistration, 0, registration);
      msg::Proposal proposal;
      proposal.header() = header;
      agent.write(topics::kProposal, 0, proposal);
      msg::OrderStatus status;
      status.header() = header;
      agent.write(topics::kOrderStatus, 0, status);
      return run.logged(fmt::format(fmt::runtime(refused), "registration")) &&
             run.logged(fmt::format(fmt::runtime(refused), "proposal")) &&
             run.logged(fmt::format(fmt::runtime(refused), "order_status"));
    }));
    keyed.check_unharmed();
  }
  SECTION("a viewer writes nothing") {
    CHECK(keyed.command({"topic", "pub", "order", "{}", "--keys", keyed.keys.folder_of("viewer")}) ==
          "exit code 2");
    CHECK(run.printed("the keys of viewer do not allow writing the topic 'order'"));
    Attacker viewer(keyed.with_keys(keyed.keys.folder_of("viewer")));
    CHECK_THROWS(viewer.write(topics::kCommand, 0, msg::Command()));
    keyed.check_unharmed();
  }
  SECTION("a viewer does not read the ground truth") {
    CHECK(keyed.command({"topic", "echo", "truth", "--once"}) == "exit code 2");
    CHECK(run.printed("do not allow reading the topic 'truth'"));
    CHECK(keyed.command({"topic", "echo", "world", "--once"}) == "exit code 0");
    keyed.check_unharmed();
  }
}

TEST_CASE("keys that are revoked or expire during a run are refused within seconds") {
  KeyedRun keyed;
  LaunchedRun& run = keyed.run;
  INFO(run.output());
  SECTION("revoked") {
    Attacker client(keyed.with_keys(keyed.keys.folder_of("client forklift")));
    REQUIRE(attack(run, client, seconds(20), client_id("forklift")));
    REQUIRE(run.wait_until([&] { return run.max_speed_mps() < kMoving_mps / 2; }));
    const std::vector<std::string> revoke{"keys",     "revoke", "client",
                                          "forklift", "--keys", keyed.keys.folder()};
    REQUIRE(run.command(revoke) == "exit code 0");
    REQUIRE(run.wait_until(
        [&] { return run.logged("keys: refuses client forklift at 127.0.0.1, whose key is revoked"); }));
    CHECK_FALSE(attack(run, client, seconds(4), client_id("forklift")));
  }
  SECTION("expired") {
    const std::string folder =
        keyed.keys.issue({Role::kClient, 0, 0, "brief"}, run.bus().now() - keyed.keys.now() + seconds(8));
    Attacker client(keyed.with_keys(folder));
    REQUIRE(attack(run, client, seconds(20), client_id("brief")));
    REQUIRE(run.wait_until(
        [&] { return run.logged("keys: refuses client brief at 127.0.0.1, whose key has expired"); }));
    REQUIRE(run.wait_until([&] { return run.max_speed_mps() < kMoving_mps / 2; }));
    CHECK_FALSE(attack(run, client, seconds(4), client_id("brief")));
  }
  SECTION("of an agent: its robot stays, and others drive on") {
    REQUIRE(run.command({"keys", "revoke", "agent", "2", "--keys", keyed.keys.folder()}) == "exit code 0");
    REQUIRE(run.wait_until(
        [&] { return run.logged("keys: refuses agent 2 at 127.0.0.1, whose key is revoked"); }));
  }
  keyed.check_unharmed();
}

TEST_CASE("replayed and altered datagrams do no harm to robots that drive with keys") {
  SIDESTEP_NEEDS_ROOT();
  KeyedRun keyed;
  LaunchedRun& run = keyed.run;
  INFO(run.output());
  const std::uint64_t seed = 41;
  CAPTURE(seed);
  Rng rng(seed);
  const Capture capture(keyed.domain());
  Shuttle shuttle(keyed);
  // A replay repeats what has counted before, and also what has been answered since.
  const Time captured_until = run.bus().now() + seconds(5);
  REQUIRE(run.wait_until([&] { return shuttle.drive() > 3 && run.bus().now() > captured_until; }));
  const std::vector<CapturedDatagram> captured = capture.datagrams();
  REQUIRE(captured.size() > 1000);
  DatagramSender sender;
  int replayed = 0, altered = 0;
  const Time begin = run.bus().now();
  REQUIRE(run.wait_until([&] {
    shuttle.drive();
    const double elapsed_s = to_seconds(run.bus().now() - begin);
    for (; replayed + altered < elapsed_s * kDatagramsPerSecond;) {
      CapturedDatagram datagram = captured[rng.below(captured.size())];
      const bool is_altered = rng.below(2) == 0 && !datagram.bytes.empty();
      if (is_altered)
        datagram.bytes[rng.below(datagram.bytes.size())] ^= static_cast<std::uint8_t>(1 + rng.below(255));
      sender.send(datagram.port, datagram.bytes);
      ++(is_altered ? altered : replayed);
    }
    return elapsed_s > 10;
  }));
  WARN(captured.size() << " datagrams captured, " << replayed << " replayed, " << altered
                       << " altered; orders carried out: " << shuttle.drive());
  keyed.check_unharmed();
}

}  // namespace sidestep::keys_attack_test
