// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/streams.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "agents/navigation/motion_control.hpp"
#include "common/config/scenario_loader.hpp"
#include "common/messaging/version_codec.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"

namespace sidestep::bench {
namespace {

constexpr Duration kWarmUp{2'000'000'000};

/// The versions in the latest ledger pages, by robot.
std::map<RobotId, std::vector<Version>> newest_ledger(SimSystem& system, Duration cycle) {
  std::map<std::uint32_t, msg::LedgerPage> pages;
  SimBus bus(system.network());
  bus.subscribe(topics::kLedger,
                std::function([&](const msg::LedgerPage& page) { pages[page.page_index()] = page; }));
  system.run_for(2 * cycle);
  std::map<RobotId, std::vector<Version>> ledger;
  for (const auto& [index, page] : pages) {
    for (const msg::Version& entry : page.versions()) {
      const auto version = decode(entry);
      if (!version) throw std::runtime_error("the coordinator has published an invalid version");
      ledger[version->robot].push_back(*version);
    }
  }
  return ledger;
}

/// The search query of an agent that drives straight to its goal, for the cycle after its newest version
/// starts.
SearchQuery next_query(const Scenario& scenario, const Version& newest) {
  const Time start = newest.trajectory.start() + scenario.cycle;
  const State at_start = newest.trajectory.state_at(start);
  const Vec2 to_goal = find_robot(scenario, newest.robot)->goals.back().position_m - at_start.position_m;
  const AccelerationCommand desired =
      desired_acceleration(to_goal, at_start.velocity_mps, scenario.limits, scenario.cycle, scenario.cycle);
  SearchQuery query;
  query.start = start;
  query.at_start = at_start;
  query.desired_mps2 = desired.acceleration_mps2;
  query.hold_time = desired.hold;
  return query;
}

Snapshot take_snapshot() {
  Snapshot snapshot{load_scenario(SIDESTEP_SCENARIOS "/streams-1000.yaml"), {}};
  SimSystem system(snapshot.scenario, 1);
  while (!system.metrics().granting_since()) system.run_for(snapshot.scenario.cycle);
  system.run_for(kWarmUp);
  for (auto& [id, versions] : newest_ledger(system, snapshot.scenario.cycle)) {
    const auto newest = std::ranges::max_element(versions, {}, &Version::number);
    snapshot.robots.push_back({next_query(snapshot.scenario, *newest), std::move(versions)});
  }
  std::ranges::sort(snapshot.robots, {}, [](const Snapshot::Robot& robot) {
    return robot.query.at_start.position_m.squaredNorm();
  });
  return snapshot;
}

}  // namespace

const Snapshot& crossing_streams() {
  static const Snapshot snapshot = take_snapshot();
  return snapshot;
}

}  // namespace sidestep::bench
