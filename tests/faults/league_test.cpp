// SPDX-License-Identifier: Apache-2.0
// The league's packets between real processes, over real multicast on the loopback interface.
#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <sstream>

#include "common/config/scenario_loader.hpp"
#include "common/league/log_file.hpp"
#include "common/league/multicast.hpp"
#include "common/league/tracked_packet.hpp"
#include "common/league/vision_packet.hpp"
#include "common/random/rng.hpp"
#include "deploy/monitor/audit/auditor.hpp"
#include "deploy/monitor/metrics/run_metrics.hpp"
#include "deploy/launch/process_group.hpp"
#include "tests/faults/launched_run.hpp"
#include "tests/own_endpoint.hpp"

using namespace sidestep;

namespace {

using Words = std::vector<std::string>;

/// Processes of one system that a test starts one by one, in a domain and groups of their own. None outlives
/// this object, and a sanitizer's complaint about any of them fails the test.
class Floor {
 public:
  Floor()
      : folder_(std::filesystem::temp_directory_path() / ("sidestep-league-" + vision_port())),
        group_((std::filesystem::create_directories(folder_), log_file())),
        bus_(own_.domain().settings("judge")) {
    std::ofstream(scenario_file()) << shipped_scenario("crossing");
    scenario_ = load_scenario(scenario_file());
    bus_.subscribe<msg::WorldState>(topics::kWorld, [this](const msg::WorldState& world) { world_ = world; });
    bus_.subscribe<msg::GroundTruth>(topics::kTruth,
                                     [this](const msg::GroundTruth& truth) { truth_ = truth; });
  }
  ~Floor() {
    (void)group_.terminate(std::chrono::seconds(10));
    const std::string text = log();
    for (const char* complaint : {"Sanitizer: ", ": runtime error: "}) {
      if (text.find(complaint) != std::string::npos) FAIL_CHECK(text);
    }
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  Floor(const Floor&) = delete;
  Floor& operator=(const Floor&) = delete;

  /// One of the system's processes.
  pid_t start(const std::string& name, const std::string& program, const Words& more = {}) {
    Words words{"--scenario", scenario_file(), "--domain", std::to_string(own_.domain().number())};
    words.insert(words.end(), more.begin(), more.end());
    return run(name, program, words);
  }
  pid_t run(const std::string& name, const std::string& program, const Words& arguments) {
    Words argv{program_beside_own(program)};
    argv.insert(argv.end(), arguments.begin(), arguments.end());
    ends_.erase(name);
    return group_.start({name, argv, false});
  }
  pid_t start_simulator() { return start("simulator", "sidestep-simulator", {"--ssl-vision", own_.text(0)}); }
  void start_vision(const Words& more = {}) {
    Words words{"--source", "ssl", "--ssl-vision", own_.text(0)};
    words.insert(words.end(), more.begin(), more.end());
    start("vision", "sidestep-vision", words);
  }

  /// Listens until the condition holds; false when it does not within a minute.
  template <typename Condition>
  bool until(Condition condition) {
    const Time deadline = bus_.now() + std::chrono::minutes(1);
    while (!condition()) {
      if (bus_.now() > deadline) return false;
      bus_.run_until(bus_.now() + Duration{2'000'000});
      for (const ChildEvent& event : group_.poll(std::chrono::milliseconds(0)))
        ends_[event.name] = event.reason;
    }
    return true;
  }
  /// All robots in the world, where they are.
  bool sees_all() const {
    if (world_.robots().size() != scenario_.robots.size()) return false;
    return std::all_of(world_.robots().begin(), world_.robots().end(),
                       [this](const msg::TrackedRobot& robot) { return distance_m(robot) < 0.05; });
  }
  double distance_m(const msg::TrackedRobot& robot) const {
    for (const auto& real : truth_.robots()) {
      if (real.robot() == robot.robot())
        return std::hypot(real.x_m() - robot.x_m(), real.y_m() - robot.y_m());
    }
    return 1e9;
  }
  std::optional<std::string> end_of(const std::string& name) const {
    const auto found = ends_.find(name);
    return found == ends_.end() ? std::nullopt : std::optional(found->second);
  }
  std::string log() const {
    std::ostringstream text;
    text << std::ifstream(log_file()).rdbuf();
    return text.str();
  }
  bool logged(const std::string& words) const { return log().find(words) != std::string::npos; }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  const OwnEndpoint& own() const { return own_; }
  DdsBus& bus() { return bus_; }
  const Scenario& scenario() const { return scenario_; }
  const msg::WorldState& world() const { return world_; }
  const msg::GroundTruth& truth() const { return truth_; }

 private:
  std::string vision_port() const { return std::to_string(own_.endpoint().port); }
  std::string log_file() const { return file("floor.log"); }
  std::string scenario_file() const { return file("crossing.yaml"); }

  OwnEndpoint own_;
  std::filesystem::path folder_;
  ProcessGroup group_;
  DdsBus bus_;
  Scenario scenario_;
  msg::WorldState world_;
  msg::GroundTruth truth_;
  std::map<std::string, std::string> ends_;
};

/// Compares tracked packets with the floor's truth while they come.
class TrackedWatch {
 public:
  explicit TrackedWatch(Floor& floor) : receiver_(floor.own().endpoint(1), league::kLeagueInterface) {
    floor.bus().watch(receiver_.descriptor(), [this, &floor] {
      receiver_.receive([&](std::span<const std::byte> datagram, const league::Endpoint&) {
        const auto decoded = league::decode_tracked(datagram);
        if (!decoded.packet || !decoded.packet->frame) return void(++refused_);
        ++packets_;
        compare(*decoded.packet->frame, floor);
      });
    });
  }
  int packets() const { return packets_; }
  int refused() const { return refused_; }
  int robots() const { return robots_; }
  double worst_m() const { return worst_m_; }

 private:
  void compare(const league::TrackedFrame& frame, const Floor& floor) {
    const Duration age = frame.at - Duration{floor.truth().at_ns()};
    // Truth comes 60 times a second, and is compared with what is said of the same moment.
    if (std::chrono::abs(age) > std::chrono::milliseconds(20)) return;
    for (const league::TrackedRobot& robot : frame.robots) {
      const RobotSpec* const spec =
          robot.team ? find_robot(floor.scenario(), *robot.team, robot.number) : nullptr;
      REQUIRE(spec);
      for (const auto& real : floor.truth().robots()) {
        if (real.robot() != spec->id) continue;
        const Vec2 then = Vec2(real.x_m(), real.y_m()) + to_seconds(age) * Vec2(real.vx_mps(), real.vy_mps());
        worst_m_ = std::max(worst_m_, (robot.position_m - then).norm());
        ++robots_;
      }
    }
  }

  league::MulticastReceiver receiver_;
  int packets_ = 0, refused_ = 0, robots_ = 0;
  double worst_m_ = 0;
};

}  // namespace

TEST_CASE("the launcher passes options for the league on to the simulator and to vision") {
  const OwnEndpoint own;
  league::MulticastReceiver receiver(own.endpoint(1), league::kLeagueInterface);
  LaunchedRun run(shipped_scenario("crossing"),
                  {"--simulator=--ssl-vision " + own.text(0),
                   "--vision=--source ssl --ssl-vision " + own.text(0) + " --tracked " + own.text(1)});
  CHECK(run.wait_for_end() == "exit code 0");
  INFO(run.output());
  CHECK(run.report()["arrived"] == 8);
  int frames = 0;
  receiver.receive([&](std::span<const std::byte> datagram, const league::Endpoint&) {
    const auto decoded = league::decode_tracked(datagram);
    frames += decoded.packet && decoded.packet->frame;
  });
  CHECK(frames > 10);
}

TEST_CASE("robots that are seen over the league's packets cross the floor and arrive without a contact") {
  Floor floor;
  RunMetrics judge(floor.scenario());
  Auditor auditor(floor.scenario(), {});
  judge.include(auditor);
  listen(floor.bus(), floor.scenario(), auditor);
  floor.bus().subscribe<msg::GroundTruth>(topics::kTruth, [&](const auto& truth) { judge.on_truth(truth); });
  floor.bus().subscribe<msg::AgentStatus>(topics::kStatus,
                                          [&](const auto& status) { judge.on_status(status); });
  floor.bus().subscribe<msg::CoordinatorState>(topics::kCoordinator,
                                               [&](const auto& state) { judge.on_coordinator(state); });
  TrackedWatch tracked(floor);
  floor.start_simulator();
  floor.start_vision({"--tracked", floor.own().text(1)});
  floor.start("coordinator", "sidestep-coordinator");
  REQUIRE(floor.until([&] { return floor.sees_all(); }));
  for (const RobotSpec& robot : floor.scenario().robots) {
    floor.start("agent " + std::to_string(robot.id), "sidestep-agent", {"--robot", std::to_string(robot.id)});
    const Time next = floor.bus().now() + std::chrono::milliseconds(100);
    REQUIRE(floor.until([&] { return floor.bus().now() >= next; }));
  }
  CHECK(floor.until([&] { return judge.all_arrived(); }));
  INFO(floor.log());
  const Report report = judge.report();
  CHECK(judge.arrived() == 8);
  CHECK(report.contacts == 0);
  CHECK(auditor.totals().violations == 0);
  CHECK(tracked.refused() == 0);
  CHECK(tracked.packets() > 100);
  CHECK(tracked.robots() > 800);
  // The tracker's error where robots accelerate, and truth that is 20 ms old at most.
  CHECK(tracked.worst_m() < 0.03);
}

TEST_CASE("a log of the league's packets is recorded and shows vision the same robots when it is replayed") {
  Floor floor;
  const std::string log = floor.file("floor.ssl");
  const Words groups{"--ssl-vision",      floor.own().text(0), "--tracked",
                     floor.own().text(1), "--referee",         floor.own().text(2)};
  Words recording{"record", log}, replaying{"replay", log, "--seek", "0.5"};
  recording.insert(recording.end(), groups.begin(), groups.end());
  replaying.insert(replaying.end(), groups.begin(), groups.end());

  const pid_t recorder = floor.run("recorder", "sidestep-vision", recording);
  REQUIRE(floor.until([&] { return floor.logged("until SIGINT"); }));
  const pid_t simulator = floor.start_simulator();
  floor.start_vision();
  REQUIRE(floor.until([&] { return floor.sees_all(); }));
  const Time recorded = floor.bus().now() + std::chrono::seconds(3);
  REQUIRE(floor.until([&] { return floor.bus().now() >= recorded; }));
  REQUIRE(kill(recorder, SIGINT) == 0);
  REQUIRE(floor.until([&] { return floor.end_of("recorder").has_value(); }));
  CHECK(floor.end_of("recorder") == "exit code 0");

  league::LogReader reader(log);
  league::LogRecord record;
  std::uint64_t packets = 0, geometries = 0;
  while (reader.next(record)) {
    const auto decoded = league::decode_vision(record.bytes);
    REQUIRE(decoded.packet);
    geometries += decoded.packet->geometry ? 1 : 0;
    ++packets;
  }
  CHECK(reader.end() == league::LogEnd::kWhole);
  CHECK(packets > 300);
  CHECK(geometries >= 1);

  REQUIRE(kill(simulator, SIGKILL) == 0);
  REQUIRE(floor.until([&] { return floor.world().robots().empty(); }));
  floor.run("replay", "sidestep-vision", replaying);
  CHECK(floor.until([&] { return floor.sees_all(); }));
  REQUIRE(floor.until([&] { return floor.end_of("replay").has_value(); }));
  INFO(floor.log());
  CHECK(floor.end_of("replay") == "exit code 0");
  CHECK(floor.logged("0 tracked and 0 referee packets sent, 0 failed"));
}

TEST_CASE("vision goes on seeing all robots while somebody floods it with garbage") {
  Floor floor;
  floor.start_simulator();
  floor.start_vision();
  REQUIRE(floor.until([&] { return floor.sees_all(); }));
  league::MulticastSender sender(floor.own().endpoint(0), league::kLeagueInterface);
  Rng rng(5);
  std::vector<std::byte> garbage;
  const auto number = floor.world().head().message_number();
  int sent = 0;
  CHECK(floor.until([&] {
    garbage.resize(rng.below(2000));
    for (std::byte& byte : garbage) byte = static_cast<std::byte>(rng.bits());
    (void)sender.send(garbage);
    return ++sent >= 1000;
  }));
  REQUIRE(floor.until([&] { return floor.world().head().message_number() > number + 60; }));
  INFO(floor.log());
  CHECK(floor.sees_all());
  CHECK_FALSE(floor.end_of("vision"));
  CHECK(floor.logged("packet(s) refused so far"));
}
