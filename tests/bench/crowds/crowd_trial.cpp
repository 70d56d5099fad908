// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/crowd_trial.hpp"

#include <algorithm>
#include <chrono>

#include "deploy/trial/simulate/system/sim_system.hpp"

namespace sidestep {
namespace {

constexpr Duration kStartupTimeout = std::chrono::seconds(20);
/// An agent may plan for up to 20 ms.
constexpr Duration kInterrupted = std::chrono::milliseconds(30);

/// The mean of the durations in a histogram, each counted as the middle of its bucket.
double mean_us(const DurationHistogram& histogram) {
  double sum_s = 0, lower_s = 0;
  std::uint64_t count = 0;
  for (std::size_t i = 0; DurationHistogram::upper_edge(i) <= kInterrupted; ++i) {
    const double upper_s = to_seconds(DurationHistogram::upper_edge(i));
    sum_s += static_cast<double>(histogram.buckets()[i]) * (lower_s + upper_s) / 2;
    count += histogram.buckets()[i];
    lower_s = upper_s;
  }
  return count > 0 ? 1e6 * sum_s / static_cast<double>(count) : 0;
}

}  // namespace

Report drive_crowd(const Scenario& scenario, std::uint64_t seed) {
  SimSystem system(scenario, seed);
  while (!system.metrics().granting_since() && system.now() < system.begin() + kStartupTimeout)
    system.run_for(scenario.cycle);
  if (const auto since = system.metrics().granting_since())
    system.run_until_arrived(*since + from_seconds(scenario.time_limit_s));
  Report report = system.metrics().report();
  report.program = "bench crowds";
  report.seed = seed;
  report.trace = system.metrics().floor_trace();
  return report;
}

CrowdResult crowd_result_of(const Report& report) {
  CrowdResult result;
  result.robots = report.robots;
  result.arrived = report.arrived;
  result.contacts = report.contacts;
  result.violations = report.firmware_violations;
  if (report.audit) result.violations += report.audit->violations;
  if (report.verdict() == AuditVerdict::kNotJudged) ++result.violations;
  result.makespan_s = report.makespan_s;
  if (report.makespan_s) result.ratio = report.straight_line_time_ratio;
  result.cpu_us = mean_us(report.plan);
  return result;
}

}  // namespace sidestep
