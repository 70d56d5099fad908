// SPDX-License-Identifier: Apache-2.0
#include "tests/study/buildings/building_run.hpp"

#include "common/messaging/sim/bus.hpp"
#include "deploy/trial/simulate/campaign/distance_meter.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"

namespace sidestep {
namespace {

constexpr Duration kStep = std::chrono::milliseconds(100);
constexpr Duration kStartup = std::chrono::seconds(1);

double microseconds(Duration duration) { return to_seconds(duration) * 1e6; }

Scenario without_goals(Scenario scenario) {
  for (RobotSpec& robot : scenario.robots) robot.goals.clear();
  return scenario;
}

}  // namespace

BuildingResult building_result(const Report& report, const TripCounts& trips, double distance_m) {
  BuildingResult result;
  result.trips = trips;
  result.contacts = report.contacts;
  result.crashes = report.crashes;
  result.crashes_in_motion = report.crashes_while_moving;
  result.distance_m = distance_m;
  result.route_changes = report.route_changes;
  result.plan_p99_us = microseconds(report.plan.quantile(0.99));
  result.plan_max_us = microseconds(report.plan.max());
  if (report.cycles > 0)
    result.missed_percent =
        100 * static_cast<double>(report.missed_cycles) / static_cast<double>(report.cycles);
  result.audit_passed =
      report.deaths.empty() && report.audit && report.audit->verdict() == AuditVerdict::kPassed;
  return result;
}

BuildingResult run_building(const Scenario& scenario, Duration duration, std::uint64_t seed) {
  SimSystem system(without_goals(scenario), seed);
  DistanceMeter meter(system.begin());
  system.observer_bus().subscribe(topics::kTruth, [&](const msg::GroundTruth& truth) { meter.add(truth); });
  SimBus bus(system.network());
  RandomTrips trips(bus, scenario, seed);
  system.run_for(kStartup);
  const Time end = system.now() + duration;
  while (system.now() < end) {
    trips.update(system.now());
    system.run_for(kStep);
  }
  trips.finish();
  const Time limit = system.now() + RandomTrips::kStuckAfter;
  while (!trips.is_over() && system.now() < limit) {
    trips.update(system.now());
    system.run_for(kStep);
  }
  return building_result(system.metrics().report(), trips.counts(system.now()), meter.total_m());
}

}  // namespace sidestep
