// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/plan/fault_test.hpp"

#include <filesystem>
#include <set>

#include "common/config/scenario_loader.hpp"
#include "common/config/shared_rules.hpp"
#include "common/yaml/config_error.hpp"
#include "tests/catch.hpp"

namespace sidestep::fault_test_test {

/// Three robots and two coordinators, in six lines.
const std::string kScenario =
    "time_limit_s: 20\ncoordinators: 2\nrobots:\n"
    "  - {id: 0, start_m: [-2, 0], goals_m: [[2, 0]]}\n"
    "  - {id: 1, start_m: [-2, 1], goals_m: [[2, 1]]}\n"
    "  - {id: 4, start_m: [-2, 2], goals_m: [[2, 2]]}\n";
constexpr int kLines = 6;

FaultTest with_fault(const std::string& fault) {
  return parse_fault_test(kScenario + "faults:\n  - {" + fault + "}\nexpect: [{no_contact: all}]\n",
                          "file.yaml");
}

template <typename Action>
Action action_of(const std::string& fault) {
  CAPTURE(fault);
  const FaultTest test = with_fault(fault);
  REQUIRE(test.faults.size() == 1);
  REQUIRE(std::holds_alternative<Action>(test.faults[0].action));
  return std::get<Action>(test.faults[0].action);
}

RobotDisturbance disturbance_of(const std::string& fault) { return action_of<RobotDisturbance>(fault); }

template <typename Check>
Check check_of(const std::string& expectation, const std::string& faults = "") {
  CAPTURE(expectation);
  const FaultTest test =
      parse_fault_test(kScenario + faults + "expect:\n  - {" + expectation + "}\n", "file.yaml");
  REQUIRE(test.expectations.size() == 1);
  REQUIRE(std::holds_alternative<Check>(test.expectations[0].check));
  return std::get<Check>(test.expectations[0].check);
}

/// The error for a test whose text follows the scenario, or "accepted".
void check_rejected(const std::string& text, int line, const std::string& why) {
  CAPTURE(text);
  std::string error = "accepted";
  try {
    (void)parse_fault_test(kScenario + text, "file.yaml");
  } catch (const ConfigError& caught) {
    error = caught.what();
  }
  CHECK_THAT(error, StartsWith("file.yaml:" + std::to_string(line) + ": "));
  CHECK_THAT(error, ContainsSubstring(why));
}

void check_fault_rejected(const std::string& fault, const std::string& why) {
  check_rejected("faults:\n  - {at_s: 1, " + fault + "}\nexpect: [{no_contact: all}]\n", kLines + 2, why);
}

void check_expectation_rejected(const std::string& expectation, const std::string& why) {
  check_rejected("expect:\n  - {" + expectation + "}\n", kLines + 2, why);
}

TEST_CASE("process faults are parsed from a test's YAML") {
  CHECK(action_of<Kill>("at_s: 1, kill: agent 4").process == "agent 4");
  CHECK(action_of<Kill>("at_s: 1, kill: agent 4 (twin)").process == "agent 4 (twin)");
  CHECK(action_of<Kill>("at_s: 1, kill: active coordinator").process == kActiveCoordinator);
  CHECK(action_of<RestartFault>("at_s: 1, restart: coordinator 1").scenario_file.empty());
  CHECK(action_of<Pause>("at_s: 1, pause: vision, seconds: 2").processes == ProcessNames{"vision"});
  CHECK(action_of<TwinFault>("at_s: 1, twin: 4").robot == 4);
  CHECK(action_of<AbsenceFault>("at_s: 1, attest_absence: 1").robot == 1);
  const FaultTest test = with_fault("at_s: 1.5, pause: coordinator, seconds: 2");
  CHECK(test.faults[0].at_s == 1.5);
  CHECK(test.faults[0].end_s() == 3.5);
  CHECK(test.faults[0].text == "pause coordinator");
}

TEST_CASE("a process restarts with another scenario, whose path is relative to the test's file") {
  const std::string file = SIDESTEP_SOURCE_DIR "/deploy/scenarios/faults/text.yaml";
  const std::string expect = "expect: [{no_contact: all}]\n";
  const FaultTest test = parse_fault_test(
      kScenario + "faults: [{at_s: 1, restart: agent 1, scenario: ../crossing.yaml}]\n" + expect, file);
  CHECK(std::filesystem::equivalent(std::get<RestartFault>(test.faults[0].action).scenario_file,
                                    SIDESTEP_SOURCE_DIR "/deploy/scenarios/crossing.yaml"));
  std::string other = kScenario;
  other.replace(other.find("id: 4"), 5, "id: 9");
  CHECK_THROWS_WITH(
      parse_fault_test(other + "faults: [{at_s: 1, restart: agent 9, scenario: ../crossing.yaml}]\n" + expect,
                       file),
      ContainsSubstring("the other scenario has no agent 9"));
}

TEST_CASE("a partition separates processes from all other processes or from named processes") {
  const auto all = action_of<Partition>("at_s: 1, partition: [coordinator, vision]");
  CHECK(all.from == ProcessNames{"coordinator", "vision"});
  CHECK(all.to == ProcessNames{"simulator", "coordinator 1", "agent 0", "agent 1", "agent 4"});
  CHECK(all.is_two_way);
  const auto in = action_of<Partition>("at_s: 1, partition: agent 1, from: [vision], one_way: in");
  CHECK(in.from == ProcessNames{"vision"});
  CHECK(in.to == ProcessNames{"agent 1"});
  CHECK_FALSE(in.is_two_way);
  const auto out = action_of<Partition>("at_s: 1, partition: agent 1, from: [vision], one_way: out");
  CHECK(out.from == ProcessNames{"agent 1"});
  CHECK(out.to == ProcessNames{"vision"});
  CHECK_FALSE(out.is_two_way);
}

TEST_CASE("network faults accept the same values as `sidestep fault network`") {
  const auto fault = action_of<ImpairmentFault>(
      "at_s: 1, network: all, loss: 0.3, burst: 5, duplicate: 0.1, delay_ms: [5, 20, 150]");
  using std::chrono::milliseconds;
  CHECK(fault.target == "all");
  CHECK(fault.quality ==
        LinkQuality{0.3, 5, 0.1, milliseconds(5), milliseconds(20), milliseconds(150), false});
  CHECK(action_of<ImpairmentFault>("at_s: 1, network: agent 1, cut: true").quality.is_cut);
  CHECK(action_of<ImpairmentFault>("at_s: 1, network: agent 1, clear: true").quality == kUnimpairedLink);
}

TEST_CASE("robot disturbances are parsed from a fault's YAML") {
  using Kind = msg::DisturbanceKind;
  CHECK(disturbance_of("at_s: 1, push: 4, velocity_mps: [0.5, -1]").push_mps == Vec2(0.5, -1));
  CHECK(disturbance_of("at_s: 1, push: 4, velocity_mps: [0.5, -1]").robot == 4);
  const RobotDisturbance slip = disturbance_of("at_s: 1, slip: 1, grip: 0.2");
  CHECK(slip.grip == 0.2);
  CHECK(slip.duration == std::chrono::seconds(1));
  CHECK(disturbance_of("at_s: 1, block: 1, heading_rad: 0.3, seconds: 2").heading_rad == 0.3);
  CHECK(disturbance_of("at_s: 1, lift: 1").kind == Kind::DISTURBANCE_LIFT);
  CHECK(disturbance_of("at_s: 1, place: 1, at_m: [1, 2]").place_m == Vec2(1, 2));
  CHECK(disturbance_of("at_s: 1, reboot: 1").kind == Kind::DISTURBANCE_REBOOT);
  CHECK(disturbance_of("at_s: 1, forget_pose: 1").kind == Kind::DISTURBANCE_FORGET_POSE);
  CHECK(disturbance_of("at_s: 1, clock: 1, offset_ms: -250").clock_offset == std::chrono::milliseconds(-250));
  CHECK(disturbance_of("at_s: 1, switch_off: 1").kind == Kind::DISTURBANCE_SWITCH_OFF);
  CHECK(disturbance_of("at_s: 1, switch_on: 1").kind == Kind::DISTURBANCE_SWITCH_ON);
  const RobotDisturbance carry = disturbance_of("at_s: 1, carry: 1, to_m: [1, 2], seconds: 3");
  CHECK(carry.place_m == Vec2(1, 2));
  CHECK(carry.duration == std::chrono::seconds(3));
  CHECK(with_fault("at_s: 1, carry: 1, to_m: [1, 2], seconds: 3").faults[0].end_s() == 4);
}

TEST_CASE("expectations are parsed from a test's YAML") {
  const auto contact = check_of<ExpectNoContact>("no_contact: all, except: 4");
  CHECK(contact.robots.is_all);
  CHECK(contact.robots.ids == std::vector<RobotId>{0, 1, 4});
  CHECK(contact.except.ids == std::vector<RobotId>{4});
  (void)check_of<ExpectNoViolations>("no_violations: true");
  CHECK_FALSE(check_of<ExpectArrived>("arrived: all").by_s);
  CHECK(check_of<ExpectArrived>("arrived: [1, 4], by_s: 7").by_s == 7);
  CHECK(check_of<ExpectNotArrived>("not_arrived: 1").robots.ids == std::vector<RobotId>{1});
  CHECK(check_of<ExpectMinClearance>("min_clearance_m: 0.005").clearance_m == 0.005);
  const auto speed = check_of<ExpectMaxSpeed>("max_speed_mps: 0.5, robots: 1, from_s: 2, to_s: 4");
  CHECK(speed.robots.ids == std::vector<RobotId>{1});
  CHECK((speed.speed_mps == 0.5 && speed.from_s == 2 && speed.to_s == 4));
  CHECK(check_of<ExpectMaxSpeed>("max_speed_mps: 0.5").robots.is_all);
  CHECK(check_of<ExpectMismatch>("mismatch: coordinator 1").process == "coordinator 1");
  CHECK(check_of<ExpectNamed>("named: 1, as: displaced, within_s: 1").as == NoticeKind::kDisplaced);
}

TEST_CASE("spans begin with a fault or at a time, and end after a duration or at a time") {
  const std::string faults = "faults: [{at_s: 3, lift: 1}, {at_s: 5, place: 1, at_m: [0, 2.5]}]\n";
  const auto rest_of = [&](const std::string& keys, const std::string& with_faults) {
    return check_of<ExpectAtRest>("at_rest: 0, " + keys, with_faults);
  };
  const auto first = rest_of("within_s: 0.5, for_s: 2", faults);
  CHECK((first.span.from_s == 3 && first.span.to_s == 3.5 && first.for_s == 2));
  CHECK(rest_of("after_fault: 1, within_ms: 250", faults).span.from_s == 5);
  CHECK(rest_of("after_fault: 1, within_ms: 250", faults).span.to_s == 5.25);
  CHECK(rest_of("after_s: 4, by_s: 6", faults).span.from_s == 4);
  CHECK(rest_of("after_s: 4, by_s: 6", faults).span.to_s == 6);
  CHECK(rest_of("within_s: 1", "").span.from_s == 0);
  CHECK(check_of<ExpectMoving>("moving: all, within_s: 1", faults).span.from_s == 3);
  CHECK(check_of<ExpectTakeover>("takeover: true, within_ms: 300", faults).span.to_s == Approx(3.3));
}

TEST_CASE("invalid faults are rejected with their line") {
  check_fault_rejected("kil: agent 1", "expected a fault: one of the keys kill, restart");
  check_fault_rejected("kill: agent 1, pause: vision", "expected a fault, got kill and pause");
  check_fault_rejected("kill: agent 2", "kill: expected one of: simulator, vision, coordinator");
  check_fault_rejected("kill: agent 1, seconds: 3", "unknown key \"seconds\"");
  check_fault_rejected("restart: simulator", "expected one of");
  check_fault_rejected("restart: active coordinator", "expected one of");
  check_fault_rejected("pause: vision", "key \"seconds\" is missing");
  check_fault_rejected("pause: vision, seconds: 19.5", "after the time limit of 20 s");
  check_fault_rejected("partition: vision, from: [vision, agent 1]", "vision is on both sides");
  check_fault_rejected("partition: vision, one_way: up", "one_way: expected one of: in, out");
  check_fault_rejected("partition: []", "expected a process or a list of processes");
  check_fault_rejected("network: agent 1", "expected one of the keys loss, delay_ms, duplicate, cut, clear");
  check_fault_rejected("network: agent 1, loss: 1.1", "loss: expected 0 to 1");
  check_fault_rejected("network: agent 1, cut: true, burst: 2", "burst: requires loss");
  check_fault_rejected("network: agent 1, cut: true, clear: true", "clear cannot be combined");
  check_fault_rejected("network: agent 1, clear: true, seconds: 1", "cannot be combined with clear");
  check_fault_rejected("network: agent 1, delay_ms: [5, 2, 9]", "MIN, MEAN, MAX in increasing order");
  check_fault_rejected("push: 1", "key \"velocity_mps\" is missing");
  check_fault_rejected("push: 2, velocity_mps: [0, 1]", "push: the scenario has no robot 2");
  check_fault_rejected("push: agent 1, velocity_mps: [0, 1]", "push: expected a whole number");
  check_fault_rejected("push: 1, velocity_mps: [0, .nan]", "velocity_mps: expected a number from -10 to 10");
  check_fault_rejected("slip: 1", "key \"grip\" is missing");
  check_fault_rejected("slip: 1, grip: 2", "grip: expected 0 to 1");
  check_fault_rejected("place: 1, at_m: [4.45, 0]", "at_m: expected a place where the whole robot is");
  check_fault_rejected("carry: 1, to_m: [0, 3]", "to_m: expected a place where the whole robot is");
  check_fault_rejected("clock: 1", "key \"offset_ms\" is missing");
  const std::string expect = "expect: [{no_contact: all}]\n";
  check_rejected("faults:\n  - {kill: agent 1}\n" + expect, kLines + 2, "key \"at_s\" is missing");
  check_rejected("faults:\n  - {at_s: 21, kill: agent 1}\n" + expect, kLines + 2, "at_s: expected 0 to 20");
  check_rejected("faults: []\n" + expect, kLines + 1, "faults: expected at least one element");
  check_rejected("faults: kill\n" + expect, kLines + 1, "faults: expected a list");
}

TEST_CASE("the shortest span that is long enough for a sample of ground truth is accepted") {
  for (const char* expectation :
       {"at_rest: 1, after_s: 3, within_s: 0.02", "moving: 1, after_s: 3, by_s: 3.02",
        "max_speed_mps: 1, from_s: 3, to_s: 3.02"})
    CHECK_NOTHROW(parse_fault_test(kScenario + "expect:\n  - {" + expectation + "}\n", "file.yaml"));
}

TEST_CASE("invalid expectations are rejected with their line") {
  check_expectation_rejected("no_contacts: all", "expected an expectation: one of the keys no_contact");
  check_expectation_rejected("no_contacts: all", "; got no_contacts; did you mean no_contact?");
  check_expectation_rejected("at_res: 1, within_s: 1", "; got at_res, within_s; did you mean at_rest?");
  check_fault_rejected("kil: agent 1", "; got at_s, kil; did you mean kill?");
  check_expectation_rejected("no_contact: some", "no_contact: expected a whole number");
  check_expectation_rejected("no_contact: []", "expected all, a robot, or a list of robots");
  check_expectation_rejected("no_violations: false", "no_violations: expected true");
  check_expectation_rejected("arrived: all, within_s: 3", "unknown key \"within_s\"");
  check_expectation_rejected("arrived: all, by_s: 30", "by_s: expected 0 to 20");
  check_expectation_rejected("at_rest: 1", "expected one of the keys within_s, within_ms and by_s");
  check_expectation_rejected("at_rest: 1, within_s: 1, by_s: 2", "expected one of the keys within_s");
  check_expectation_rejected("at_rest: 1, within_s: 0",
                             "within_s: the span from 0 s to 0 s is too short: expected at least 0.02 s");
  check_expectation_rejected("at_rest: 1, within_ms: 19.9", "within_ms: the span from 0 s to 0.0199 s");
  check_expectation_rejected("moving: 1, after_s: 3, by_s: 2", "by_s: the span from 3 s to 2 s is too short");
  check_expectation_rejected("takeover: true, after_s: 3, within_s: 0.01", "within_s: the span from 3 s");
  check_expectation_rejected("at_rest: 1, after_s: 19.9, within_s: 1",
                             "20.9 s is after the time limit of 20 s");
  check_expectation_rejected("at_rest: 1, within_s: 5, for_s: 16", "21 s is after the time limit of 20 s");
  check_expectation_rejected("at_rest: 1, after_fault: 0, within_s: 1", "the scenario has no faults");
  check_expectation_rejected("max_speed_mps: 1, from_s: 3, to_s: 3",
                             "to_s: the span from 3 s to 3 s is too short");
  check_expectation_rejected("max_speed_mps: 1, from_s: 3, to_s: 3.01", "to_s: the span from 3 s to 3.01 s");
  check_expectation_rejected("named: 1, within_s: 1", "key \"as\" is missing");
  check_expectation_rejected("named: 1, as: lost, within_s: 1", "as: expected one of: missing, quarantined");
  check_expectation_rejected("mismatch: operator", "mismatch: expected one of");
  check_rejected("faults: [{at_s: 1, lift: 1}]\nexpect: [{moving: 0, after_fault: 1, within_s: 1}]\n",
                 kLines + 2, "after_fault: expected 0 to 0");
  check_rejected("faults: [{at_s: 1, lift: 1}]\n", 1, "key \"expect\" is missing");
  check_rejected("expect: []\n", kLines + 1, "expect: expected at least one element");
}

TEST_CASE("a test file also loads as a scenario, with the same rules as without faults and expectations") {
  const Scenario plain = parse_scenario(kScenario, "file.yaml");
  const Scenario with_keys = parse_scenario(
      kScenario + "faults: [{at_s: 1, kill: agent 1}]\nexpect: [{no_contact: all}]\n", "file.yaml");
  CHECK_FALSE(plain.has_test_keys);
  CHECK(with_keys.has_test_keys);
  CHECK(SharedRules(with_keys).fingerprint() == SharedRules(plain).fingerprint());
}

TEST_CASE("every shipped test loads, and its expectations have different descriptions") {
  int count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(SIDESTEP_SOURCE_DIR "/deploy/scenarios/faults")) {
    CAPTURE(entry.path());
    const FaultTest test = load_fault_test(entry.path().string());
    CHECK_FALSE(test.faults.empty());
    std::set<std::string> texts;
    for (const Expectation& expectation : test.expectations) texts.insert(describe(expectation));
    CHECK(texts.size() == test.expectations.size());
    ++count;
  }
  CHECK(count >= 12);
}

}  // namespace sidestep::fault_test_test
