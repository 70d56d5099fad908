// SPDX-License-Identifier: Apache-2.0
// Attacks on the processes of a run with keys, by real participants.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <signal.h>

#include "common/client/client.hpp"
#include "common/client/order_client.hpp"
#include "common/file/write_file.hpp"
#include "common/messaging/dds/admission.hpp"
#include "common/messaging/order_codec.hpp"
#include "common/protocol/senders.hpp"
#include "common/random/rng.hpp"
#include "deploy/run/keys/permissions_text.hpp"
#include "tests/catch.hpp"
#include "tests/faults/attacker.hpp"
#include "tests/faults/datagrams.hpp"
#include "tests/faults/keyed_run.hpp"
#include "tests/faults/process_usage.hpp"
#include "tests/needs_root.hpp"
#include "tests/test_keys.hpp"

namespace sidestep::keys_attack_test {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr double kMoving_mps = 0.1;
constexpr int kDatagramsPerSecond = 10'000;

/// An order in the name of `sender` that sends robot 0 to the other side of the field.
msg::Order order_as(std::uint32_t sender, const LaunchedRun& run) {
  const Time now = run.bus().now();
  const auto& robots = run.truth().robots();
  const auto robot = std::ranges::find_if(robots, [](const auto& r) { return r.robot() == 0; });
  msg::Order order;
  order.header().sender(sender);
  order.header().incarnation(1);
  order.header().stamp_ns(to_ns(now));
  order.robot(0);
  order.terms().order_kind(msg::OrderKind::ORDER_GO);
  order.terms().order_number(static_cast<OrderNumber>(to_ns(now)));
  order.poses().resize(1);
  order.poses()[0].x_m(robot == robots.end() || robot->x_m() < 0 ? 2 : -2);
  order.poses()[0].y_m(-1);
  order.poses()[0].tolerance_m(0.05);
  return order;
}

/// Writes orders for some seconds, by default in the operator's name. Returns whether a robot moved.
/// Precondition: all robots are at rest.
bool attack(LaunchedRun& run, Attacker& attacker, Duration duration = seconds(3),
            std::uint32_t sender = static_cast<std::uint32_t>(Sender::kOperator)) {
  // A robot that has not arrived yet may stop for a moment.
  Time moved_at = run.bus().now();
  REQUIRE(run.wait_until([&] {
    if (run.max_speed_mps() > kMoving_mps / 2) moved_at = run.bus().now();
    return run.bus().now() - moved_at > seconds(1);
  }));
  const msg::Order order = order_as(sender, run);
  const Time begin = run.bus().now();
  bool has_moved = false;
  REQUIRE(run.wait_until([&] {
    attacker.write(topics::kOrder, 0, order);
    has_moved = has_moved || run.max_speed_mps() > kMoving_mps;
    return has_moved || run.bus().now() - begin > duration;
  }));
  return has_moved;
}

/// Checks that the attacker moves no robot and finds no reader, and that the log has this line.
void check_refused(LaunchedRun& run, const AttackerSettings& settings, const std::string& line) {
  CAPTURE(line);
  Attacker attacker(settings);
  CHECK_FALSE(attack(run, attacker));
  CHECK(attacker.readers() == 0);
  CHECK(run.wait_until([&] { return run.logged("keys: refuses " + line); }));
}

/// Returns an attacker with genuine keys that the run hears. The attacker sends until the log says that its
/// messages are refused. When processes of several tests start simultaneously, one in ten attackers is not
/// heard for more than a minute, and is then replaced by a new one.
std::unique_ptr<Attacker> connect_attacker(LaunchedRun& run, const AttackerSettings& settings,
                                           const std::function<void(Attacker&)>& send,
                                           const std::vector<std::string>& lines) {
  constexpr int kMaxTries = 4;
  const auto is_heard = [&] {
    return std::ranges::all_of(lines, [&](const std::string& line) { return run.logged(line); });
  };
  for (int i = 0; i < kMaxTries; ++i) {
    auto attacker = std::make_unique<Attacker>(settings);
    const Time begin = run.bus().now();
    REQUIRE(run.wait_until([&] {
      send(*attacker);
      return is_heard() || run.bus().now() - begin > seconds(10);
    }));
    if (is_heard()) return attacker;
    WARN("attacker " << i << " is not heard, starting another one");
  }
  FAIL("no attacker is heard");
  return nullptr;
}

/// A client that sends orders in the operator's name and is refused.
std::unique_ptr<Attacker> connect_client(KeyedRun& keyed) {
  LaunchedRun& run = keyed.run;
  const msg::Order order = order_as(static_cast<std::uint32_t>(Sender::kOperator), run);
  return connect_attacker(
      run, keyed.with_keys(keyed.keys.folder_of("client forklift")),
      [&](Attacker& client) { client.write(topics::kOrder, 0, order); },
      {"keys: refuses messages of client forklift on topic 'order' in the name of operator"});
}

/// Replaces the permissions by an operator's permissions for the same subject, signed by another authority.
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

/// Number of datagrams that all processes of a run refused because of their form.
std::uint64_t malformed_datagrams(const nlohmann::json& report) {
  std::uint64_t result = 0;
  for (const auto& [process, counts] : report["counters"].items())
    result += counts.value("malformed_datagram", std::uint64_t{0});
  return result;
}

TEST_CASE("without attacks, the processes of a run with keys refuse no datagram of each other") {
  KeyedRun keyed;
  keyed.check_operator_orders();
  CHECK(malformed_datagrams(keyed.run.report()) == 0);
}

TEST_CASE("without keys, an order from any process on the network moves a robot") {
  LaunchedRun run(kThreeWaitingRobots);
  REQUIRE(run.wait_until([&] { return run.truth().robots().size() == 3; }));
  Attacker attacker({std::stoi(run.dds_arguments()[1])});
  INFO(run.output());
  CHECK(attack(run, attacker, seconds(20)));
  CHECK_FALSE(run.logged("no keys:"));  // only this machine can reach the run
}

TEST_CASE("a command without keys says that a run with keys is here") {
  KeyedRun keyed;
  LaunchedRun& run = keyed.run;
  CHECK_FALSE(run.printed("a run with keys is here"));
  std::vector<std::string> arguments{"status", "--once"};
  const auto dds = run.dds_arguments();
  arguments.insert(arguments.end(), dds.begin(), dds.end());
  CHECK(run.command(arguments) == "exit code 1");
  CHECK(run.printed("a run with keys is here, and ignores this process, which has none: --keys FOLDER"));
}

TEST_CASE("with keys, a process without valid keys is refused and logged, and moves no robot", "[slow]") {
  KeyedRun keyed;
  LaunchedRun& run = keyed.run;
  const TestKeys others(all_identities());
  INFO(run.output());
  const AttackerSettings genuine = keyed.with_keys(keyed.keys.folder_of("operator"));

  check_refused(run, {keyed.domain()}, "a process at 127.0.0.1 that announces no key");
  // This attacker has no keys, but repeats the operator's announcement.
  const CertifiedPrefix prefix = Certificate::load(genuine.keys->certificate).prefix();
  check_refused(run, {keyed.domain(), std::nullopt, genuine.announced, prefix},
                "a process that announces itself as operator");

  AttackerSettings foreign = keyed.with_keys(others.folder_of("judge"));
  use_own_permissions(foreign, others);
  check_refused(run, foreign, "a process at 127.0.0.1, whose key was issued by another authority");
  // Different authorities use the same process names, so their participants have the same prefix.
  foreign = keyed.with_keys(others.folder_of("vision"));
  foreign.announced = keyed.with_keys(keyed.keys.folder_of("vision")).announced;
  use_own_permissions(foreign, others);
  check_refused(run, foreign, "a process that announces itself as vision");

  // A viewer that has signed its own permissions to write everything.
  AttackerSettings viewer = keyed.with_keys(keyed.keys.folder_of("viewer"));
  use_own_permissions(viewer, others);
  check_refused(run, viewer, "a process that announces itself as viewer");
  viewer.announced = genuine.announced;
  check_refused(run, viewer, "a process at 127.0.0.1 that announces the certificate of operator");
  keyed.check_operator_orders();
}

TEST_CASE("with keys, no process can send messages in the name of another process") {
  KeyedRun keyed;
  LaunchedRun& run = keyed.run;
  INFO(run.output());
  // A viewer can only read and write what its keys allow; its own library refuses the rest.
  CHECK(keyed.command({"topic", "pub", "order", "{}", "--keys", keyed.keys.folder_of("viewer")}) ==
        "exit code 2");
  CHECK(run.printed("the keys of viewer do not allow writing the topic 'order'"));
  CHECK(keyed.command({"topic", "echo", "truth", "--once"}) == "exit code 2");
  CHECK(run.printed("do not allow reading the topic 'truth'"));
  CHECK(keyed.command({"topic", "echo", "world", "--once"}) == "exit code 0");
  Attacker viewer(keyed.with_keys(keyed.keys.folder_of("viewer")));
  CHECK_THROWS(viewer.write(topics::kCommand, 0, msg::Command()));

  // Agent 1 may write these topics, but not in the name of agent 0.
  CHECK_THROWS(
      Attacker(keyed.with_keys(keyed.keys.folder_of("agent 1"))).write(topics::kCommand, 0, msg::Command()));
  const std::string refused = "keys: refuses messages of agent 1 on topic '{}' in the name of agent 0";
  const auto header = order_as(0, run).header();
  const auto forge = [&](Attacker& agent) {
    msg::Registration registration;
    registration.header() = header;
    agent.write(topics::kRegistration, 0, registration);
    msg::Proposal proposal;
    proposal.header() = header;
    agent.write(topics::kProposal, 0, proposal);
    msg::OrderStatus status;
    status.header() = header;
    agent.write(topics::kOrderStatus, 0, status);
  };
  const auto forger = connect_attacker(
      run, keyed.with_keys(keyed.keys.folder_of("agent 1")), forge,
      {fmt::format(fmt::runtime(refused), "registration"), fmt::format(fmt::runtime(refused), "proposal"),
       fmt::format(fmt::runtime(refused), "order_status")});

  // A client may give orders in its own name, but not in the operator's name.
  const auto client_attacker = connect_client(keyed);
  Attacker& client = *client_attacker;
  CHECK_FALSE(attack(run, client));
  CHECK(client.readers() > 0);
  CHECK(run.logged("keys: refuses messages of client forklift on topic 'order' in the name of operator"));
  CHECK(attack(run, client, seconds(20), client_id("forklift")));
  keyed.check_safe();
}

TEST_CASE("a program can give orders with its own keys, but not without keys") {
  KeyedRun keyed;
  LaunchedRun& run = keyed.run;
  INFO(run.output());
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

TEST_CASE("keys that are revoked or expire during a run are refused within seconds", "[slow]") {
  KeyedRun keyed;
  LaunchedRun& run = keyed.run;
  INFO(run.output());
  const auto revoke = [&](const std::vector<std::string>& identity) {
    std::vector<std::string> command{"keys", "revoke", "--keys", keyed.keys.folder()};
    command.insert(command.end(), identity.begin(), identity.end());
    return run.command(command);
  };
  const auto client_attacker = connect_client(keyed);
  Attacker& client = *client_attacker;
  REQUIRE(attack(run, client, seconds(20), client_id("forklift")));
  REQUIRE(revoke({"client", "forklift"}) == "exit code 0");
  REQUIRE(run.wait_until(
      [&] { return run.logged("keys: refuses client forklift at 127.0.0.1, whose key is revoked"); }));
  CHECK_FALSE(attack(run, client, seconds(3), client_id("forklift")));

  // If no process hears an attacker before its key expires, another attacker takes its place; see
  // connect_attacker().
  std::unique_ptr<Attacker> brief;
  bool has_moved_robot = false;
  for (int i = 0; i < 4 && !has_moved_robot; ++i) {
    const Duration validity = run.bus().now() - keyed.keys.now() + seconds(8);
    brief = std::make_unique<Attacker>(
        keyed.with_keys(keyed.keys.issue({Role::kClient, 0, 0, "brief"}, validity)));
    has_moved_robot = attack(run, *brief, seconds(7), client_id("brief"));
  }
  REQUIRE(has_moved_robot);
  REQUIRE(run.wait_until(
      [&] { return run.logged("keys: refuses client brief at 127.0.0.1, whose key has expired"); }));
  CHECK_FALSE(attack(run, *brief, seconds(3), client_id("brief")));

  // The robot of a revoked agent stays at rest, and the others continue.
  REQUIRE(revoke({"agent", "2"}) == "exit code 0");
  REQUIRE(
      run.wait_until([&] { return run.logged("keys: refuses agent 2 at 127.0.0.1, whose key is revoked"); }));
  keyed.check_operator_orders();
}

/// Replaces ssh by a program that runs the remote command on this machine, as sshd would.
class LocalSsh {
 public:
  LocalSsh() {
    write_file(folder_.file("ssh"),
               "#!/bin/sh\nwhile [ \"${1#-}\" != \"$1\" ]; do shift; done\nshift\nexec sh -c \"$*\"\n");
    std::filesystem::permissions(folder_.file("ssh"), std::filesystem::perms::owner_all);
    setenv("PATH", (folder_.path() + ":" + path_).c_str(), 1);
  }
  ~LocalSsh() { setenv("PATH", path_.c_str(), 1); }
  LocalSsh(const LocalSsh&) = delete;
  LocalSsh& operator=(const LocalSsh&) = delete;

 private:
  std::string path_ = std::getenv("PATH");
  TemporaryFolder folder_;
};

TEST_CASE("keys that are revoked during a run are also refused on other hosts") {
  const LocalSsh ssh;
  const TemporaryFolder folder;
  const std::string hosts = folder.file("hosts.yaml");
  write_file(hosts,
             "launcher: {interface: 127.0.0.1}\nhosts:\n  - name: far\n    transport: {ssh: robot@far}\n"
             "    interface: 127.0.0.1\n    processes: [simulator, vision, coordinator]\n"
             "    standbys: rest\n    agents: rest\n");
  KeyedRun keyed({"--hosts", hosts});
  LaunchedRun& run = keyed.run;
  INFO(run.output());
  const auto client_attacker = connect_client(keyed);
  Attacker& client = *client_attacker;
  REQUIRE(attack(run, client, seconds(20), client_id("forklift")));
  REQUIRE(run.command({"keys", "revoke", "--keys", keyed.keys.folder(), "client", "forklift"}) ==
          "exit code 0");
  // The coordinator uses the list of revoked keys of the other host.
  REQUIRE(run.wait_until([&] {
    return run.logged("coordinator: keys: refuses client forklift at 127.0.0.1, whose key is revoked");
  }));
  CHECK_FALSE(attack(run, client, seconds(3), client_id("forklift")));
  keyed.check_operator_orders();
}

/// Checks that no thread is in an endless loop, which would use as much of a core as it can get. All robots
/// are at rest.
void check_no_thread_spins(LaunchedRun& run) {
  constexpr double kObserved_s = 4;
  const auto before = usage_of(run);
  const Time begin = run.bus().now();
  REQUIRE(run.wait_until([&] { return run.bus().now() - begin > from_seconds(kObserved_s); }));
  for (const auto& [name, usage] : usage_of(run)) {
    CAPTURE(name);
    CHECK(usage.cpu_s - before.at(name).cpu_s < kObserved_s / 6);
  }
}

/// While robots drive back and forth, replays and alters the datagrams that their processes exchange.
void repeat_and_alter(Duration duration, std::uint64_t seed) {
  SIDESTEP_NEEDS_ROOT();
  KeyedRun keyed;
  LaunchedRun& run = keyed.run;
  INFO(run.output());
  CAPTURE(seed);
  Rng rng(seed);
  const std::map<std::string, pid_t> processes = run.children();
  const Capture capture(keyed.domain());
  Shuttle shuttle(keyed);
  // Captures for some seconds, so that replays repeat datagrams that were accepted before.
  const Time captured_until = run.bus().now() + seconds(5);
  REQUIRE(run.wait_until([&] { return shuttle.drive() > 3 && run.bus().now() > captured_until; }));
  const std::vector<CapturedDatagram> captured = capture.datagrams();
  REQUIRE(captured.size() > 1000);
  DatagramSender sender;
  int replayed = 0, changed = 0;
  const std::uint64_t read_before = datagrams_read();
  const Time begin = run.bus().now();
  // wait_until() waits for at most a minute.
  while (run.bus().now() - begin < duration) {
    const Time part_begin = run.bus().now();
    REQUIRE(run.wait_until([&] {
      shuttle.drive();
      const double elapsed_s = to_seconds(run.bus().now() - begin);
      while (replayed + changed < elapsed_s * kDatagramsPerSecond) {
        const CapturedDatagram& datagram = captured[rng.below(captured.size())];
        const bool is_altered = rng.below(2) == 0;
        const CapturedDatagram& other = captured[rng.below(captured.size())];
        sender.send(datagram.port, is_altered ? altered(datagram.bytes, other.bytes, rng) : datagram.bytes);
        ++(is_altered ? changed : replayed);
      }
      return run.bus().now() - part_begin > seconds(10);
    }));
  }
  // Processes have received these datagrams in addition to each other's.
  const std::uint64_t read = datagrams_read() - read_before;
  CHECK(read > static_cast<std::uint64_t>(replayed + changed));
  CHECK(run.children() == processes);
  check_no_thread_spins(run);
  const int carried_out = shuttle.drive();
  keyed.check_operator_orders();
  const nlohmann::json report = run.report();
  CHECK(report["deaths"].empty());
  const std::uint64_t dropped = malformed_datagrams(report);
  CHECK(dropped > 0);
  WARN(captured.size() << " datagrams captured, " << replayed << " replayed, " << changed << " altered, "
                       << dropped << " dropped as malformed; orders carried out: " << carried_out);
}

TEST_CASE("replayed and altered datagrams do not disturb robots that drive with keys", "[slow]") {
  repeat_and_alter(seconds(15), 41);
}

TEST_CASE("ten minutes of replayed and altered datagrams do not disturb robots that drive with keys",
          "[.long][slow]") {
  repeat_and_alter(std::chrono::minutes(10), 42);
}

}  // namespace sidestep::keys_attack_test
