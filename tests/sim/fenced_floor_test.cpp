// SPDX-License-Identifier: Apache-2.0
// Bases with latency, driven as by sidestep-robot, while agents restart
// or run twice.
#include <algorithm>
#include <cstdlib>
#include <map>

#include "agents/agent/agent_node.hpp"
#include "agents/agent/planning_scratch.hpp"
#include "common/config/scenario_loader.hpp"
#include "coordinator/coordinator_node.hpp"
#include "deploy/audit/auditor.hpp"
#include "tests/catch.hpp"
#include "tests/sim/driven_floor.hpp"
#include "vision/tracking/vision_node.hpp"

namespace sidestep::fenced_floor_test {
namespace {

using namespace std::chrono_literals;

constexpr Time kBegin = time_from_ns(1'000'000'000'000);
// Warm-up, after which all robots know their poses and drive.
constexpr Duration kWarmUp = 8s;

/// Eight robots that drive back and forth across each other's paths.
Scenario shuttles() {
  Scenario scenario =
      load_scenario(std::string(SIDESTEP_SOURCE_DIR) + "/deploy/scenarios/league/crossing.yaml");
  scenario.obstacles.clear();
  for (RobotSpec& robot : scenario.robots) {
    const Goal there = robot.goals.front(), back{robot.start_m};
    for (int lap = 0; lap < 200; ++lap) robot.goals.push_back(lap % 2 ? there : back);
  }
  return scenario;
}

struct Outcome {
  std::uint64_t contacts = 0, violations = 0;
  int own_stops = 0;  ///< own stops after the warm-up, not counting drifts
  int drifts = 0;     ///< own stops of robots that had drifted, which also happen without restarts
  int restarts = 0, twins = 0;
  double driven_m = 0;
  std::string first_violation;
};

class FencedFloor {
 public:
  /// `latency` is the time from a command to a base's first motion.
  FencedFloor(std::uint64_t seed, Duration latency)
      : scenario_(shuttles()),
        network_(seed, kBegin, scenario_.network),
        floor_(network_, scenario_, bases_with_latency(latency).floor.bases, latency, seed),
        coordinator_(coordinator_bus_, scenario_, {0, static_cast<Incarnation>(to_ns(kBegin))}, false),
        scratch_(std::make_shared<PlanningScratch>(scenario_)) {
    observer_.become_observer();
    listen(observer_, scenario_, auditor_);
    auditor_.on_violation([this](const Violation& violation) {
      if (outcome_.first_violation.empty()) outcome_.first_violation = to_line(violation);
    });
    observer_.subscribe(topics::kTruth,
                        [this](const msg::GroundTruth& truth) { outcome_.contacts = truth.contacts(); });
    for (const RobotSpec& robot : scenario_.robots) {
      observer_.subscribe(
          topics::kFeedback, robot.id,
          [this, id = robot.id](const msg::Feedback& robot_report) { on_robot_report(id, robot_report); });
      start(robot.id);
    }
  }

  void run(Duration duration) { network_.run_until(network_.now() + duration); }
  RobotId random_robot(Rng& rng) const { return scenario_.robots[rng.below(scenario_.robots.size())].id; }
  /// Starts another agent of the robot; its running agents continue.
  void start(RobotId robot) {
    Agent agent{std::make_unique<SimBus>(network_), nullptr};
    agent.node = std::make_unique<AgentNode>(*agent.bus, scenario_, robot,
                                             static_cast<Incarnation>(to_ns(network_.now())), scratch_);
    agents_[robot].push_back(std::move(agent));
  }
  void kill_all(RobotId robot) { agents_[robot].clear(); }
  void restart(RobotId robot, Duration dead_for) {
    kill_all(robot);
    run(dead_for);
    start(robot);
    ++outcome_.restarts;
  }
  void start_twin(RobotId robot) {
    start(robot);
    ++outcome_.twins;
  }
  Outcome outcome() {
    outcome_.violations = auditor_.totals().violations;
    return outcome_;
  }

 private:
  struct Agent {
    std::unique_ptr<SimBus> bus;
    std::unique_ptr<AgentNode> node;
    ~Agent() { bus.reset(); }  // destroyed first, so that it makes no more callbacks
    Agent(std::unique_ptr<SimBus> agent_bus, std::unique_ptr<AgentNode> agent)
        : bus(std::move(agent_bus)), node(std::move(agent)) {}
    Agent(Agent&&) = default;
    Agent& operator=(Agent&&) = default;
  };
  void on_robot_report(RobotId robot, const msg::Feedback& robot_report) {
    if (network_.now() < kBegin + kWarmUp) last_[robot] = robot_report.executing().version_number();
    const Vec2 place_m(robot_report.x_m(), robot_report.y_m());
    const auto [seen, is_first] = places_m_.try_emplace(robot, place_m);
    outcome_.driven_m += (place_m - seen->second).norm();
    seen->second = place_m;
    if (!robot_report.is_off_reference() || robot_report.executing().version_number() == last_[robot]) return;
    last_[robot] = robot_report.executing().version_number();
    const auto index = std::ranges::find(scenario_.robots, robot, &RobotSpec::id) - scenario_.robots.begin();
    const auto& side = floor_.robots().robot(static_cast<std::size_t>(index)).side();
    ++(side.own_stop_reason() == robot::OwnStopReason::kDrifted ? outcome_.drifts : outcome_.own_stops);
  }

  Scenario scenario_;
  SimNetwork network_;
  DrivenFloor floor_;
  SimBus vision_bus_{network_}, coordinator_bus_{network_}, observer_{network_};
  Auditor auditor_{scenario_, {true, {}}};
  VisionNode vision_{vision_bus_, scenario_, 1};
  CoordinatorNode coordinator_;
  std::shared_ptr<PlanningScratch> scratch_;
  std::map<RobotId, std::vector<Agent>> agents_;
  std::map<RobotId, VersionNumber> last_;
  std::map<RobotId, Vec2> places_m_;
  Outcome outcome_;
};

/// Simulates a floor with a random latency. If `is_disturbed`, agents restart, and second agents of the same
/// robots start, at random times.
Outcome run_floor(std::uint64_t seed, Duration length, bool is_disturbed) {
  Rng rng(seed);
  const Duration latency = 1ms * static_cast<int>(18 + rng.below(283));
  FencedFloor floor(seed, latency);
  floor.run(kWarmUp);
  for (Duration left = length; left > 0ms;) {
    const Duration pause = from_seconds(rng.uniform(0, 0.8));
    floor.run(pause);
    left -= pause;
    const RobotId robot = floor.random_robot(rng);
    const double kind = rng.uniform();
    const Duration dead_for = kind < 0.4   ? 0ms
                              : kind < 0.7 ? from_seconds(rng.uniform(0, 0.4))
                                           : from_seconds(rng.uniform(0, 1.5));
    const bool is_twin = rng.chance(0.3);
    if (!is_disturbed) continue;
    if (is_twin)
      floor.start_twin(robot);
    else
      floor.restart(robot, dead_for);
  }
  return floor.outcome();
}

/// Simulates floors for half a minute each until the robots have driven for this many hours in total.
Outcome run_floors(std::uint64_t first_seed, double robot_hours, bool is_disturbed) {
  constexpr Duration kLength = 30s;
  const double hours_each = 8 * to_seconds(kLength) / 3600;
  Outcome sum;
  for (std::uint64_t i = 0; static_cast<double>(i) * hours_each < robot_hours; ++i) {
    const Outcome one = run_floor(first_seed + i, kLength, is_disturbed);
    INFO("seed " << first_seed + i << ", " << one.restarts << " restarts, " << one.twins << " twins; "
                 << one.first_violation);
    CHECK(one.contacts == 0);
    CHECK(one.violations == 0);
    CHECK(one.own_stops == 0);
    sum.contacts += one.contacts;
    sum.violations += one.violations;
    sum.own_stops += one.own_stops;
    sum.drifts += one.drifts;
    sum.restarts += one.restarts;
    sum.twins += one.twins;
    sum.driven_m += one.driven_m;
  }
  return sum;
}

double from_environment(const char* name, double otherwise) {
  const char* const text = std::getenv(name);
  return text ? std::atof(text) : otherwise;
}

}  // namespace

TEST_CASE("restarts and second agents never cause a driven base to leave its version or touch another") {
  const Outcome outcome = run_floors(1, 0.5, true);
  CHECK(outcome.restarts > 100);
  CHECK(outcome.twins > 50);
  CHECK(outcome.driven_m > 200);
}

TEST_CASE(
    "restarts and second agents never cause a driven base to leave its version in a thousand robot-hours",
    "[.][slow]") {
  const double hours = from_environment("SIDESTEP_ROBOT_HOURS", 1000);
  const auto first = static_cast<std::uint64_t>(from_environment("SIDESTEP_FIRST_SEED", 1'000'000));
  const Outcome outcome = run_floors(first, hours, true);
  WARN(hours << " robot-hours, " << outcome.restarts << " restarts, " << outcome.twins << " twins: "
             << outcome.contacts << " contacts, " << outcome.own_stops << " own stops, " << outcome.drifts
             << " of drift, " << outcome.violations << " violations, " << outcome.driven_m / 1000 << " km");
}

TEST_CASE("driven bases make no own stop if their agents do not restart", "[.][slow]") {
  const Outcome outcome = run_floors(1, 0.5, false);
  WARN(outcome.own_stops << " own stops, " << outcome.drifts << " of drift, " << outcome.driven_m / 1000
                         << " km");
}

}  // namespace sidestep::fenced_floor_test
