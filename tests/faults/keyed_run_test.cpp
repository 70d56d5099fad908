// SPDX-License-Identifier: Apache-2.0
// Measures the cost of keys: compares the same runs with and without keys.
#include "tests/faults/keyed_run.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <signal.h>

#include "tests/catch.hpp"
#include "tests/faults/process_usage.hpp"
#include "tests/faults/takeover_watch.hpp"

namespace sidestep::keyed_run_test {

struct Result {
  double startup_s = 0, missed = 0, p50_ms = 0, p99_ms = 0, cpu = 0, agent_mb = 0;
};

Result drive_22(bool has_keys) {
  const std::string scenario = shipped_scenario("two-teams-22");
  const auto keys = has_keys ? keys_for(scenario) : nullptr;
  LaunchedRun run(scenario,
                  has_keys ? std::vector<std::string>{"--keys", keys->folder()} : std::vector<std::string>{});
  REQUIRE(run.wait_until([&] { return run.max_speed_mps() > 1; }));
  const auto begin = usage_of(run);
  const Time began = run.bus().now();
  REQUIRE(run.wait_until([&] { return run.bus().now() - began > std::chrono::seconds(3); }));
  const auto end = usage_of(run);
  const double duration_s = to_seconds(run.bus().now() - began);
  const std::string ended = run.wait_for_end();
  INFO(run.output());
  // Two cores are barely enough for 26 processes with keys, so the audit may miss too much.
  check_passed_or_missed_messages(run, ended);
  const auto report = run.report();
  require_no_violations(report);
  CHECK(report["arrived"] == 22);
  Result result;
  int agents = 0;
  for (const auto& [name, usage] : end) {
    result.cpu += (usage.cpu_s - begin.at(name).cpu_s) / duration_s;
    if (!name.starts_with("agent")) continue;
    result.agent_mb += usage.memory_mb;
    ++agents;
  }
  result.agent_mb /= agents;
  result.startup_s = report["wall_clock"]["startup_s"];
  result.missed = report["missed_cycles"].get<double>() / report["cycles"].get<double>();
  result.p50_ms = report["negotiation_us"]["p50"].get<double>() / 1e3;
  result.p99_ms = report["negotiation_us"]["p99"].get<double>() / 1e3;
  return result;
}

void print(const char* name, const std::vector<Result>& results) {
  const auto middle = [&](double Result::*member) {
    std::vector<double> values;
    for (const Result& result : results) values.push_back(result.*member);
    return fmt::format("{:.3g} ({:.3g} to {:.3g})", median(values), std::ranges::min(values),
                       std::ranges::max(values));
  };
  WARN(name << ", medians of " << results.size() << " runs (least to most): started after "
            << middle(&Result::startup_s) << " s, missed cycles " << middle(&Result::missed)
            << " of all, negotiation p50 " << middle(&Result::p50_ms) << " ms, p99 "
            << middle(&Result::p99_ms) << " ms, all processes " << middle(&Result::cpu) << " cores, an agent "
            << middle(&Result::agent_mb) << " MB");
}

void compare(int runs) {
  std::vector<Result> open, keyed;
  for (int i = 0; i < runs; ++i) {
    // Alternates the order, so that neither variant is always first.
    for (const bool has_keys : {i % 2 == 0, i % 2 != 0})
      (has_keys ? keyed : open).push_back(drive_22(has_keys));
  }
  print("without keys", open);
  print("with keys", keyed);
}

TEST_CASE("22 robots arrive both with and without keys", "[both-cores][slow]") { compare(1); }

TEST_CASE("22 robots arrive both with and without keys, many times", "[.long][slow]") { compare(7); }

}  // namespace sidestep::keyed_run_test
