// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <set>

#include "tests/faults/launched_run.hpp"

using namespace sidestep;

namespace {

constexpr int kKills = 20;

/// Measures when robots execute versions that a new coordinator granted.
class TakeoverWatch {
 public:
  TakeoverWatch(DdsBus& bus, int robots) {
    bus.subscribe(topics::kCoordinator, std::function([this](const msg::CoordinatorState& state) {
                    if (state.coordinator_mode() == msg::COORDINATOR_STANDBY) {
                      standbys_.insert(state.coordinator());
                    } else {
                      standbys_.erase(state.coordinator());
                      if (state.epoch() > epoch_) active_ = state.coordinator();
                      epoch_ = std::max<std::uint64_t>(epoch_, state.epoch());
                    }
                  }));
    for (std::uint32_t robot = 0; robot < static_cast<std::uint32_t>(robots); ++robot) {
      bus.subscribe(topics::kVerdict, robot, std::function([this, robot](const msg::Verdict& verdict) {
                      if (verdict.epoch() > killed_epoch_ && verdict.granted_version() != 0)
                        granted_.emplace(robot, verdict.granted_version());
                    }));
      bus.subscribe(
          topics::kFeedback, robot, std::function([this, robot](const msg::Feedback& feedback) {
            const auto granted = granted_.find(robot);
            if (granted == granted_.end() || feedback.executing().version_number() < granted->second) return;
            moving_.emplace(robot, time_from_ns(feedback.valid_at_ns()));
          }));
    }
  }

  std::uint32_t active() const { return active_; }
  bool is_ready() const { return epoch_ != 0 && standbys_.size() == 1 && !standbys_.count(active_); }
  void on_kill() {
    killed_epoch_ = epoch_;
    standbys_.clear();  // until they announce themselves again
    granted_.clear();
    moving_.clear();
  }
  /// When this many robots had executed versions that the new coordinator granted.
  std::optional<Time> moving(std::size_t robots) const {
    if (moving_.size() < robots) return std::nullopt;
    std::vector<Time> times;
    for (const auto& [robot, at] : moving_) times.push_back(at);
    std::sort(times.begin(), times.end());
    return times[robots - 1];
  }

 private:
  std::uint64_t epoch_ = 0, killed_epoch_ = ~std::uint64_t{0};
  std::uint32_t active_ = 0;
  std::set<std::uint32_t> standbys_;
  std::map<std::uint32_t, std::uint64_t> granted_;
  std::map<std::uint32_t, Time> moving_;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

TEST_CASE("the standby takes over twenty times while robots move, without contact") {
  LaunchedRun run(shuttles(100, "coordinators: 2\nrestart: [coordinator]\n"));
  TakeoverWatch watch(run.bus(), 8);
  std::vector<double> first_ms, half_ms;
  for (int i = 0; i < kKills; ++i) {
    INFO("kill " << i << "\n" << run.output());
    REQUIRE(run.wait_until([&] { return watch.is_ready() && run.max_speed_mps() > 1; }));
    const std::string active =
        watch.active() == 0 ? "coordinator" : "coordinator " + std::to_string(watch.active());
    const pid_t pid = run.pid_of(active);
    REQUIRE(pid > 0);
    watch.on_kill();
    const Time killed_at = run.bus().now();
    REQUIRE(kill(pid, SIGKILL) == 0);
    REQUIRE(run.wait_until([&] { return watch.moving(4).has_value(); }));
    first_ms.push_back(to_seconds(*watch.moving(1) - killed_at) * 1e3);
    half_ms.push_back(to_seconds(*watch.moving(4) - killed_at) * 1e3);
  }
  REQUIRE(kill(run.pid(), SIGINT) == 0);
  CHECK(run.wait_for_end() == "exit code 1");
  INFO(run.output());
  require_no_violations(run.report());
  CHECK(run.report()["deaths"].size() == kKills);
  const auto [min, max] = std::minmax_element(first_ms.begin(), first_ms.end());
  WARN(
      "from kill -9 of the active coordinator until the first robot executes a version of the standby: "
      "median "
      << median(first_ms) << " ms of " << kKills << " (" << *min << " to " << *max
      << "), until half of the robots do: median " << median(half_ms) << " ms");
}
