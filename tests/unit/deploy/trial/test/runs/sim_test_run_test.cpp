// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/runs/sim_test_run.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <unistd.h>

#include "common/yaml/config_error.hpp"
#include "deploy/trial/test/test_command.hpp"
#include "tests/catch.hpp"
#include "tests/text_of.hpp"

namespace sidestep::sim_test_run_test {

/// Two robots in separate lanes.
const std::string kLanes =
    "field: {length_m: 6, width_m: 3}\ntime_limit_s: 12\nrobots:\n"
    "  - {id: 1, start_m: [-2, -0.5], goals_m: [[2, -0.5]]}\n"
    "  - {id: 2, start_m: [2, 0.5], goals_m: [[-2, 0.5]]}\n";

TestResult result_of(const std::string& keys) {
  const FaultTest test = parse_fault_test(kLanes + keys, "lanes.yaml");
  return judged(test, run_on_sim_bus(test, 1));
}

void check_passes(const std::string& keys) {
  CAPTURE(keys);
  for (const std::string& failure : result_of(keys).failures()) FAIL_CHECK(failure);
}

TEST_CASE("a test without faults passes and ends soon after the last arrival") {
  const TestResult result = result_of("expect: [{no_contact: all}, {no_violations: true}, {arrived: all}]\n");
  for (const std::string& failure : result.failures()) FAIL_CHECK(failure);
  CHECK(result.run_s > 2);
  CHECK(result.run_s < 6);
}

TEST_CASE("an unmet expectation fails with its line, the time and the reason") {
  const TestResult result = result_of(
      "faults: [{at_s: 1, kill: agent 1}]\nexpect:\n  - {no_contact: all}\n  - {arrived: 1, by_s: 4}\n"
      "  - {moving: 1, after_s: 2, within_s: 1}\n  - {max_speed_mps: 0.5, robots: 2, to_s: 3}\n");
  CHECK_FALSE(result.passed());
  const std::vector<std::string> failures = result.failures();
  REQUIRE(failures.size() == 3);
  CHECK(failures[0] == "at 4.000 s: line 9 expects robot 1 arrived by 4 s, but robot 1 had not arrived");
  CHECK_THAT(failures[1],
             StartsWith("at 3.000 s: line 10 expects robot 1 moving between 2 s and 3 s, but robot 1 "
                        "did not move; its highest speed was 0.0"));
  CHECK_THAT(failures[2],
             StartsWith("at 0.") &&
                 ContainsSubstring("line 11 expects robot 2 not faster than 0.5 m/s from 0 s to 3 "
                                   "s, but robot 2 moved at 0.5"));
  // The robot never arrives, so the run lasts until the time limit.
  CHECK(result.run_s == Approx(12).margin(0.2));
}

TEST_CASE("the same seed gives the same outcome") {
  const std::string keys = "faults: [{at_s: 1, network: all, loss: 0.2}]\nexpect: [{no_contact: all}]\n";
  const FaultTest test = parse_fault_test(kLanes + keys, "lanes.yaml");
  const auto arrivals = [&](std::uint64_t seed) { return run_on_sim_bus(test, seed).history.end.arrival_s; };
  CHECK(arrivals(3) == arrivals(3));
  CHECK(arrivals(3) != arrivals(4));
}

TEST_CASE("process faults kill, restart and pause processes") {
  check_passes(
      "faults: [{at_s: 1, kill: agent 1}, {at_s: 2, restart: agent 1}]\n"
      "expect: [{at_rest: 1, within_s: 0.8}, {moving: 1, after_fault: 1, within_s: 3}, {arrived: all}]\n");
  check_passes(
      "restart: [coordinator]\nfaults: [{at_s: 1, kill: coordinator}]\n"
      "expect: [{moving: all, after_s: 1.8, within_s: 1}, {arrived: all}]\n");
  check_passes(
      "faults: [{at_s: 1, pause: coordinator, seconds: 1}]\n"
      "expect: [{at_rest: all, within_s: 0.8}, {moving: all, after_s: 2, within_s: 2}, {arrived: all}]\n");
  check_passes(
      "coordinators: 2\nfaults: [{at_s: 1, kill: active coordinator}]\n"
      "expect: [{takeover: true, within_ms: 300}, {arrived: all}]\n");
}

TEST_CASE("a partition and a cut of the network end after their durations") {
  check_passes(
      "faults: [{at_s: 1, partition: coordinator, seconds: 1}]\n"
      "expect: [{at_rest: all, within_s: 0.8}, {moving: all, after_s: 2, within_s: 2}, {arrived: all}]\n");
  check_passes(
      "faults: [{at_s: 1, network: agent 1, cut: true, seconds: 1}]\n"
      "expect: [{at_rest: 1, within_s: 0.8}, {moving: 2, after_s: 1.4, within_s: 0.2}, {arrived: all}]\n");
}

TEST_CASE("disturbances of robots are applied, and the coordinator's notices about them are judged") {
  check_passes(
      "faults: [{at_s: 1, lift: 1}, {at_s: 2, place: 1, at_m: [0, -0.5]}]\n"
      "expect: [{no_contact: all}, {moving: 1, after_fault: 1, within_s: 3}, {arrived: all}]\n");
  check_passes(
      "faults: [{at_s: 0.4, switch_off: 1}]\n"
      "expect: [{named: 1, as: displaced, within_s: 1}, {not_arrived: 1}, {arrived: 2}]\n");
}

TEST_CASE("a standby with different rules is named, and a later restart with the test's rules is accepted") {
  const FaultTest test =
      parse_fault_test("coordinators: 2\n" + kLanes +
                           "faults:\n  - {at_s: 0.5, restart: coordinator 1, scenario: ../crossing.yaml}\n"
                           "  - {at_s: 1, restart: coordinator 1}\n  - {at_s: 2, kill: coordinator}\n"
                           "expect: [{mismatch: coordinator 1}, {takeover: true, after_fault: 2, within_s: "
                           "1}, {arrived: all}]\n",
                       SIDESTEP_SOURCE_DIR "/deploy/scenarios/faults/text.yaml");
  for (const std::string& failure : judged(test, run_on_sim_bus(test, 1)).failures()) FAIL_CHECK(failure);
}

TEST_CASE("faults that cannot be applied fail the test with the reason") {
  const TestResult result = result_of(
      "faults:\n  - {at_s: 1, kill: agent 1}\n  - {at_s: 1.5, pause: agent 1, seconds: 1}\n"
      "  - {at_s: 2, attest_absence: 2}\nexpect: [{no_contact: all}]\n");
  const std::vector<std::string> failures = result.failures();
  REQUIRE(failures.size() == 2);
  CHECK(failures[0] == "at 1.500 s: could not pause agent 1: agent 1 is not running");
  CHECK(failures[1] ==
        "at 2.000 s: could not attest the absence of robot 2: the coordinator does not wait for the robot");
}

TEST_CASE("disturbances that the simulator refuses fail the test with the reason") {
  const TestResult result = result_of(
      "faults:\n  - {at_s: 1, place: 1, at_m: [0, -1]}\n  - {at_s: 1.5, switch_on: 2}\n"
      "  - {at_s: 2, lift: 2}\n  - {at_s: 2.5, push: 2, velocity_mps: [0, 1]}\nexpect: [{no_contact: "
      "all}]\n");
  const std::vector<std::string> failures = result.failures();
  CAPTURE(failures);
  REQUIRE(failures.size() == 3);
  CHECK_THAT(failures[0], StartsWith("at 1.000 s: could not place") && EndsWith(": robot 1 is on the floor"));
  CHECK_THAT(failures[1], StartsWith("at 1.500 s: could not switch") && EndsWith(": robot 2 is switched on"));
  CHECK_THAT(failures[2], StartsWith("at 2.500 s: could not push") && EndsWith(": robot 2 is off the floor"));
}

TEST_CASE("a disturbance that is not answered before the test ends fails the test") {
  const FaultTest test = parse_fault_test(
      "field: {length_m: 6, width_m: 3}\ntime_limit_s: 3\nrobots:\n"
      "  - {id: 1, start_m: [-2, -0.5], goals_m: [[2, -0.5]]}\n"
      "faults: [{at_s: 1.5, kill: simulator}, {at_s: 2, lift: 1}]\nexpect: [{not_arrived: 1}]\n",
      "short.yaml");
  const std::vector<std::string> failures = judged(test, run_on_sim_bus(test, 1)).failures();
  CAPTURE(failures);
  CHECK(std::ranges::count_if(failures, [](const std::string& failure) {
          return failure.starts_with("at 2.000 s: could not lift") &&
                 failure.ends_with(": the simulator does not answer");
        }) == 1);
}

TEST_CASE("without ground truth nothing is judged") {
  const TestResult result = result_of(
      "faults: [{at_s: 1, kill: simulator}]\nexpect: [{no_contact: all}, {at_rest: all, within_s: 2}]\n");
  const std::vector<std::string> failures = result.failures();
  REQUIRE(failures.size() == 2);
  for (const std::string& failure : failures)
    CHECK_THAT(failure,
               ContainsSubstring("not judged") && ContainsSubstring("ground truth is missing after"));
}

TEST_CASE("the command runs each file with each seed, writes JUnit XML and returns 1 if any test failed") {
  const std::string stem = "/tmp/sidestep-test-command-" + std::to_string(getpid());
  std::ofstream(stem + "-good.yaml") << kLanes << "expect: [{arrived: all}]\n";
  std::ofstream(stem + "-bad.yaml") << kLanes << "expect: [{arrived: all, by_s: 1}]\n";
  std::ofstream(stem + "-invalid.yaml") << kLanes << "expect: [{arrived: everybody}]\n";
  TestOptions options;
  options.files = {stem + "-good.yaml"};
  options.seeds = {3, 4};
  options.junit_file = stem + ".xml";
  CHECK(run_tests(options) == 0);
  CHECK_THAT(text_of(options.junit_file),
             ContainsSubstring("tests=\"2\" failures=\"0\"") && ContainsSubstring("-good.yaml, seed 4\""));
  options.files = {stem + "-good.yaml", stem + "-bad.yaml"};
  CHECK(run_tests(options) == 1);
  CHECK_THAT(text_of(options.junit_file),
             ContainsSubstring("tests=\"4\" failures=\"2\"") && ContainsSubstring("arrived late, at "));
  options.files = {stem + "-good.yaml", stem + "-invalid.yaml"};
  CHECK_THROWS_AS(run_tests(options), ConfigError);
  for (const char* end : {"-good.yaml", "-bad.yaml", "-invalid.yaml", ".xml"})
    std::remove((stem + end).c_str());
}

}  // namespace sidestep::sim_test_run_test
