// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/audit_totals.hpp"

#include <algorithm>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::audit_totals_test {

/// An audit that covered everything and found nothing.
AuditTotals covered() {
  AuditTotals totals;
  totals.received = 1000;
  totals.run_s = 10;
  totals.reference = AuditReference::kGroundTruth;
  totals.coverage = {1, 1, 1, 1, 1};
  return totals;
}

TEST_CASE("an audit that heard nothing does not judge") {
  CHECK(AuditTotals().verdict() == AuditVerdict::kNotJudged);
  CHECK(verdict_line(AuditTotals()) == "not judged: no messages were received");
}

TEST_CASE("an audit that refused all messages reports that") {
  AuditTotals totals;
  totals.refused = 7;
  CHECK(verdict_line(totals) == "not judged: all 7 messages come from processes with different rules");
}

TEST_CASE("an audit with enough coverage and no findings passes") {
  AuditTotals totals = covered();
  CHECK(totals.verdict() == AuditVerdict::kPassed);
  totals.coverage.messages = 0.997;
  CHECK(totals.verdict() == AuditVerdict::kPassed);
  CHECK(verdict_line(totals) == "passed (coverage 99.7 %)");
  totals.coverage.messages = Coverage::kMinimum;
  CHECK(totals.verdict() == AuditVerdict::kPassed);
}

TEST_CASE("an audit that covers 95 % of each share judges, and an audit that covers 94.9 % of one does not") {
  for (double Coverage::*part :
       {&Coverage::messages, &Coverage::versions, &Coverage::pairs, &Coverage::time, &Coverage::reference}) {
    AuditTotals totals = covered();
    totals.coverage.*part = 0.95;
    CHECK(totals.verdict() == AuditVerdict::kPassed);
    totals.coverage.*part = 0.949;
    CHECK(totals.verdict() == AuditVerdict::kNotJudged);
  }
}

TEST_CASE("a run is not judged if any coverage share is below the minimum, and the reason is given") {
  AuditTotals totals = covered();
  std::string reason;
  SECTION("messages are missing") {
    totals.coverage.messages = 0.66;
    reason = "34.0 % of the messages were missed";
  }
  SECTION("versions are missing") {
    totals.coverage.versions = 0.9;
    reason = "10.0 % of the executed versions lack a proposal, a grant or a command";
  }
  SECTION("the audit is too short") {
    totals.untraced_first_versions = 3;
    reason = "the audit is too short: 3 executed versions may have been granted before it joined";
  }
  SECTION("the audit is too short and knows few versions") {
    totals.untraced_first_versions = 3;
    totals.coverage.versions = 0.9;
    reason = "10.0 % of the executed versions lack a proposal, a grant or a command";
  }
  SECTION("there is no ledger") {
    totals.lacks_ledger = true;
    reason = "no page of the ledger was received";
  }
  SECTION("pairs are undecided") {
    totals.coverage.pairs = 0.9;
    reason = "10.0 % of the compared pairs of versions are undecided";
  }
  SECTION("time is not covered") {
    totals.coverage.time = 0.5;
    reason = "50.0 % of the time passed with at least one robot silent";
  }
  SECTION("the reference is incomplete") {
    totals.coverage.reference = 0.5;
    reason = "50.0 % of the time passed without ground truth or vision";
  }
  SECTION("there is no reference") {
    totals.reference = AuditReference::kNone;
    totals.coverage.reference = 0;
    reason = "neither ground truth nor vision was received";
  }
  SECTION("several contacts involve unknown robots") {
    totals.unidentified_contacts = 3;
    reason = "the robots of 3 contacts are unknown";
  }
  SECTION("one contact involves unknown robots") {
    totals.unidentified_contacts = 1;
    reason = "the robots of 1 contacts are unknown";
  }
  SECTION("a disturbance may excuse one contact") {
    totals.undecided_contacts = 1;
    reason = "1 contacts and crashes are undecided because of missed messages";
  }
  SECTION("a disturbance may excuse several contacts") {
    totals.undecided_contacts = 2;
    totals.undecided_crashes = 1;
    reason = "3 contacts and crashes are undecided because of missed messages";
  }
  SECTION("the end of the recording is missing") {
    totals.is_cut_off = true;
    reason = "the recording is damaged, so its end is missing";
  }
  SECTION("no message shows that robots could move") {
    totals.run_s = 0;
    reason = "no received message shows that robots could move";
  }
  CHECK(totals.verdict() == AuditVerdict::kNotJudged);
  CHECK(verdict_line(totals) == "not judged: " + reason);
  // Violations count even with low coverage.
  totals.violations = 1;
  CHECK(totals.verdict() == AuditVerdict::kFailed);
}

TEST_CASE("the coverage is the smallest of its shares") {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    std::vector<double> parts;
    for (int i = 0; i < 5; ++i) parts.push_back(rng.uniform());
    const Coverage coverage{parts[0], parts[1], parts[2], parts[3], parts[4]};
    std::ranges::sort(parts);
    CHECK(coverage.share() == parts.front());
    AuditTotals totals = covered();
    totals.coverage = coverage;
    CHECK((totals.verdict() == AuditVerdict::kPassed) == (parts.front() >= 0.95));
  }
}

TEST_CASE("a share of zero expected items counts as complete") {
  CHECK(share_of(0, 0) == 1);
  CHECK(share_of(0, 1) == 0);
  CHECK(share_of(0, 4) == 0);
  CHECK(share_of(3, 4) == 0.75);
}

TEST_CASE("verdicts have their own exit codes, and 2 remains for invalid usage") {
  CHECK(exit_code(AuditVerdict::kPassed) == 0);
  CHECK(exit_code(AuditVerdict::kFailed) == 1);
  CHECK(exit_code(AuditVerdict::kNotJudged) == 3);
}

}  // namespace sidestep::audit_totals_test
