// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/judgement/judge.hpp"

#include "tests/catch.hpp"

namespace sidestep::judge_test {

constexpr double kPeriod_s = 1.0 / 60;
const RobotSet kOne{{1}, false}, kBoth{{1, 2}, true};

/// A run of ten seconds. Robot 1 drives from 1 s to 4 s, robot 2 all the time; coordinator 0 grants.
RunHistory run() {
  RunHistory history;
  for (int i = 0; i <= 600; ++i) {
    const double at_s = i * kPeriod_s;
    history.truths.push_back({at_s, {{1, at_s >= 1 && at_s < 4 ? 1.5 : 0.001}, {2, 0.5}}, 0.02, 0});
    history.coordinators.push_back({at_s, 0, 100, true});
  }
  history.end.at_s = 10;
  history.end.arrival_s = {{1, 4.5}, {2, std::nullopt}};
  return history;
}

void remove_truth(RunHistory& history, double from_s, double to_s) {
  std::erase_if(history.truths,
                [=](const auto& sample) { return sample.at_s >= from_s && sample.at_s < to_s; });
}

/// A run that ended early.
RunHistory run_until(double end_s, const std::string& abort_reason = "") {
  RunHistory history = run();
  remove_truth(history, end_s, 100);
  std::erase_if(history.coordinators, [=](const auto& sample) { return sample.at_s >= end_s; });
  history.end = {};
  history.end.at_s = end_s;
  history.end.abort_reason = abort_reason;
  return history;
}

Judgement judged(const ExpectationCheck& check, const RunHistory& history) {
  return judge(Expectation{check, 1}, history);
}

void check_passes(const ExpectationCheck& check, const RunHistory& history) {
  const Judgement judgement = judged(check, history);
  CAPTURE(describe({check, 1}), judgement.reason);
  CHECK(judgement.outcome == Outcome::kPassed);
}

void check_fails(const ExpectationCheck& check, const RunHistory& history, double at_s,
                 const std::string& reason) {
  const Judgement judgement = judged(check, history);
  CAPTURE(describe({check, 1}));
  CHECK(judgement.outcome == Outcome::kFailed);
  CHECK(judgement.at_s == Approx(at_s).margin(1.01 * kPeriod_s));
  CHECK_THAT(judgement.reason, ContainsSubstring(reason));
}

void check_not_judged(const ExpectationCheck& check, const RunHistory& history, const std::string& reason) {
  const Judgement judgement = judged(check, history);
  CAPTURE(describe({check, 1}));
  CHECK(judgement.outcome == Outcome::kNotJudged);
  CHECK_THAT(judgement.reason, ContainsSubstring(reason));
}

TEST_CASE("no contact: a contact fails with both robots and its time, unless a robot is excluded") {
  RunHistory history = run();
  check_passes(ExpectNoContact{kBoth, {}}, history);
  history.contacts.push_back({3.2, 2, 5});
  check_fails(ExpectNoContact{kBoth, {}}, history, 3.2, "robot 2 touched robot 5");
  check_passes(ExpectNoContact{kOne, {}}, history);
  check_passes(ExpectNoContact{kBoth, {{5}, false}}, history);
  history.contacts.push_back({5.1, 1, std::nullopt});
  check_fails(ExpectNoContact{kOne, {}}, history, 5.1, "robot 1 touched an obstacle");
  RunHistory crash = run();
  for (TruthSample& sample : crash.truths) sample.crashes_while_moving = sample.at_s >= 6 ? 1 : 0;
  check_fails(ExpectNoContact{kBoth, {}}, crash, 6, "a moving robot touched an opponent");
  check_passes(ExpectNoContact{kOne, {}}, crash);
}

TEST_CASE("no contact: not judged if ground truth is missing at the end or the run was aborted") {
  RunHistory history = run();
  history.unidentified_contacts = 3;
  check_not_judged(ExpectNoContact{kBoth, {}}, history, "the robots of 3 contacts are unknown");
  history = run();
  remove_truth(history, 8, 100);
  check_not_judged(ExpectNoContact{kBoth, {}}, history, "ground truth is missing after 7.9");
  check_not_judged(ExpectNoContact{kBoth, {}}, run_until(5, "interrupted"),
                   "the run was aborted: interrupted");
  remove_truth(history, 0, 100);
  check_not_judged(ExpectNoContact{kBoth, {}}, history, "no ground truth was heard");
  // The totals at the end include the time without ground truth.
  RunHistory gap = run();
  remove_truth(gap, 3, 5);
  check_passes(ExpectNoContact{kBoth, {}}, gap);
}

TEST_CASE("clearance: fails at the first moment when the clearance is too small") {
  RunHistory history = run();
  check_passes(ExpectMinClearance{0.02}, history);
  for (TruthSample& sample : history.truths) sample.min_clearance_m = sample.at_s >= 7 ? 0.004 : 0.02;
  check_fails(ExpectMinClearance{0.005}, history, 7, "the clearance was 0.004000 m");
  remove_truth(history, 6, 100);
  check_not_judged(ExpectMinClearance{0.005}, history, "ground truth is missing after 5.9");
}

TEST_CASE("at rest: fails if a robot does not rest within the span or moves before the expected time ends") {
  const RunHistory history = run();
  check_passes(ExpectAtRest{kOne, {3.5, 4.1}, 0}, history);
  check_passes(ExpectAtRest{kOne, {3.5, 4.1}, 3}, history);
  check_fails(ExpectAtRest{kOne, {2, 3.5}, 0}, history, 3.5,
              "robot 1 still moved at 1.500 m/s, and came to rest by 4.0");
  // The robot rests at first, but not for long enough.
  check_passes(ExpectAtRest{kOne, {0.2, 0.5}, 0}, history);
  check_fails(ExpectAtRest{kOne, {0.2, 0.5}, 1}, history, 1.5, "robot 1 still moved");
  check_fails(ExpectAtRest{kBoth, {4.2, 5}, 0}, history, 5, "robot 2 still moved at 0.500 m/s");
}

TEST_CASE("at rest: not judged without ground truth, for robots off the floor or after the end") {
  RunHistory history = run();
  remove_truth(history, 3, 4.5);
  check_not_judged(ExpectAtRest{kOne, {2, 4}, 0}, history, "ground truth is missing after 2.9");
  history = run();
  // A robot may have moved while ground truth was missing.
  remove_truth(history, 6, 6.5);
  check_not_judged(ExpectAtRest{kOne, {5, 5.5}, 2}, history, "ground truth is missing after 5.9");
  check_not_judged(ExpectAtRest{{{7}, false}, {2, 4}, 0}, run(), "robot 7 was not on the floor");
  check_not_judged(ExpectAtRest{{{2}, false}, {2, 4}, 0}, run_until(3), "the run ended at 3.000 s");
}

TEST_CASE("moving: fails if a robot does not move within the span") {
  RunHistory history = run();
  check_passes(ExpectMoving{kOne, {3.9, 6}}, history);
  check_fails(ExpectMoving{kOne, {5, 6}}, history, 6,
              "robot 1 did not move; its highest speed was 0.001 m/s");
  remove_truth(history, 5.2, 5.6);
  check_not_judged(ExpectMoving{kOne, {5, 6}}, history, "ground truth is missing after 5.1");
  check_not_judged(ExpectMoving{kOne, {5, 6}}, run_until(5.5), "the run ended at 5.500 s");
  check_not_judged(ExpectMoving{{{7}, false}, {5, 6}}, run(), "robot 7 was not on the floor");
}

TEST_CASE("a span without a sample of ground truth is not judged, and does not blame the robots") {
  RunHistory history = run();
  remove_truth(history, 5.001, 5.1);
  const std::string why = "there is no sample of ground truth between 5.010 s and 5.050 s";
  check_not_judged(ExpectAtRest{kOne, {5.01, 5.05}, 0}, history, why);
  check_not_judged(ExpectMoving{kOne, {5.01, 5.05}}, history, why);
  check_not_judged(ExpectMaxSpeed{kOne, 1, 5.01, 5.05}, history, why);
  check_not_judged(ExpectAtRest{{{7}, false}, {5.01, 5.2}, 0}, history, "robot 7 was not on the floor");
}

TEST_CASE("speed limit: fails at the first moment when a robot exceeds the limit") {
  RunHistory history = run();
  check_passes(ExpectMaxSpeed{kOne, 0.02, 4.1, 9}, history);
  check_passes(ExpectMaxSpeed{kOne, 0.02, 4.1, std::nullopt}, history);
  check_fails(ExpectMaxSpeed{kBoth, 1, 0, 9}, history, 1, "robot 1 moved at 1.500 m/s");
  remove_truth(history, 6, 7);
  check_not_judged(ExpectMaxSpeed{kOne, 0.02, 4.1, 9}, history, "ground truth is missing after 5.9");
  check_not_judged(ExpectMaxSpeed{kOne, 2, 0, std::nullopt}, run_until(5, "interrupted"), "aborted");
}

TEST_CASE("takeover: fails unless another coordinator grants in a higher epoch in time") {
  RunHistory history = run_until(3);
  history.end.at_s = 10;
  history.coordinators.push_back({3.1, 1, 201, false});
  history.coordinators.push_back({3.2, 1, 201, true});
  check_passes(ExpectTakeover{{3, 3.3}}, history);
  check_fails(ExpectTakeover{{3, 3.15}}, history, 3.2, "coordinator 1 granted late, after 200 ms");
  check_fails(ExpectTakeover{{1, 2}}, run(), 2, "no other coordinator granted");
  check_not_judged(ExpectTakeover{{3, 3.3}}, run_until(3), "the run ended at 3.000 s");
  history.coordinators.clear();
  check_not_judged(ExpectTakeover{{3, 3.3}}, history, "no coordinator had granted before this time");
  // The same coordinator in a new epoch is not a takeover.
  history = run_until(3);
  history.end.at_s = 10;
  history.coordinators.push_back({3.1, 0, 201, true});
  check_fails(ExpectTakeover{{3, 3.3}}, history, 3.3, "no other coordinator granted");
}

TEST_CASE("named: fails unless each robot is named for the right reason within the span") {
  RunHistory history = run();
  history.notices = {{2, 1, NoticeKind::kMissing}, {5.2, 1, NoticeKind::kDisplaced}};
  const auto named = [](NoticeKind as, double from_s, double to_s) {
    return ExpectNamed{kOne, as, {from_s, to_s}};
  };
  check_passes(named(NoticeKind::kDisplaced, 5, 6), history);
  check_fails(named(NoticeKind::kDisplaced, 4, 5), history, 5, "robot 1 was named late, at 5.200 s");
  check_fails(named(NoticeKind::kQuarantined, 4, 6), history, 6, "robot 1 was not named");
  check_fails(named(NoticeKind::kMissing, 3, 6), history, 6, "robot 1 was not named");
  check_fails(ExpectNamed{kBoth, NoticeKind::kDisplaced, {5, 6}}, history, 6, "robot 2 was not named");
  check_not_judged(named(NoticeKind::kConflict, 4, 6), run_until(5), "the run ended at 5.000 s");
  history.coordinators.clear();
  check_not_judged(named(NoticeKind::kConflict, 4, 6), history, "no active coordinator was heard");
}

TEST_CASE("violations: fails at the first violation, and is not judged if the audit covered too little") {
  RunHistory history = run();
  check_passes(ExpectNoViolations{}, history);
  history.end.shortfall = "34.5 % of the messages were missed";
  check_not_judged(ExpectNoViolations{}, history, "34.5 % of the messages");
  history.end.violations = 2;
  history.end.first_violation_at_s = 3.5;
  history.end.first_violation = "clearance of 1 and 2";
  check_fails(ExpectNoViolations{}, history, 3.5, "2 violations, the first: clearance of 1 and 2");
  check_not_judged(ExpectNoViolations{}, run_until(5, "interrupted"), "aborted");
}

TEST_CASE("arrivals: fails with the robot that has not arrived or arrives too late") {
  const RunHistory history = run();
  check_passes(ExpectArrived{kOne, std::nullopt}, history);
  check_passes(ExpectArrived{kOne, 4.6}, history);
  check_fails(ExpectArrived{kOne, 4.4}, history, 4.5, "robot 1 arrived late, at 4.500 s");
  check_fails(ExpectArrived{kBoth, std::nullopt}, history, 10, "robot 2 had not arrived");
  check_fails(ExpectArrived{kBoth, 8}, history, 8, "robot 2 had not arrived");
  check_not_judged(ExpectArrived{kBoth, 8}, run_until(5), "the run ended at 5.000 s");
  check_not_judged(ExpectArrived{kBoth, std::nullopt}, run_until(5, "interrupted"), "aborted: interrupted");
  check_passes(ExpectNotArrived{{{2}, false}}, history);
  check_fails(ExpectNotArrived{kBoth}, history, 4.5, "robot 1 arrived at 4.500 s");
  check_not_judged(ExpectNotArrived{{{2}, false}}, run_until(5, "interrupted"), "aborted");
}

TEST_CASE("different rules: fails unless the expected process is reported") {
  RunHistory history = run();
  check_fails(ExpectMismatch{"agent 1"}, history, 10, "no process is reported");
  history.end.mismatches["agent 2"] = "margin_m is 0.02 instead of 0.01";
  check_fails(ExpectMismatch{"agent 1"}, history, 10, "only other processes are reported: agent 2");
  check_passes(ExpectMismatch{"agent 2"}, history);
  check_not_judged(ExpectMismatch{"agent 1"}, run_until(5, "interrupted"), "aborted");
}

TEST_CASE("a failed robot outweighs robots that cannot be judged, and reasons of several robots are joined") {
  const RobotSet robots{{7, 2, 8}, false};
  check_fails(ExpectMoving{{{1, 7}, false}, {5, 6}}, run(), 6, "robot 1 did not move");
  check_not_judged(ExpectMoving{robots, {5, 6}}, run(),
                   "robot 7 was not on the floor between 5.000 s and "
                   "6.000 s; robot 8");
}

}  // namespace sidestep::judge_test
