// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/campaign_summary.hpp"

#include "tests/catch.hpp"

namespace sidestep::campaign_summary_test {

TEST_CASE("the upper bound of a rate agrees with tables of the Poisson distribution") {
  // Tables of the Poisson distribution, one-sided 95 %.
  CHECK(upper_bound_95(0, 1) == Approx(2.9957).epsilon(1e-4));
  CHECK(upper_bound_95(1, 1) == Approx(4.7439).epsilon(1e-4));
  CHECK(upper_bound_95(10, 1) == Approx(16.9622).epsilon(1e-4));
  CHECK(upper_bound_95(0, 3000) == Approx(0.00099857).epsilon(1e-4));
}

TEST_CASE("a trial result survives writing to a line of text and parsing") {
  TrialResult result;
  result.seed = 18446744073709551615ULL;
  result.failures = {"a \"quoted\" thing", "two\nlines"};
  result.contacts = 3;
  result.robot_s = 1020.5;
  result.stationary = 2;
  result.robots = 17;
  result.excused_by_cause = {{"switch off", 2}};
  result.excused_pair_s = 0.25;
  result.is_audited = false;
  const std::string line = to_line(result);
  CHECK(line.find('\n') == std::string::npos);
  const TrialResult back = parse_trial_result(line);
  CHECK(back.seed == result.seed);
  CHECK(back.failures == result.failures);
  CHECK(back.contacts == 3);
  CHECK_FALSE(back.is_audited);
  CHECK(back.excused_by_cause == result.excused_by_cause);
  CHECK(back.excused_pair_s == 0.25);
  CHECK(back.robot_s == 1020.5);
  CHECK(to_line(back) == line);
}

TEST_CASE("each number of a trial result survives a round trip through a line of text") {
  TrialResult result;
  result.fault_kinds = {"push", "slip"};
  std::uint64_t* const counts[] = {
      &result.contacts,  &result.excused_contacts, &result.audit_violations, &result.firmware_violations,
      &result.proposals, &result.grants,           &result.denials};
  std::uint64_t next = 1;
  for (std::uint64_t* const count : counts) *count = next++;
  result.robots = 21;
  result.stationary = 22;
  double* const numbers[] = {&result.pair_s,         &result.excused_pair_s,
                             &result.robot_s,        &result.distance_m,
                             &result.wall_s,         &result.distance_after_recovery_m,
                             &result.min_clearance_m};
  for (double* const number : numbers) *number = 0.5 + static_cast<double>(next++);
  const TrialResult back = parse_trial_result(to_line(result));
  CHECK(to_line(back) == to_line(result));
  CHECK(to_line(back) != to_line(TrialResult{}));
  CHECK(back.firmware_violations == result.firmware_violations);
  CHECK(back.distance_after_recovery_m == result.distance_after_recovery_m);
}

TEST_CASE("a summary of trials whose workers died contains only finite numbers") {
  CampaignSummary summary;
  TrialResult dead;
  dead.failures = {"the worker process died"};
  summary.add(dead);
  CHECK(summary.text().find("nan") == std::string::npos);
  CHECK(summary.failed() == 1);
}

TEST_CASE("a summary does not depend on the order of the results") {
  CampaignSummary forwards, backwards;
  std::vector<TrialResult> results(20);
  for (std::size_t i = 0; i < results.size(); ++i) {
    results[i].seed = i;
    results[i].robots = 10;
    results[i].robot_s = 360;
    results[i].distance_m = 0.1 * static_cast<double>(i);
    results[i].proposals = 100;
    results[i].denials = i;
  }
  results[19].distance_m = 12'345;
  results[4].contacts = 2;
  results[7].excused_contacts = 3;
  results[7].excused_by_cause = {{"push", 2}, {"slip", 1}};
  results[9].excused_contacts = 1;
  results[9].excused_by_cause = {{"push", 1}};
  results[7].excused_pair_s = 12;
  for (TrialResult& result : results) result.pair_s = 60;
  results[7].min_clearance_m = -0.002;
  results[4].failures = {"2 contacts"};
  results[5].is_audited = false;
  results[5].audit_violations = 7;
  results[6].audit_violations = 2;
  for (const TrialResult& result : results) forwards.add(result);
  for (auto result = results.rbegin(); result != results.rend(); ++result) backwards.add(*result);
  CHECK(forwards.text() == backwards.text());
  CHECK(forwards.json() == backwards.json());
  CHECK(forwards.robot_hours() == Approx(2));
  CHECK(forwards.contacts() == 2);
  CHECK(forwards.failed() == 1);
  CHECK_THAT(
      forwards.text(),
      ContainsSubstring("2 contacts between robots or with obstacles, 2 audit violations") &&
          ContainsSubstring("1 trials are not judged by the audit, because a process accepted a second "
                            "simulator; it reported 7 violations there"));
  CHECK_THAT(forwards.text(), ContainsSubstring("20 seeds, 1 failed") &&
                                  ContainsSubstring("largest share of denied proposals: seed 19 (0.19)"));
  CHECK(forwards.excused_by_cause() == std::map<std::string, std::uint64_t>{{"push", 3}, {"slip", 1}});
  CHECK(forwards.excused_time_share() == Approx(0.01));
  CHECK_THAT(forwards.text(),
             ContainsSubstring("4 excused contacts, 3 of cause push, 1 of cause slip; a contact would be "
                               "excused in 1.00 % of the time of all pairs"));
  CHECK_THAT(forwards.text(), ContainsSubstring("2.00 robot-hours, 12.4 km driven"));
  CHECK_THAT(forwards.text(), ContainsSubstring("smallest clearance, in metres: seed 7 (-0.002)"));
}

}  // namespace sidestep::campaign_summary_test
