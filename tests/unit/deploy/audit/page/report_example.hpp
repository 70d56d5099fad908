// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "common/json/json_text.hpp"
#include "deploy/audit/metrics/report.hpp"

namespace sidestep {

/// The report of a run over DDS of two robots, one of which did not arrive.
inline Report example_report() {
  Report report;
  report.program = "run";
  report.scenario = "hall";
  report.seed = 7;
  report.robots = 2;
  report.arrived = 1;
  report.arrival_s = {{3, 1.25}, {8, std::nullopt}};
  report.not_arrived = {{8, "no path leads to its goal"}};
  report.contacts = 1;
  report.min_clearance_m = 0.0142;
  report.grants = 118;
  report.proposals = 120;
  report.cycles = 200;
  report.missed_cycles = 1;
  report.robot_time_s = 6;
  report.fast_dds = "2.9.1";
  for (int i = 1; i <= 100; ++i) report.negotiation.add(std::chrono::microseconds(10 * i));
  report.plan.add(std::chrono::microseconds(50));
  report.search.add(std::chrono::microseconds(5));
  report.deaths.push_back({"agent 8", "killed by signal 9", 2.5, true});
  report.epochs.push_back({"coordinator", 1'000'000'000'000, {}, -0.5, "started"});
  report.counters["vision"][DropReason::kOtherRules] = 4;
  report.processes["agent 3"] = {0.25, 21.5};
  report.processes["agent 8"] = {0.75, 22.5};
  report.audit = AuditTotals{};
  report.audit->violations = 1;
  Violation violation;
  violation.robot = 8;
  violation.version = 17;
  violation.detail = "<moved> too early";
  violation.detected = time_from_ns(4'000'000'000);
  report.audit->first.push_back(violation);
  FloorTrace& trace = report.trace.emplace();
  trace.zero = time_from_ns(1'000'000'000);
  trace.field = {4, 2};
  trace.speed_limit_mps = 2;
  trace.robots.push_back({3, Team::kBlue, {-1, 0}, {{1, 0}}, {{0, {-1, 0}, 0}, {1.25, {1, 0}, 1}}});
  trace.robots.push_back({8, Team::kBlue, {-1, 0.5}, {{1, 0.5}}, {{0, {-1, 0.5}, 0}}});
  trace.incidents = {{0.5, FloorTrace::kContact, {3, 8}, {-0.5, 0}}};
  return report;
}

inline nlohmann::ordered_json json_of(const Report& report) { return parse_ordered_json(to_json(report)); }

}  // namespace sidestep
