// SPDX-License-Identifier: Apache-2.0
// Orders while hosts are cut off and processes are killed, over DDS,
// where even reliable messages are then lost.
#include <algorithm>
#include <array>
#include <csignal>
#include <fmt/format.h>
#include <set>

#include "common/client/order_client.hpp"
#include "common/protocol/process_names.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/faults/launched_run.hpp"
#include "tests/needs_root.hpp"

namespace sidestep::order_partitions_test {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int kRobots = 6;
constexpr double kAtRest_mps = 0.03;
constexpr Duration kBraking = milliseconds(1500);

/// The host on which the launcher puts the robot's agent.
std::string host_of(RobotId robot) { return std::array{"floor", "east", "west"}[robot % 3]; }

/// Robots without goals, each in a row of its own.
std::string waiting_robots() {
  std::string text =
      "field: {length_m: 6, width_m: 5}\ncoordinators: 2\nrestart: [agents, coordinator]\ntime_limit_s: "
      "7200\nrobots:\n";
  for (int i = 0; i < kRobots; ++i)
    text += fmt::format("  - {{id: {}, start_m: [-2, {}]}}\n", i, -1.5 + 0.6 * i);
  return text;
}

struct Totals {
  int rounds = 0, holds = 0, killed = 0, long_cuts = 0;
  int moved = 0;       ///< robots that moved although they were held
  int accepted = 0;    ///< rounds in which a coordinator accepted the holds
  int unanswered = 0;  ///< rounds in which the holds were not accepted, although the agents were reachable
  int lost = 0;        ///< drive orders that were not carried out after the resume
};

class PartitionRounds {
 public:
  PartitionRounds(LaunchedRun& run, std::uint64_t seed)
      : run_(run),
        holder_(run.bus(), client_id("holder")),
        sender_(run.bus(), client_id("sender")),
        rng_(seed) {}

  /// One round: holds robots while a host is cut off, kills processes before the cut ends, sends the robots
  /// somewhere, and checks whether they move before they are resumed.
  void one() {
    ++totals_.rounds;
    const std::string host = rng_.chance(0.5) ? "west" : "east";
    std::set<RobotId> held;
    while (held.size() < 2) held.insert(static_cast<RobotId>(rng_.below(kRobots)));
    const bool is_cut_first = rng_.chance(0.7);
    if (is_cut_first) fault("partition", host);
    std::vector<OrderHandle> holds;
    for (const RobotId robot : held) holds.push_back(holder_.hold(robot));
    totals_.holds += static_cast<int>(holds.size());
    const bool is_accepted = wait_for(seconds(15), [&] {
      return std::ranges::all_of(
          holds, [&](OrderHandle h) { return holder_.find(h)->phase == OrderPhase::kAccepted; });
    });
    // Only a robot's own agent confirms that the robot is held.
    const bool is_reachable =
        !is_cut_first || std::ranges::none_of(held, [&](RobotId robot) { return host_of(robot) == host; });
    totals_.unanswered += is_reachable && !is_accepted;
    totals_.accepted += is_accepted;
    if (!is_cut_first) fault("partition", host);
    kill_some(held);
    const Duration cut = from_seconds(rng_.chance(0.3) ? rng_.uniform(6.5, 9) : rng_.uniform(0.2, 4));
    totals_.long_cuts += cut > seconds(6);
    bool has_moved = watch_for(cut, held);
    fault("heal", host);
    has_moved = watch_for(from_seconds(rng_.uniform(0, 3)), held) || has_moved;
    std::vector<OrderHandle> orders;
    for (const RobotId robot : held) orders.push_back(sender_.go(robot, {{next_place(robot)}}));
    has_moved = watch_for(seconds(8), held) || has_moved;
    if (is_accepted && has_moved) ++totals_.moved;
    for (const RobotId robot : held) (void)holder_.resume(robot);
    for (const OrderHandle order : orders) {
      const bool has_arrived =
          wait_for(seconds(30), [&] { return sender_.find(order)->phase == OrderPhase::kArrived; });
      totals_.lost += !has_arrived;
    }
  }
  const Totals& totals() const { return totals_; }

 private:
  template <typename Condition>
  bool wait_for(Duration limit, Condition condition) {
    const Time end = run_.bus().now() + limit;
    REQUIRE(run_.wait_until([&] { return condition() || run_.bus().now() > end; }));
    return condition();
  }
  /// Whether one of the robots moves in this time, except in the braking time at its start.
  bool watch_for(Duration time, const std::set<RobotId>& robots) {
    const Time begin = run_.bus().now();
    const std::vector<RobotId> list(robots.begin(), robots.end());
    bool has_moved = false;
    REQUIRE(run_.wait_until([&] {
      const bool brakes = run_.bus().now() < begin + kBraking;
      has_moved = has_moved || (!brakes && run_.max_speed_mps(list) > kAtRest_mps);
      return run_.bus().now() > begin + time;
    }));
    return has_moved;
  }
  void fault(const std::string& what, const std::string& host) {
    CHECK(run_.command({"fault", what, "sidestep-" + std::to_string(run_.pid()) + "-" + host}) ==
          "exit code 0");
  }
  void kill_some(const std::set<RobotId>& held) {
    std::vector<std::string> victims;
    if (rng_.chance(0.7)) victims.push_back("coordinator");
    if (rng_.chance(0.3)) victims.push_back("coordinator 1");
    for (const RobotId robot : held)
      if (rng_.chance(0.6)) victims.push_back(agent_process(robot));
    if (rng_.chance(0.3)) victims.push_back(agent_process(static_cast<RobotId>(rng_.below(kRobots))));
    for (const std::string& victim : victims) {
      const pid_t pid = run_.pid_of(victim);
      if (pid != 0 && is_running(pid)) totals_.killed += kill(pid, SIGKILL) == 0;
    }
  }
  Vec2 next_place(RobotId robot) {
    is_right_[robot] = !is_right_[robot];
    return {is_right_[robot] ? 2.0 : -2.0, -1.5 + 0.6 * robot};
  }

  LaunchedRun& run_;
  OrderClient holder_, sender_;
  Rng rng_;
  Totals totals_;
  std::array<bool, kRobots> is_right_{};
};

void check_rounds(int count, std::uint64_t seed) {
  SIDESTEP_NEEDS_ROOT();
  CAPTURE(seed);
  const auto run = LaunchedRun::on_namespaces(waiting_robots());
  REQUIRE(run->wait_until([&] { return run->printed("the coordinator grants"); }));
  PartitionRounds rounds(*run, seed);
  for (int i = 0; i < count; ++i) rounds.one();
  REQUIRE(kill(run->pid(), SIGINT) == 0);
  (void)run->wait_for_end();
  INFO(run->output());
  const Totals& totals = rounds.totals();
  WARN(totals.rounds << " rounds, " << totals.holds << " holds, " << totals.long_cuts
                     << " cuts of more than six seconds, " << totals.killed << " processes killed: in "
                     << totals.moved << " of " << totals.accepted
                     << " rounds with accepted holds these robots moved, in " << totals.unanswered
                     << " a hold was not accepted, " << totals.lost << " orders were lost");
  CHECK(totals.moved == 0);
  CHECK(totals.accepted > 0);
  CHECK(totals.unanswered == 0);
  CHECK(totals.lost == 0);
  require_no_violations(run->report());
}

TEST_CASE("held robots stay at rest and no order is lost while a host is cut off and processes are killed",
          "[.long][slow]") {
  check_rounds(2, 1);
}

TEST_CASE("held robots stay at rest and no order is lost in fifty partitions with killed processes",
          "[.long][slow]") {
  check_rounds(50, 2);
}

}  // namespace sidestep::order_partitions_test
