// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/audit_totals.hpp"

#include <fmt/format.h>

#include "common/process/exit_code.hpp"

namespace sidestep {

int exit_code(AuditVerdict verdict) {
  switch (verdict) {
    case AuditVerdict::kPassed:
      return 0;
    case AuditVerdict::kFailed:
      return kExitFailure;
    case AuditVerdict::kNotJudged:
      break;
  }
  return kExitNotJudged;
}

const char* name_of(AuditVerdict verdict) {
  switch (verdict) {
    case AuditVerdict::kPassed:
      return "passed";
    case AuditVerdict::kFailed:
      return "failed";
    case AuditVerdict::kNotJudged:
      break;
  }
  return "not judged";
}

const char* name_of(AuditReference reference) {
  switch (reference) {
    case AuditReference::kVision:
      return "vision";
    case AuditReference::kGroundTruth:
      return "ground truth";
    case AuditReference::kVisionThenGroundTruth:
      return "vision, then ground truth";
    case AuditReference::kNone:
      break;
  }
  return "none";
}

AuditVerdict AuditTotals::verdict() const {
  if (has_failed()) return AuditVerdict::kFailed;
  return shortfall(*this).empty() ? AuditVerdict::kPassed : AuditVerdict::kNotJudged;
}

std::string shortfall(const AuditTotals& totals) {
  if (!totals.exemption.empty()) return totals.exemption;
  if (totals.received == 0 && totals.refused > 0)
    return fmt::format("all {} messages come from processes with different rules", totals.refused);
  if (totals.received == 0) return "no messages were received";
  if (totals.run_s <= 0) return "no received message shows that robots could move";
  std::string text;
  const auto add = [&](const std::string& reason) { text += (text.empty() ? "" : ", ") + reason; };
  const auto add_part = [&](double covered, const char* missing) {
    if (covered < Coverage::kMinimum) add(fmt::format("{:.1f} % {}", 100 * (1 - covered), missing));
  };
  const Coverage& coverage = totals.coverage;
  add_part(coverage.messages, "of the messages were missed");
  add_part(coverage.versions, "of the executed versions lack a proposal, a grant or a command");
  if (coverage.versions >= Coverage::kMinimum && totals.untraced_first_versions > 0)
    add(fmt::format("the audit is too short: {} executed versions may have been granted before it joined",
                    totals.untraced_first_versions));
  if (totals.lacks_ledger) add("no page of the ledger was received");
  add_part(coverage.pairs, "of the compared pairs of versions are undecided");
  add_part(coverage.time, "of the time passed with at least one robot silent");
  if (totals.reference == AuditReference::kNone)
    add("neither ground truth nor vision was received");
  else
    add_part(coverage.reference, "of the time passed without ground truth or vision");
  if (totals.is_cut_off) add("the recording is damaged, so its end is missing");
  if (totals.unidentified_contacts > 0)
    add(fmt::format("the robots of {} contacts are unknown", totals.unidentified_contacts));
  if (totals.undecided_contacts + totals.undecided_crashes > 0) {
    add(fmt::format("{} contacts and crashes are undecided because of missed messages",
                    totals.undecided_contacts + totals.undecided_crashes));
  }
  return text;
}

std::string verdict_line(const AuditTotals& totals) {
  const AuditVerdict verdict = totals.verdict();
  const char* const name = name_of(verdict);
  if (verdict == AuditVerdict::kNotJudged) return fmt::format("{}: {}", name, shortfall(totals));
  return fmt::format("{} (coverage {:.1f} %)", name, 100 * totals.coverage.share());
}

}  // namespace sidestep
