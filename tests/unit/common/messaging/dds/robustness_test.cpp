// SPDX-License-Identifier: Apache-2.0
// Failures between processes: mismatched endpoints, invalid payloads, stopped and dying processes.
#include <algorithm>
#include <arpa/inet.h>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/messaging/dds/listener.hpp"
#include "common/messaging/dds/participant.hpp"
#include "common/messaging/dds/presence.hpp"
#include "common/messaging/dds/types.hpp"
#include "common/process/stop_signals.hpp"
#include "tests/catch.hpp"
#include "tests/drops.hpp"
#include "tests/unit/common/messaging/dds/test_support.hpp"

namespace sidestep::robustness_test {

template <typename Message>
Topic<Message> test_topic(Qos qos, const char* type) {
  return {{"test/robustness", {}, {}, qos, false, false, message_type<Message>(type)}};
}

/// Shared-memory files that a process has open or mapped.
std::set<std::string> shared_memory_of(pid_t process) {
  const std::filesystem::path folder = "/proc/" + std::to_string(process);
  std::set<std::string> result;
  std::ifstream maps(folder / "maps");
  for (std::string line; std::getline(maps, line);) {
    if (const auto at = line.find("/dev/shm/"); at != std::string::npos) result.insert(line.substr(at));
  }
  for (const auto& file : std::filesystem::directory_iterator(folder / "fd")) {
    std::error_code ignored;  // the file may have been closed in the meantime
    const std::string target = std::filesystem::read_symlink(file, ignored);
    if (target.starts_with("/dev/shm/")) result.insert(target);
  }
  return result;
}

TEST_CASE("a reader that requests a stronger QoS than the writer offers is reported on both sides") {
  DdsBus reader(test_settings());
  DdsBus writer(test_settings());
  const CaptureStderr captured;
  const auto state = test_topic<msg::Verdict>(Qos::kState, "sidestep::msg::Verdict");
  const auto event = test_topic<msg::Verdict>(Qos::kEvent, "sidestep::msg::Verdict");
  const auto offered = writer.advertise(state);
  reader.subscribe<msg::Verdict>(event, [](const msg::Verdict&) {});
  const auto both_have_logged = [&] {
    return captured.has(
               "'test/robustness': a writer offers less than this reader requests, policy reliability") &&
           captured.has(
               "'test/robustness': a reader requests more than this writer offers, policy reliability");
  };
  const bool reported = run_until(both_have_logged, reader, writer);
  CAPTURE(captured.text());
  CHECK(reported);
}

TEST_CASE("an endpoint that uses one of our topics with another type is reported") {
  DdsBus reader(test_settings());
  DdsBus writer(test_settings());
  const CaptureStderr captured;
  reader.subscribe<msg::Verdict>(test_topic<msg::Verdict>(Qos::kState, "sidestep::msg::Verdict"),
                                 [](const msg::Verdict&) {});
  const auto other = writer.advertise(test_topic<msg::Proposal>(Qos::kState, "sidestep::msg::Proposal"));
  const auto is_logged = [&] {
    return captured.has(
        "a writer has type sidestep::msg::Proposal and is ignored, expected sidestep::msg::Verdict");
  };
  const bool reported = run_until(is_logged, reader, writer);
  CAPTURE(captured.text());
  CHECK(reported);
}

TEST_CASE("invalid payloads are counted, reported once and dropped while valid ones still arrive") {
  DdsBus bus(test_settings());
  int received = 0;
  bus.subscribe<msg::WorldState>(topics::kWorld, [&](const msg::WorldState&) { ++received; });

  DdsParticipant hostile(test_settings("hostile"), nullptr);
  fast_dds::dds::DataWriter* writer =
      hostile.create_writer("world", fast_dds::dds::TypeSupport(new RawType(topics::kWorld.type.name, true)),
                            dds_writer_qos(Qos::kState), nullptr);
  const std::size_t fixed = fast_dds::cdr_size(msg::WorldState());
  std::vector<std::uint8_t> huge(4 + fixed, 0);
  huge[1] = 1;
  std::fill(huge.end() - 4, huge.end(), 0xff);  // states 2^32 - 1 robots
  const std::uint64_t seed = 11;
  CAPTURE(seed);
  Rng rng(seed);

  const CaptureStderr captured;
  const auto many_are_refused = [&] {
    std::vector<std::uint8_t> noise(rng.below(2000));
    for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(rng.bits());
    REQUIRE(fast_dds::write(*writer, &noise));
    REQUIRE(fast_dds::write(*writer, &huge));
    return drops_of(bus).total(DropReason::kUnreadable) >= 300;
  };
  const bool refused = run_until(many_are_refused, bus);
  const std::string log = captured.text();
  CAPTURE(log);
  CHECK(refused);
  CHECK(received == 0);
  CHECK_THAT(log, ContainsSubstring("topic 'world': 1 unreadable message(s)"));
  CHECK(std::count(log.begin(), log.end(), '\n') <= 3);

  DdsBus vision(test_settings("vision"));
  auto good = vision.advertise(topics::kWorld);
  msg::WorldState world;
  world.header().sender(static_cast<std::uint32_t>(Sender::kVision));
  const auto is_received = [&] {
    good.publish(world, vision.now());
    return received > 0;
  };
  CHECK(run_until(is_received, bus));
  hostile.delete_writer(writer);
}

/// Sends a datagram to the port on which a bus on this machine receives messages.
void send_to(const DdsBus& bus, const std::vector<std::uint8_t>& datagram) {
  const std::string locators = bus.locators(), address = "UDPv4:[127.0.0.1]:";
  const auto found = locators.find(address);
  REQUIRE(found != std::string::npos);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  to.sin_port = htons(static_cast<std::uint16_t>(std::stoi(locators.substr(found + address.size()))));
  const int sender = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  REQUIRE(sendto(sender, datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&to),
                 sizeof to) == static_cast<ssize_t>(datagram.size()));
  close(sender);
}

TEST_CASE("a datagram that would make Fast DDS abort is dropped and counted") {
  DdsBus bus(test_settings());
  bus.subscribe<msg::WorldState>(topics::kWorld, [](const msg::WorldState&) {});
  // Statistics of Fast DDS, which must come last, followed by another submessage.
  std::vector<std::uint8_t> datagram{'R', 'T', 'P', 'S', 2, 2, 1, 15, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  for (int i = 0; i < 2; ++i) {
    datagram.insert(datagram.end(), {0x80, 1, 56, 0});
    datagram.resize(datagram.size() + 56);
  }
  CHECK(run_until(
      [&] {
        send_to(bus, datagram);
        return drops_of(bus).total(DropReason::kMalformedDatagram) >= 10;
      },
      bus));
}

/// Adds enough readers that announcing them takes several messages.
void subscribe_to_many(DdsBus& bus) {
  for (std::uint32_t robot = 2; robot < 30; ++robot)
    bus.subscribe<msg::Verdict>(topics::kVerdict, robot, [](const msg::Verdict&) {});
}

bool is_known(const DdsListener& listener, const std::string& participant) {
  const auto known = listener.endpoints();
  return std::ranges::any_of(known,
                             [&](const DiscoveredEndpoint& e) { return e.participant == participant; });
}

TEST_CASE("publishes until asked to end", "[.victim][slow]") {
  // Catch2 handles SIGTERM too, and its handler allocates memory. That corrupts the heap if the signal
  // arrives during an allocation.
  REQUIRE(signal(SIGTERM, SIG_DFL) != SIG_ERR);
  const auto robot = static_cast<std::uint32_t>(std::atoi(std::getenv("SIDESTEP_TEST_ROBOT")));
  DdsSettings settings = test_settings("victim-" + std::to_string(robot));
  settings.domain = std::atoi(std::getenv("SIDESTEP_TEST_DOMAIN"));
  DdsBus bus(settings);
  const StopSignals stop_signals([&bus] { bus.stop(); });
  auto writer = bus.advertise(topics::kVerdict, robot);
  msg::Verdict verdict;
  verdict.header().sender(static_cast<std::uint32_t>(Sender::kCoordinator));
  verdict.robot(robot);
  bus.subscribe<msg::WorldState>(topics::kWorld, [&](const msg::WorldState& world) {
    verdict.proposal_number(world.header().message_number());
  });
  subscribe_to_many(bus);
  const pid_t parent = getppid();
  std::function<void()> publish = [&] {
    if (getppid() != parent) bus.stop();
    writer.publish(verdict, bus.now());
    bus.at(bus.now() + kStep, publish);
  };
  publish();
  bus.run();
}

/// A child process that publishes verdicts for a robot, numbered like the last world state that it received,
/// until it is killed.
struct Victim {
  explicit Victim(std::uint32_t robot = 1) : name("victim-" + std::to_string(robot)) {
    setenv("SIDESTEP_TEST_DOMAIN", std::to_string(test_settings().domain).c_str(), 1);
    setenv("SIDESTEP_TEST_ROBOT", std::to_string(robot).c_str(), 1);
    pid = fork();
    if (pid == 0) {
      execl("/proc/self/exe", "victim", "[.victim]", "--out", "/dev/null", nullptr);
      _exit(127);
    }
    REQUIRE(pid > 0);
  }
  ~Victim() { kill_now(); }
  Victim(const Victim&) = delete;
  Victim& operator=(const Victim&) = delete;
  /// Sends kill -9. Returns true if the process was alive until then.
  bool kill_now() { return WIFSIGNALED(end(SIGKILL)); }
  /// Asks the process to end. Returns true if it ends without an error, or was not listening yet.
  bool leave() {
    const int status = end(SIGTERM);
    return status == 0 || (WIFSIGNALED(status) && WTERMSIG(status) == SIGTERM);
  }

  std::string name;  ///< name of the endpoint's participant
  pid_t pid = 0;

 private:
  int end(int signal) {
    if (pid <= 0) return 0;
    kill(pid, signal);
    int status = 0;
    waitpid(pid, &status, 0);
    pid = 0;
    return status;
  }
};

TEST_CASE("a process killed with kill -9 leaves no shared memory behind") {
  {
    const std::string path = "/dev/shm/sidestep-test-" + std::to_string(getpid());
    const std::ofstream file(path);
    std::filesystem::remove(path);
    REQUIRE_FALSE(shared_memory_of(getpid()).empty());  // the search finds a deleted file that is still open
  }
  DdsBus bus(test_settings());
  int received = 0;
  bus.subscribe<msg::Verdict>(topics::kVerdict, 1, [&](const msg::Verdict&) { ++received; });
  Victim victim;
  CHECK(run_until([&] { return received > 5; }, bus));
  CHECK(shared_memory_of(victim.pid).empty());  // so nothing can remain after its death
  CHECK(victim.kill_now());
}

/// Stops `count` processes at once for a random time of up to twice the silence limit, and requires that each
/// one is heard again and hears us. Repeats this `rounds` times.
void stop_and_continue(int rounds, std::size_t count, std::uint64_t seed) {
  CAPTURE(seed);
  Rng rng(seed);
  DdsListener listener(test_settings("listener"));
  DdsBus bus(test_settings());
  std::map<std::uint32_t, std::uint64_t> answered;  // by victim
  for (std::uint32_t robot = 1; robot <= count; ++robot) {
    bus.subscribe<msg::Verdict>(topics::kVerdict, robot, [&answered, robot](const msg::Verdict& verdict) {
      answered[robot] = verdict.proposal_number();
    });
  }
  auto writer = bus.advertise(topics::kWorld);
  msg::WorldState world;
  world.header().sender(static_cast<std::uint32_t>(Sender::kVision));
  const auto talk_until = [&](auto condition) {
    const auto talk = [&] {
      writer.publish(world, bus.now());
      return condition();
    };
    return run_until(talk, bus, listener);
  };
  std::vector<std::unique_ptr<Victim>> victims;
  for (std::uint32_t robot = 1; robot <= count; ++robot) victims.push_back(std::make_unique<Victim>(robot));
  const auto all_have_answered = [&](std::uint64_t number) {
    for (std::uint32_t robot = 1; robot <= count; ++robot) {
      if (answered[robot] <= number || !is_known(listener, victims[robot - 1]->name)) return false;
    }
    return true;
  };
  REQUIRE(talk_until([&] { return all_have_answered(0); }));
  for (int round = 0; round < rounds; ++round) {
    CAPTURE(round);
    std::vector<Time> until;
    for (std::size_t i = 0; i < count; ++i) {
      REQUIRE(kill(victims[i]->pid, SIGSTOP) == 0);
      // The first victim is stopped long enough to be forgotten in any case; the others may not be.
      until.push_back(bus.now() + kSilenceLimit +
                      (i == 0 ? from_seconds(2) : from_seconds(rng.uniform(-1, 4))));
    }
    // When victims announce their readers to these participants, they send heartbeats to all participants.
    std::vector<std::unique_ptr<DdsBus>> others;
    for (int i = 0; i < 5; ++i)
      subscribe_to_many(*others.emplace_back(std::make_unique<DdsBus>(test_settings("other"))));
    std::vector<bool> is_stopped(count, true);
    bool was_forgotten = false;
    REQUIRE(talk_until([&] {
      was_forgotten = was_forgotten || !is_known(listener, victims[0]->name);
      for (std::size_t i = 0; i < count; ++i) {
        if (is_stopped[i] && bus.now() >= until[i] && kill(victims[i]->pid, SIGCONT) == 0)
          is_stopped[i] = false;
      }
      return std::ranges::none_of(is_stopped, std::identity());
    }));
    CHECK(was_forgotten);
    const std::uint64_t last = world.header().message_number();
    REQUIRE(talk_until([&] { return all_have_answered(last); }));
  }
}

TEST_CASE("a process that was stopped and forgotten reconnects, even if others joined in the meantime",
          "[half-core][slow]") {
  stop_and_continue(2, 3, 1);
}

TEST_CASE("a process that was stopped and forgotten reconnects after two hundred pauses", "[.long][slow]") {
  stop_and_continue(10, 20, 2);
}

/// Starts neighbours one after another and ends each after a random time, half of them by kill -9. Requires
/// that no other process aborts or loses contact.
void let_neighbours_leave(int times, std::uint64_t seed) {
  CAPTURE(seed);
  Rng rng(seed);
  DdsBus bus(test_settings());
  std::map<std::uint32_t, std::uint64_t> answered;
  for (const std::uint32_t robot : {1u, 2u}) {
    bus.subscribe<msg::Verdict>(topics::kVerdict, robot, [&answered, robot](const msg::Verdict& verdict) {
      answered[robot] = verdict.proposal_number();
    });
  }
  auto writer = bus.advertise(topics::kWorld);
  msg::WorldState world;
  world.header().sender(static_cast<std::uint32_t>(Sender::kVision));
  const auto talk_until = [&](auto condition) {
    return run_until(
        [&] {
          writer.publish(world, bus.now());
          return condition();
        },
        bus);
  };
  Victim witness(1);
  REQUIRE(talk_until([&] { return answered[1] > 0; }));
  for (int i = 0; i < times; ++i) {
    CAPTURE(i);
    Victim neighbour(2);
    if (rng.chance(0.5)) REQUIRE(talk_until([&] { return answered[2] > 0; }));
    const Time until = bus.now() + from_seconds(rng.uniform(0, 0.2));
    REQUIRE(talk_until([&] { return bus.now() >= until; }));
    if (rng.chance(0.5))
      CHECK(neighbour.kill_now());
    else
      CHECK(neighbour.leave());
    answered[2] = 0;
    const std::uint64_t last = world.header().message_number();
    REQUIRE(talk_until([&] { return answered[1] > last; }));
  }
  CHECK(witness.kill_now());
}

TEST_CASE("neighbours that leave at any moment do not disturb other processes") {
  let_neighbours_leave(10, 3);
}

TEST_CASE("two hundred neighbours that leave at any moment do not disturb other processes", "[.long][slow]") {
  let_neighbours_leave(200, 4);
}

TEST_CASE("a listener knows a process while it is alive and forgets it seconds after it is killed",
          "[half-core]") {
  DdsListener listener(test_settings("listener"));
  Victim victim;
  REQUIRE(run_until([&] { return is_known(listener, victim.name); }, listener));
  bool is_alive = true;
  for (const Time end = listener.now() + kSilenceLimit * 5 / 4; is_alive && listener.now() < end;) {
    listener.run_until(listener.now() + kStep);
    is_alive = is_known(listener, victim.name);
  }
  CHECK(is_alive);
  CHECK(victim.kill_now());
  CHECK(run_until([&] { return !is_known(listener, victim.name); }, listener));
}

}  // namespace sidestep::robustness_test
