// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/metrics/report.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "common/json/json_text.hpp"
#include "tests/catch.hpp"
#include "tests/text_of.hpp"

namespace sidestep::report_test {

Report example() {
  Report report;
  report.program = "simulate";
  report.scenario = "crossing";
  report.seed = 7;
  report.robots = 2;
  report.arrived = 1;
  report.arrival_s = {{3, 1.25}, {7, std::nullopt}};
  report.mean_arrival_s = 1.25;
  report.min_clearance_m = 0.0123456789;
  report.cycles = 200;
  report.missed_cycles = 1;
  report.robot_time_s = 6;
  report.duration_s = 2;
  for (int i = 1; i <= 100; ++i) report.negotiation.add(std::chrono::microseconds(100 * i));
  report.deaths.push_back({"agent 7", "exit code 1", 0.5, false});
  report.conflicts = {{3, 7}};
  report.mismatches = {{"agent 3", {}}, {"vision", {{"margin_m", "0.01", "0.02"}}}};
  return report;
}

TEST_CASE("a report's JSON has the keys that readers rely on in a stable order") {
  const std::string text = to_json(example());
  const auto json = parse_ordered_json(text);
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  CHECK(keys == std::vector<std::string>{"program",
                                         "scenario",
                                         "seed",
                                         "passed",
                                         "failure",
                                         "robots",
                                         "arrived",
                                         "without_goal",
                                         "contacts",
                                         "penetration_m_s",
                                         "min_clearance_m",
                                         "crashes",
                                         "crashes_while_moving",
                                         "max_crash_speed_mps",
                                         "max_robot_crash_speed_mps",
                                         "makespan_s",
                                         "mean_arrival_s",
                                         "straight_line_time_ratio",
                                         "arrival_s",
                                         "not_arrived",
                                         "proposals",
                                         "grants",
                                         "denials",
                                         "cycles",
                                         "missed_cycles",
                                         "route_changes",
                                         "route_changes_per_s",
                                         "firmware_violations",
                                         "conflicts",
                                         "quarantined",
                                         "displaced",
                                         "max_reference_error_m",
                                         "max_clock_offset_s",
                                         "clock_uncertainty_s",
                                         "negotiation_us",
                                         "robot_time_s",
                                         "deaths",
                                         "director_deaths",
                                         "ending",
                                         "epochs",
                                         "mismatches",
                                         "counters",
                                         "audit",
                                         "incidents",
                                         "paths",
                                         "floor",
                                         "wall_clock"});
  CHECK(json["seed"] == 7);
  CHECK(json["passed"] == false);
  CHECK(json["failure"] == "1 of 2 arrived");
  CHECK(json["min_clearance_m"] == 0.012346);
  CHECK(json["makespan_s"].is_null());
  CHECK(json["arrival_s"]["3"] == 1.25);
  CHECK(json["arrival_s"]["7"].is_null());
  CHECK(json["negotiation_us"]["max"] == 10000.0);
  CHECK(json["negotiation_us"]["p50"] >= 5000.0);
  CHECK(json["negotiation_us"]["p50"] < 5700.0);
  CHECK(json_text(json["conflicts"]) == "[[3,7]]");
  CHECK_THAT(summary(example()), ContainsSubstring("brought robots 3 and 7 into conflict"));
  CHECK(json["deaths"][0]["process"] == "agent 7");
  CHECK(json_text(json["mismatches"]) ==
        R"({"agent 3":{},"vision":{"margin_m":{"run":"0.01","process":"0.02"}}})");
  CHECK_THAT(summary(example()), ContainsSubstring("vision was refused because it has different rules: "
                                                   "margin_m is 0.02 instead of 0.01"));
  CHECK(json["wall_clock"]["real_time_factor"] == 3.0);
  CHECK_FALSE(json["wall_clock"].contains("processes"));
}

TEST_CASE("the report of a run over DDS contains its version, startup time and resource use of processes") {
  Report report = example();
  report.fast_dds = "3.1.2";
  report.processes["agent 3"] = {0.25, 21.5};
  CHECK(parse_json(to_json(report))["wall_clock"]["startup_s"].is_null());
  report.startup_s = 1.5;
  const auto wall = parse_json(to_json(report))["wall_clock"];
  CHECK(wall["fast_dds"] == "3.1.2");
  CHECK(wall["startup_s"] == 1.5);
  CHECK(wall["processes"]["agent 3"]["cpu_s"] == 0.25);
  CHECK(wall["processes"]["agent 3"]["max_memory_mb"] == 21.5);
}

TEST_CASE("reports of one run on machines of different speed differ only under wall_clock") {
  Report slow = example();
  slow.duration_s = 9;
  slow.plan.add(std::chrono::milliseconds(5));
  slow.search.add(std::chrono::milliseconds(5));
  auto a = parse_ordered_json(to_json(example())), b = parse_ordered_json(to_json(slow));
  CHECK(a != b);
  a.erase("wall_clock");
  b.erase("wall_clock");
  CHECK(a == b);
}

TEST_CASE("the failure reason lists all failures in one line and is empty without a failure") {
  Report report = example();
  CHECK_THAT(summary(report), EndsWith("failed: 1 of 2 arrived\n"));
  report.abort_reason = "time limit of 60 s";
  report.contacts = 1;
  report.firmware_violations = 2;
  report.recording_failure = "a.mcap: No space left on device";
  CHECK(report.failure_reason() ==
        "time limit of 60 s, recording: a.mcap: No space left on device, 1 contacts, 2 firmware violations, "
        "1 of 2 arrived");
  Report good = example();
  good.arrived = 2;
  CHECK(good.failure_reason().empty());
  CHECK_THAT(summary(good), EndsWith("passed\n"));
}

TEST_CASE("a robot without a goal has not arrived, and fails no run") {
  Report report = example();
  CHECK_THAT(summary(report),
             StartsWith("1 of 2 robots arrived, 0 contacts between robots or with obstacles, "));
  report.without_goal = 1;
  CHECK(report.failure_reason().empty());
  CHECK_THAT(summary(report), StartsWith("1 of 1 robots arrived and 1 had no goal, "));
  CHECK(parse_json(to_json(report))["without_goal"] == 1);
  report.arrived = 0;
  CHECK(report.failure_reason() == "0 of 1 arrived");
  report.without_goal = 2;
  CHECK(report.failure_reason().empty());
  CHECK_THAT(summary(report), StartsWith("2 robots without a goal, "));
}

TEST_CASE("writing a report creates its folder or fails with the reason") {
  const auto folder = std::filesystem::temp_directory_path() / ("report-" + std::to_string(getpid()));
  const std::string path = (folder / "deep" / "r.json").string();
  write_report(example(), path);
  CHECK(parse_json(text_of(path))["scenario"] == "crossing");
  std::filesystem::remove_all(folder);
  CHECK_THROWS_WITH(write_report(example(), "/dev/null/r.json"), ContainsSubstring("cannot write /dev/null"));
}

TEST_CASE("a report is named after scenario and seed, or scenario and time") {
  CHECK(default_report_path("crossing", 7) == "reports/crossing-7.json");
  CHECK_THAT(default_report_path("crossing", std::nullopt),
             Matches("reports/crossing-[0-9]{8}T[0-9]{6}\\.json"));
}

TEST_CASE("a crash of a moving robot fails a run, but a crash of a robot at rest is only reported") {
  Report report = example();
  report.arrived = 2;
  REQUIRE(report.failure_reason().empty());
  report.crashes = 3;
  report.max_crash_speed_mps = 1.5;
  CHECK(report.failure_reason().empty());
  CHECK_THAT(
      summary(report),
      ContainsSubstring("3 crashes: contacts of a robot with an opponent or a person, 0 of them while the "
                        "robot moved; maximum closing speed 1.50 m/s"));
  report.crashes_while_moving = 1;
  CHECK(report.failure_reason() == "1 crashes of moving robots with opponents or people");
}

TEST_CASE("audit violations fail a run and are included in its report") {
  Report report = example();
  report.arrived = report.robots;
  CHECK(parse_json(to_json(report))["audit"].is_null());
  report.audit = AuditTotals{};
  CHECK(report.failure_reason().empty());
  Violation violation;
  violation.rule = AuditRule::kLateSwitch;
  violation.robot = 3;
  violation.version = 17;
  violation.detail = "is being executed, although";
  report.audit->violations = 1;
  report.audit->by_rule[static_cast<std::size_t>(AuditRule::kLateSwitch)] = 1;
  report.audit->first.push_back(violation);
  CHECK(report.failure_reason() == "1 audit violations, the first of rule late-switch");
  const auto audit = parse_json(to_json(report))["audit"];
  CHECK(audit["violations"] == 1);
  CHECK(audit["by_rule"]["late-switch"] == 1);
  CHECK(audit["first"][0]["robot"] == 3);
  CHECK(audit["first"][0]["detail"] == "is being executed, although");
  CHECK_THAT(summary(report),
             ContainsSubstring("late-switch (firmware, S-05): robot 3 version 17: is being executed"));
}

TEST_CASE("violations of an audit that does not count do not fail a run, which is then not judged") {
  Report report = example();
  report.arrived = report.robots;
  report.audit = AuditTotals{};
  report.audit->violations = 1;
  report.audit->first.emplace_back();
  report.audit->exemption = "a process accepted a second simulator";
  const std::string reason = "not judged: a process accepted a second simulator";
  CHECK(report.failure_reason().empty());
  CHECK(report.verdict() == AuditVerdict::kNotJudged);
  const auto json = parse_json(to_json(report));
  CHECK(json["failure"] == reason);
  CHECK(json["audit"]["verdict"] == "not judged");
  CHECK(json["audit"]["violations"] == 1);
  CHECK_THAT(summary(report), ContainsSubstring("audit: " + reason) && EndsWith("\n" + reason + "\n"));
  report.contacts = 1;
  CHECK(report.failure_reason() == "1 contacts");
}

/// The audit of a run in which every message was heard.
AuditTotals covered() {
  AuditTotals totals;
  totals.received = 100;
  totals.run_s = 5;
  totals.reference = AuditReference::kGroundTruth;
  totals.coverage = {1, 1, 1, 1, 1};
  return totals;
}

TEST_CASE("excused contacts do not fail a run, but other contacts do") {
  Report report = example();
  report.arrived = report.robots;
  report.abort_reason.clear();
  report.contacts = 3;
  report.audit = covered();
  report.audit->excused_contacts = 3;
  CHECK(report.failure_reason() == "");
  report.contacts = 4;
  CHECK(report.failure_reason() == "1 contacts");
  report.audit->unidentified_contacts = 1;
  CHECK(report.failure_reason() == "");
  CHECK(report.verdict() == AuditVerdict::kNotJudged);
}

TEST_CASE("a run neither passes nor fails if its audit covered too little") {
  Report report = example();
  report.arrived = report.robots;
  report.audit = covered();
  CHECK(report.verdict() == AuditVerdict::kPassed);
  CHECK(parse_json(to_json(report))["passed"] == true);
  CHECK_THAT(summary(report), ContainsSubstring("audit: passed (coverage 100.0 %)") && EndsWith("passed\n"));

  report.audit->coverage.messages = 0.66;
  CHECK(report.failure_reason().empty());
  CHECK(report.verdict() == AuditVerdict::kNotJudged);
  const auto json = parse_json(to_json(report));
  CHECK(json["passed"] == false);
  CHECK(json["failure"] == "not judged: 34.0 % of the messages were missed");
  CHECK_THAT(summary(report), ContainsSubstring("audit: not judged: 34.0 % of the messages were missed") &&
                                  EndsWith("\nnot judged: 34.0 % of the messages were missed\n"));

  report.arrived = 1;
  CHECK(report.verdict() == AuditVerdict::kFailed);
  CHECK(parse_json(to_json(report))["failure"] == "1 of 2 arrived");
  CHECK_THAT(summary(report), EndsWith("\nfailed: 1 of 2 arrived\n"));
}

TEST_CASE("a report states how the run ended, and is not judged if robots may still move") {
  Report report = example();
  report.arrived = 2;
  report.not_arrived.clear();
  REQUIRE(report.verdict() == AuditVerdict::kPassed);
  report.ending = {"all robots arrived", 0.4321, 0, ""};
  CHECK(report.verdict() == AuditVerdict::kPassed);
  CHECK(json_text(parse_ordered_json(to_json(report))["ending"]) ==
        R"({"cause":"all robots arrived","duration_s":0.4321,"contacts":0,"problem":null})");
  CHECK_THAT(summary(report),
             ContainsSubstring("end: all robots arrived; all robots rested after 0.43 s, with "
                               "0 contacts meanwhile\n"));
  report.ending = {"interrupted", 5, 1, "robot 3 still moves at 0.40 m/s"};
  CHECK(report.verdict() == AuditVerdict::kNotJudged);
  CHECK_THAT(summary(report), EndsWith("not judged: robot 3 still moves at 0.40 m/s\n"));
  const auto json = parse_ordered_json(to_json(report));
  CHECK(json["failure"] == "not judged: robot 3 still moves at 0.40 m/s");
  CHECK(json["ending"]["contacts"] == 1);
  report.abort_reason = "interrupted";
  CHECK(report.verdict() == AuditVerdict::kFailed);
  CHECK_THAT(summary(report),
             ContainsSubstring("end: interrupted; robot 3 still moves at 0.40 m/s after 5.00 s"));
}

TEST_CASE("a report states the audit's coverage and reference and the causes of excused contacts") {
  Report report = example();
  report.audit = covered();
  report.audit->coverage = {0.99, 0.98, 0.97, 0.96, 1};
  report.audit->excused_contacts = 4;
  report.audit->excused = {{"push", 2, 5, 3}, {"slip", 7, std::nullopt, 1}};
  report.audit->pair_s = 200;
  report.audit->excused_pair_s = 3;
  const auto audit = parse_ordered_json(to_json(report))["audit"];
  CHECK(audit["verdict"] == "passed");
  CHECK(json_text(audit["coverage"]) == R"({"share":0.96,"messages":0.99,"versions":0.98,"pairs":0.97,)"
                                        R"("time":0.96,"reference":1.0,"minimum":0.95,"run_s":5.0})");
  CHECK(audit["reference"] == "ground truth");
  CHECK(json_text(audit["excused"]) == R"([{"cause":"push","robots":[2,5],"contacts":3},)"
                                       R"({"cause":"slip","robots":[7],"contacts":1}])");
  CHECK(audit["excused_time_share"] == 0.015);
  CHECK_THAT(summary(report),
             ContainsSubstring("4 contacts are excused by disturbances, which excuse 1.50 %") &&
                 ContainsSubstring("3 of robot 2 and robot 5, cause: push") &&
                 ContainsSubstring("1 of robot 7 and an obstacle, cause: slip"));
}

TEST_CASE("a report has one line for the path of each robot, and says when rules were broken") {
  Report report = example();
  CHECK(parse_json(to_json(report))["paths"].is_null());
  report.trace = FloorTrace{};
  report.trace->zero = time_from_ns(5'000'000'000);
  report.trace->robots.push_back({3, Team::kBlue, {0, 0}, {}, {{0, {0, 0}, 0}, {1.5, {1, 0}, 0.5}}});
  report.trace->robots.push_back({7, Team::kBlue, {0, 1}, {}, {{0, {0, 1}, 0}}});
  report.audit = AuditTotals{};
  Violation violation;
  violation.detected = time_from_ns(7'250'000'000);
  report.audit->first.push_back(violation);
  const std::string text = to_json(report);
  CHECK_THAT(text,
             ContainsSubstring("\n  \"paths\": {\n    \"3\": [[0.0,0.0,0.0,0.0],[1.5,1.0,0.0,0.5]],\n    "
                               "\"7\": [[0.0,0.0,1.0,0.0]]\n  },\n"));
  CHECK(parse_json(text)["audit"]["first"][0]["at_s"] == 2.25);
  // Everything else is laid out as usual.
  report.trace.reset();
  const std::string without = to_json(report);
  CHECK(without == json_text(parse_ordered_json(without), 2) + "\n");
}

}  // namespace sidestep::report_test
