// SPDX-License-Identifier: Apache-2.0
// Measures how runs end in motion: 22 robots at full speed on bases of others, by each cause. By default a
// few runs; SIDESTEP_END_RUNS=20 makes 20 of each cause and each base.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <stdexcept>

#include "common/geometry/vec2.hpp"
#include "common/motion/limits.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/faults/external_simulator_run.hpp"
#include "tests/faults/figure_table.hpp"

namespace sidestep::end_figures_test {
namespace {

using namespace std::chrono_literals;

constexpr double kAtRest_mps = 0.03, kFast_mps = 0.8;
constexpr std::size_t kFastRobots = 11;
constexpr Duration kRestTime = 500ms, kMaxTime = 150s, kReportTime = 20s;
/// The launcher itself, as a process to which signals are sent.
constexpr const char* kLauncher = "launcher";

struct EndingCause {
  std::string process;  ///< empty: the time limit
  int signal = 0;
  std::string text() const {
    if (process.empty()) return "limit";
    return fmt::format("{} of {}",
                       signal == SIGINT    ? "Ctrl-C"
                       : signal == SIGTERM ? "SIGTERM"
                                           : "SIGKILL",
                       process);
  }
  bool is_death_of_driver() const { return process == "robots" && signal == SIGKILL; }
};

std::vector<EndingCause> all_causes() {
  std::vector<EndingCause> causes{{"", 0}, {kLauncher, SIGINT}};
  for (const char* process : {kLauncher, "robots", "coordinator", "vision", "agent 5"}) {
    causes.push_back({process, SIGTERM});
    causes.push_back({process, SIGKILL});
  }
  return causes;
}

/// A base of others, and how far it drives without commands.
struct StrangeBase {
  std::string name;
  Duration silence, coast;  ///< it keeps its velocity, and then coasts evenly to rest; no coast: it brakes

  std::vector<std::string> options() const {
    return {"--silence-ms", fmt::format("{}", silence / 1ms), "--coast-ms", fmt::format("{}", coast / 1ms)};
  }
  /// Maximum distance after the last command at this speed: it is obeyed 0.1 s late, motors lag by 20 ms, and
  /// ground truth is 20 ms old. From then on the base brakes at 5.9 m/s², unless it coasts.
  double budget_m(double speed_mps) const {
    const double rest_m = coast > 0s ? speed_mps * to_seconds(coast) / 2 : speed_mps * speed_mps / (2 * 5.9);
    return speed_mps * (0.1 + 0.02 + 0.02 + to_seconds(silence)) + rest_m;
  }
};

const StrangeBase kCoasting{"coasts 1.2 s", 100ms, 1200ms}, kHolding{"holds 1 s", 1s, 0s};

/// Ground truth from the moment that ends the run.
class FloorWatch {
 public:
  explicit FloorWatch(const LaunchedRun& run) : run_(run), contacts_(run.truth().contacts()) {
    for (const auto& robot : run.truth().robots()) at_m_[robot.robot()] = {robot.x_m(), robot.y_m()};
  }

  void observe() {
    for (const auto& robot : run_.truth().robots()) {
      const Vec2 now_m(robot.x_m(), robot.y_m());
      const auto before_m = at_m_.find(robot.robot());
      if (before_m == at_m_.end()) continue;
      path_m_[robot.robot()] += (now_m - before_m->second).norm();
      before_m->second = now_m;
    }
  }
  double longest_path_m() const {
    double longest_m = 0;
    for (const auto& [robot, path_m] : path_m_) longest_m = std::max(longest_m, path_m);
    return longest_m;
  }
  std::uint64_t contacts() const { return run_.truth().contacts() - contacts_; }

 private:
  const LaunchedRun& run_;
  std::uint64_t contacts_;
  std::map<RobotId, Vec2> at_m_;
  std::map<RobotId, double> path_m_;
};

bool is_at_full_speed(const LaunchedRun& run) {
  return static_cast<std::size_t>(std::ranges::count_if(run.truth().robots(), [](const auto& robot) {
           return std::hypot(robot.vx_mps(), robot.vy_mps()) >= kFast_mps;
         })) >= kFastRobots;
}

/// Waits until all robots have rested for kRestTime and the run's launcher has ended. False on a timeout.
bool watch_to_rest(LaunchedRun& run, FloorWatch& watch) {
  const Time deadline = run.bus().now() + kMaxTime;
  Time moving_at = run.bus().now();
  while (is_running(run.pid()) || run.bus().now() - moving_at < kRestTime) {
    if (run.bus().now() > deadline) return false;
    run.bus().run_until(run.bus().now() + 2ms);
    watch.observe();
    if (!(run.max_speed_mps() < kAtRest_mps)) moving_at = run.bus().now();
  }
  return true;
}

void judge(const LaunchedRun& run, const EndingCause& cause, const StrangeBase& base, const FloorWatch& watch,
           MeasuredRun& result) {
  if (run.truth().contacts() > watch.contacts()) result.misses.emplace_back("contacts before the end");
  // The control that follows the reference commands a little more than the limit.
  const double budget_m = base.budget_m(1.1 * MotionLimits{}.speed_mps);
  if (cause.is_death_of_driver()) {
    // Whether robots touch depends on the bases alone; how far they drive is budgeted for.
    if (!(watch.longest_path_m() <= budget_m))
      result.misses.push_back(
          fmt::format("drove {:.2f} m, budget {:.2f} m", watch.longest_path_m(), budget_m));
  } else if (watch.contacts() > 0) {
    result.misses.push_back(fmt::format("{} contacts", watch.contacts()));
  }
  const auto report = run.report();
  if (!report.is_object())
    result.misses.emplace_back("no report");
  else if (report["contacts"] != run.truth().contacts())
    result.misses.push_back(fmt::format("the report has {} contacts, ground truth has {}",
                                        report["contacts"].dump(), run.truth().contacts()));
}

MeasuredRun end_run(const EndingCause& cause, const StrangeBase& base, Duration delay) {
  MeasuredRun result{fmt::format("{}, {}", cause.text(), base.name), "", {}};
  const bool is_limit = cause.process.empty();
  ExternalSimulatorRun floor(
      shipped_scenario("league/two-teams-22"), base.options(),
      is_limit ? std::vector<std::string>{"--seconds", fmt::format("{:.2f}", 3 + to_seconds(delay))}
               : std::vector<std::string>{});
  LaunchedRun& run = floor.run();
  std::optional<Time> began;
  const bool is_fast = run.wait_until([&] {
    if (!began && is_at_full_speed(run)) began = run.bus().now();
    return began && (is_limit || (run.bus().now() - *began >= delay && is_at_full_speed(run)));
  });
  if (!is_fast) {
    result.misses.emplace_back("never at full speed");
    return result;
  }
  const double speed_mps = run.max_speed_mps();
  FloorWatch watch(run);
  if (!is_limit) {
    const pid_t pid = cause.process == kLauncher ? run.pid() : run.pid_of(cause.process);
    if (pid <= 0 || kill(pid, cause.signal) != 0) {
      result.misses.emplace_back("no such process");
      return result;
    }
  }
  if (!watch_to_rest(run, watch))
    result.misses.emplace_back("robots moved, or the run went on, for too long");
  // If the launcher was killed, another process writes the report.
  const Time deadline = run.bus().now() + kReportTime;
  while (!run.report().is_object() && run.bus().now() < deadline)
    run.bus().run_until(run.bus().now() + 100ms);
  judge(run, cause, base, watch, result);
  result.figures = fmt::format("from {:.2f} m/s, {:.2f} m, {} contacts", speed_mps, watch.longest_path_m(),
                               watch.contacts());
  return result;
}

void measure(FigureTable& table, const EndingCause& cause, const StrangeBase& base, Rng& rng) {
  const Duration delay = from_seconds(rng.uniform(0, 0.8));
  try {
    table.add(end_run(cause, base, delay));
  } catch (const std::runtime_error& error) {
    table.add({fmt::format("{}, {}", cause.text(), base.name), "", {error.what()}});
  }
}

}  // namespace

TEST_CASE("runs of 22 robots on bases that coast or hold their velocity end without contact",
          "[both-cores][slow]") {
  const int runs = runs_from_environment("SIDESTEP_END_RUNS", 0);
  FigureTable table("The end of a run at full speed: contacts until all rest, by ground truth");
  Rng rng(1);
  if (runs == 0) {
    measure(table, {"", 0}, kCoasting, rng);
    measure(table, {kLauncher, SIGINT}, kHolding, rng);
    measure(table, {"robots", SIGKILL}, kCoasting, rng);
    measure(table, {"vision", SIGKILL}, kHolding, rng);
  }
  for (int run = 0; run < runs; ++run) {
    for (const EndingCause& cause : all_causes()) {
      for (const StrangeBase& base : {kCoasting, kHolding}) measure(table, cause, base, rng);
    }
  }
  table.print();
  CHECK(table.missed() == 0);
}

}  // namespace sidestep::end_figures_test
