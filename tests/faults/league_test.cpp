// SPDX-License-Identifier: Apache-2.0
// League packets between real processes, over multicast on the loopback interface.
#include <csignal>
#include <fstream>
#include <sstream>

#include "common/config/scenario_loader.hpp"
#include "common/league/log_file.hpp"
#include "common/league/multicast.hpp"
#include "common/league/tracked_packet.hpp"
#include "common/league/vision_packet.hpp"
#include "common/random/rng.hpp"
#include "deploy/audit/auditor.hpp"
#include "deploy/audit/metrics/run_metrics.hpp"
#include "deploy/run/launch/process_group.hpp"
#include "tests/catch.hpp"
#include "tests/faults/launched_run.hpp"
#include "tests/test_endpoint.hpp"

using namespace sidestep;

namespace {

using Arguments = std::vector<std::string>;

/// A system whose processes a test starts one by one, in its own DDS domain and multicast groups. No process
/// outlives this object. A sanitizer error in any of them fails the test.
class LeagueSystem {
 public:
  LeagueSystem()
      : folder_(std::filesystem::temp_directory_path() / ("sidestep-league-" + vision_port())),
        group_((std::filesystem::create_directories(folder_), log_file())),
        bus_(endpoints_.domain().settings("test")) {
    std::ofstream(scenario_file()) << shipped_scenario("crossing");
    scenario_ = load_scenario(scenario_file());
    bus_.subscribe<msg::WorldState>(topics::kWorld, [this](const msg::WorldState& world) { world_ = world; });
    bus_.subscribe<msg::GroundTruth>(topics::kTruth,
                                     [this](const msg::GroundTruth& truth) { truth_ = truth; });
  }
  ~LeagueSystem() {
    (void)group_.terminate(std::chrono::seconds(10));
    const std::string text = log();
    for (const char* complaint : {"Sanitizer: ", ": runtime error: "}) {
      if (text.find(complaint) != std::string::npos) FAIL_CHECK(text);
    }
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  LeagueSystem(const LeagueSystem&) = delete;
  LeagueSystem& operator=(const LeagueSystem&) = delete;

  /// Starts a process of the system.
  pid_t start(const std::string& name, const std::string& program, const Arguments& extra = {}) {
    Arguments arguments{"--scenario", scenario_file(), "--domain",
                        std::to_string(endpoints_.domain().number())};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    return run(name, program, arguments);
  }
  pid_t run(const std::string& name, const std::string& program, const Arguments& arguments) {
    Arguments argv{sibling_program_path(program)};
    argv.insert(argv.end(), arguments.begin(), arguments.end());
    exit_reasons_.erase(name);
    return group_.start({name, argv, false});
  }
  pid_t start_simulator() {
    return start("simulator", "sidestep-simulator", {"--ssl-vision", endpoints_.text(0)});
  }
  void start_vision(const Arguments& extra = {}) {
    Arguments arguments{"--source", "ssl", "--ssl-vision", endpoints_.text(0)};
    arguments.insert(arguments.end(), extra.begin(), extra.end());
    start("vision", "sidestep-vision", arguments);
  }

  /// Receives messages until the condition holds; false on a timeout of one minute.
  template <typename Condition>
  bool wait_until(Condition condition) {
    const Time deadline = bus_.now() + std::chrono::minutes(1);
    while (!condition()) {
      if (bus_.now() > deadline) return false;
      bus_.run_until(bus_.now() + Duration{2'000'000});
      for (const ChildEvent& event : group_.poll(std::chrono::milliseconds(0)))
        exit_reasons_[event.name] = event.reason;
    }
    return true;
  }
  /// Whether the world state has all robots at their true positions.
  bool tracks_all_robots() const {
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
  std::optional<std::string> exit_reason(const std::string& name) const {
    const auto found = exit_reasons_.find(name);
    return found == exit_reasons_.end() ? std::nullopt : std::optional(found->second);
  }
  std::string log() const {
    std::ostringstream text;
    text << std::ifstream(log_file()).rdbuf();
    return text.str();
  }
  bool logged(const std::string& text) const { return log().find(text) != std::string::npos; }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  const TestEndpoint& endpoints() const { return endpoints_; }
  DdsBus& bus() { return bus_; }
  const Scenario& scenario() const { return scenario_; }
  const msg::WorldState& world() const { return world_; }
  const msg::GroundTruth& truth() const { return truth_; }

 private:
  std::string vision_port() const { return std::to_string(endpoints_.endpoint().port); }
  std::string log_file() const { return file("floor.log"); }
  std::string scenario_file() const { return file("crossing.yaml"); }

  TestEndpoint endpoints_;
  std::filesystem::path folder_;
  ProcessGroup group_;
  DdsBus bus_;
  Scenario scenario_;
  msg::WorldState world_;
  msg::GroundTruth truth_;
  std::map<std::string, std::string> exit_reasons_;
};

/// Compares received tracked packets with the ground truth.
class TrackedComparison {
 public:
  explicit TrackedComparison(LeagueSystem& system)
      : receiver_(system.endpoints().endpoint(1), league::kLeagueInterface) {
    system.bus().watch(receiver_.descriptor(), [this, &system] {
      receiver_.receive([&](std::span<const std::byte> datagram, const league::Endpoint&) {
        const auto decoded = league::decode_tracked(datagram);
        if (!decoded.packet || !decoded.packet->frame) return void(++invalid_);
        ++packets_;
        compare(*decoded.packet->frame, system);
      });
    });
  }
  int packets() const { return packets_; }
  int invalid() const { return invalid_; }
  int robots() const { return robots_; }
  double max_error_m() const { return max_error_m_; }

 private:
  void compare(const league::TrackedFrame& frame, const LeagueSystem& system) {
    const Duration age = frame.at - Duration{system.truth().valid_at_ns()};
    // Ground truth arrives at 60 Hz; only packets for nearly the same time are compared.
    if (std::chrono::abs(age) > std::chrono::milliseconds(20)) return;
    for (const league::TrackedRobot& robot : frame.robots) {
      const RobotSpec* const spec =
          robot.team ? find_robot(system.scenario(), *robot.team, robot.number) : nullptr;
      REQUIRE(spec);
      for (const auto& real : system.truth().robots()) {
        if (real.robot() != spec->id) continue;
        const Vec2 expected_m =
            Vec2(real.x_m(), real.y_m()) + to_seconds(age) * Vec2(real.vx_mps(), real.vy_mps());
        max_error_m_ = std::max(max_error_m_, (robot.position_m - expected_m).norm());
        ++robots_;
      }
    }
  }

  league::MulticastReceiver receiver_;
  int packets_ = 0, invalid_ = 0, robots_ = 0;
  double max_error_m_ = 0;
};

}  // namespace

TEST_CASE("the launcher passes league options on to the simulator and vision") {
  const TestEndpoint endpoints;
  league::MulticastReceiver receiver(endpoints.endpoint(1), league::kLeagueInterface);
  LaunchedRun run(shipped_scenario("crossing"), {"--simulator=--ssl-vision " + endpoints.text(0),
                                                 "--vision=--source ssl --ssl-vision " + endpoints.text(0) +
                                                     " --tracked " + endpoints.text(1)});
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  CHECK(ended == "exit code 0");
  CHECK(run.report()["arrived"] == 8);
  int frames = 0;
  receiver.receive([&](std::span<const std::byte> datagram, const league::Endpoint&) {
    const auto decoded = league::decode_tracked(datagram);
    frames += decoded.packet && decoded.packet->frame;
  });
  CHECK(frames > 10);
}

TEST_CASE("robots observed through league packets cross the field and arrive without contact") {
  LeagueSystem system;
  RunMetrics metrics(system.scenario());
  Auditor auditor(system.scenario(), {});
  metrics.set_auditor(auditor);
  listen(system.bus(), system.scenario(), auditor);
  listen(system.bus(), metrics);
  TrackedComparison tracked(system);
  system.start_simulator();
  system.start_vision({"--tracked", system.endpoints().text(1)});
  system.start("coordinator", "sidestep-coordinator");
  REQUIRE(system.wait_until([&] { return system.tracks_all_robots(); }));
  for (const RobotSpec& robot : system.scenario().robots) {
    system.start("agent " + std::to_string(robot.id), "sidestep-agent",
                 {"--robot", std::to_string(robot.id)});
    const Time next = system.bus().now() + std::chrono::milliseconds(100);
    REQUIRE(system.wait_until([&] { return system.bus().now() >= next; }));
  }
  CHECK(system.wait_until([&] { return metrics.all_arrived(); }));
  INFO(system.log());
  const Report report = metrics.report();
  CHECK(metrics.arrived() == 8);
  CHECK(report.contacts == 0);
  CHECK(auditor.totals().violations == 0);
  CHECK(tracked.invalid() == 0);
  CHECK(tracked.packets() > 100);
  CHECK(tracked.robots() > 800);
  // Allows for the tracker's error while robots accelerate, and for ground truth that is up to 20 ms old.
  CHECK(tracked.max_error_m() < 0.03);
}

TEST_CASE("vision tracks the same robots from a replayed log of league packets") {
  LeagueSystem system;
  const std::string log = system.file("floor.ssl");
  const Arguments groups{"--ssl-vision", system.endpoints().text(0), "--tracked", system.endpoints().text(1),
                         "--referee",    system.endpoints().text(2)};
  Arguments recording{"record", log}, replaying{"replay", log, "--seek", "0.5"};
  recording.insert(recording.end(), groups.begin(), groups.end());
  replaying.insert(replaying.end(), groups.begin(), groups.end());

  const pid_t recorder = system.run("recorder", "sidestep-vision", recording);
  REQUIRE(system.wait_until([&] { return system.logged("stop with SIGINT"); }));
  const pid_t simulator = system.start_simulator();
  system.start_vision();
  REQUIRE(system.wait_until([&] { return system.tracks_all_robots(); }));
  const Time recorded = system.bus().now() + std::chrono::seconds(3);
  REQUIRE(system.wait_until([&] { return system.bus().now() >= recorded; }));
  REQUIRE(kill(recorder, SIGINT) == 0);
  REQUIRE(system.wait_until([&] { return system.exit_reason("recorder").has_value(); }));
  CHECK(system.exit_reason("recorder") == "exit code 0");

  league::LogReader reader(log);
  league::LogRecord record;
  std::uint64_t packets = 0, geometries = 0;
  while (reader.next(record)) {
    const auto decoded = league::decode_vision(record.bytes);
    REQUIRE(decoded.packet);
    geometries += decoded.packet->geometry ? 1 : 0;
    ++packets;
  }
  CHECK(reader.status() == league::LogStatus::kComplete);
  CHECK(packets > 300);
  CHECK(geometries >= 1);

  REQUIRE(kill(simulator, SIGKILL) == 0);
  REQUIRE(system.wait_until([&] { return system.world().robots().empty(); }));
  system.run("replay", "sidestep-vision", replaying);
  CHECK(system.wait_until([&] { return system.tracks_all_robots(); }));
  REQUIRE(system.wait_until([&] { return system.exit_reason("replay").has_value(); }));
  INFO(system.log());
  CHECK(system.exit_reason("replay") == "exit code 0");
  CHECK(system.logged("0 tracked and 0 referee packets sent, 0 failed"));
}

TEST_CASE("vision keeps tracking all robots while it is flooded with random packets") {
  LeagueSystem system;
  system.start_simulator();
  system.start_vision();
  REQUIRE(system.wait_until([&] { return system.tracks_all_robots(); }));
  league::MulticastSender sender(system.endpoints().endpoint(0), league::kLeagueInterface);
  Rng rng(5);
  std::vector<std::byte> garbage;
  const auto number = system.world().header().message_number();
  int sent = 0;
  CHECK(system.wait_until([&] {
    garbage.resize(rng.below(2000));
    for (std::byte& byte : garbage) byte = static_cast<std::byte>(rng.bits());
    (void)sender.send(garbage);
    return ++sent >= 1000;
  }));
  REQUIRE(system.wait_until([&] { return system.world().header().message_number() > number + 60; }));
  INFO(system.log());
  CHECK(system.tracks_all_robots());
  CHECK_FALSE(system.exit_reason("vision"));
  CHECK(system.logged("packet(s) rejected so far"));
}
