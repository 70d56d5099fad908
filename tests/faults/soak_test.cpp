// SPDX-License-Identifier: Apache-2.0
// Memory of processes that run for a long time.
#include <cstdio>
#include <fmt/format.h>
#include <map>
#include <signal.h>
#include <unistd.h>

#include "tests/catch.hpp"
#include "tests/faults/keyed_run.hpp"
#include "tests/faults/process_usage.hpp"
#include "tests/sanitized.hpp"

using namespace sidestep;

namespace soak_test {

using namespace std::chrono_literals;

struct SoakSettings {
  Duration duration;       ///< duration from the time at which robots start to drive
  Duration warm_up;        ///< samples in this time are ignored, because caches and pools are still filling
  Duration sample_period;  ///< time between two samples of memory
  bool has_keys = false;
};

/// One process of the run.
struct Record {
  ProcessUsage begin, end;  ///< usage after the warm-up, and at the end
  std::vector<MemorySample> samples;

  double slope_mb_per_h() const { return memory_slope_mb_per_h(samples); }
  double cpu_percent() const {
    return 100 * (end.cpu_s - begin.cpu_s) / (samples.back().time_s - samples.front().time_s);
  }
};

struct Soak {
  std::map<std::string, Record> processes;
  nlohmann::json report;

  double missed_share() const {
    return report["missed_cycles"].get<double>() / report["cycles"].get<double>();
  }
  double coverage() const { return report["audit"]["coverage"]["share"].get<double>(); }
};

using Usages = std::map<std::string, ProcessUsage>;

void add(const Usages& usages, double time_s, std::map<std::string, Record>& processes) {
  for (const auto& [name, usage] : usages) {
    Record& record = processes[name];
    if (record.samples.empty()) record.begin = usage;
    record.end = usage;
    record.samples.push_back({time_s, usage.memory_mb});
  }
}

void print_progress(Duration elapsed, const Usages& usages) {
  fmt::print("{:3.0f} min, MB:", to_seconds(elapsed) / 60);
  for (const auto& [name, usage] : usages) fmt::print(" {} {:.2f}", name, usage.memory_mb);
  fmt::print("\n");
  std::fflush(stdout);
}

void print_table(const Soak& soak) {
  fmt::print("{:<14} {:>9} {:>9} {:>11} {:>7}\n", "process", "start MB", "end MB", "slope MB/h", "CPU %");
  for (const auto& [name, record] : soak.processes) {
    fmt::print("{:<14} {:9.2f} {:9.2f} {:11.2f} {:7.1f}\n", name, record.begin.memory_mb,
               record.end.memory_mb, record.slope_mb_per_h(), record.cpu_percent());
  }
  fmt::print("missed cycles {:.3f} %, audit coverage {:.2f} %\n", 100 * soak.missed_share(),
             100 * soak.coverage());
}

/// Measures a run in which eight agents drive back and forth until they are interrupted.
Soak soak(const SoakSettings& settings) {
  // More goals than a robot can reach, because each takes more than two seconds.
  const int goals = static_cast<int>(to_seconds(settings.duration + 1min) / 2);
  const double limit_s = 2 * to_seconds(settings.duration + 1min);
  const std::string scenario = shuttles(goals, "");
  const auto keys = settings.has_keys ? keys_for(scenario) : nullptr;
  std::vector<std::string> arguments{"--seconds", fmt::format("{}", limit_s)};
  if (keys) arguments.insert(arguments.end(), {"--keys", keys->folder()});
  LaunchedRun run(scenario, arguments);
  const bool drives = run.wait_until([&] { return run.max_speed_mps() > 0.8; });
  INFO(run.output().substr(0, 4000));
  REQUIRE(drives);

  Soak result;
  const Time begin = run.bus().now();
  for (Duration due = settings.sample_period; due <= settings.duration; due += settings.sample_period) {
    REQUIRE(run.wait_until([&] { return run.bus().now() - begin >= due; }));
    const Usages usages = usage_of(run);
    if (due >= settings.warm_up) add(usages, to_seconds(run.bus().now() - begin), result.processes);
    if (due % 1min == Duration{0}) print_progress(due, usages);
  }
  REQUIRE(run.max_speed_mps() > 0);
  REQUIRE(kill(run.pid(), SIGINT) == 0);
  CHECK(run.wait_for_end() == "exit code 1");
  result.report = run.report();
  require_no_violations(result.report);
  CHECK(result.report["failure"] == "interrupted, 0 of 8 arrived");
  CHECK(result.report["deaths"].empty());
  print_table(result);
  return result;
}

TEST_CASE("the growth rate of a process's memory is estimated despite noise") {
  std::vector<MemorySample> samples;
  for (int i = 0; i < 330; ++i) samples.push_back({10.0 * i, 20 + 0.5 * (10.0 * i / 3600) + (i % 2) * 0.1});
  CHECK(memory_slope_mb_per_h(samples) == Approx(0.5).margin(0.01));
}

TEST_CASE("the growth rate of a leaking process equals its leak rate") {
  constexpr std::size_t kStep_bytes = 1'000'000;
  constexpr int kSteps = 20;
  std::vector<MemorySample> samples;
  std::vector<std::vector<char>> kept;
  for (int i = 0; i < kSteps; ++i) {
    kept.emplace_back(kStep_bytes, 'x');
    samples.push_back({i * 3600.0, usage_of(getpid()).memory_mb});
  }
  // The allocator may serve the first allocations from memory that was freed earlier.
  CHECK(memory_slope_mb_per_h(samples) == Approx(1).margin(0.3));
}

TEST_CASE("the soak test measures every process while eight agents drive back and forth") {
  const Soak result = soak({8s, 2s, 500ms});
  CHECK(result.processes.size() == 8 + 4);  // simulator, vision, coordinator, launcher
  for (const auto& [name, record] : result.processes) {
    CAPTURE(name);
    CHECK(record.samples.size() == 13);
    CHECK(record.begin.memory_mb > 1);
    CHECK(record.cpu_percent() > 0);
    CHECK(record.end.memory_mb - record.begin.memory_mb < (kIsSanitized ? 40 : 10));
  }
  CHECK(result.report["cycles"] > 1000);
  CHECK(result.coverage() > 0);
}

void check_hour(bool has_keys) {
  const Soak result = soak({60min, 5min, 10s, has_keys});
  CHECK(result.missed_share() <= 0.005);
  CHECK(result.coverage() >= 0.95);
  for (const auto& [name, record] : result.processes) {
    CAPTURE(name);
    CHECK(record.slope_mb_per_h() < 1);
  }
}

TEST_CASE("eight agents drive back and forth for an hour, and no process grows", "[.long][slow]") {
  check_hour(false);
}

TEST_CASE("eight agents with keys drive back and forth for an hour, and no process grows", "[.long][slow]") {
  check_hour(true);
}

}  // namespace soak_test
