// SPDX-License-Identifier: Apache-2.0
// An auditor that misses messages finds no violation that a complete audit does not find.
#include <cstdlib>
#include <fmt/format.h>
#include <iostream>
#include <optional>

#include "deploy/trial/simulate/campaign/trial.hpp"
#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/tampering.hpp"
#include "tests/unit/deploy/audit/thinning.hpp"

namespace sidestep::thinned_history_test {

using namespace std::chrono_literals;

/// All messages of a trial of the random campaign, with faults such as deaths, partitions, second agents,
/// pushes, lifted robots and clocks that are set. nullopt if the campaign does not judge the trial by its
/// audit because some process believed a second simulator.
std::optional<MessageHistory> history_of_trial(std::uint64_t seed) {
  const Trial trial = sample_trial(seed, 12s, std::nullopt);
  MessageHistory history{trial.scenario, {}};
  std::unique_ptr<HistoryRecorder> recorder;
  TrialHooks hooks;
  hooks.on_start = [&](SimSystem& system) { recorder = std::make_unique<HistoryRecorder>(system, history); };
  hooks.on_end = [&] { recorder.reset(); };
  if (!run_trial(trial, nullptr, hooks).is_audited) return std::nullopt;
  return history;
}

struct Counts {
  int runs = 0, audits = 0, judged = 0, failed = 0;
  double compared_pairs = 0, all_pairs = 0;
};

/// Audits the histories of trials, each complete and with losses.
Counts audit_thinned(std::uint64_t first, std::uint64_t count, std::uint64_t losses) {
  Counts counts;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    CAPTURE(seed);
    const std::optional<MessageHistory> found = history_of_trial(seed);
    if (!found) continue;
    ++counts.runs;
    const MessageHistory& history = *found;
    const AuditTotals whole = audit_of(history, kComplete);
    INFO("whole: " << verdict_line(whole) << "\n" << lines(whole));
    CHECK(whole.verdict() == AuditVerdict::kPassed);
    for (std::uint64_t loss = 0; loss < losses; ++loss) {
      const DegradedHistory part = thinned(history, seed * 1000 + loss);
      CAPTURE(loss, part.losses);
      const AuditTotals totals = audit_of(history.scenario, part.deliveries, {});
      INFO("thinned: " << verdict_line(totals) << "\n" << lines(totals));
      for (std::size_t rule = 0; rule < kAuditRules; ++rule) {
        if (whole.by_rule[rule] == 0) CHECK(totals.by_rule[rule] == 0);
      }
      CHECK((totals.verdict() == AuditVerdict::kPassed) ==
            (totals.violations == 0 && shortfall(totals).empty()));
      ++counts.audits;
      counts.judged += totals.verdict() != AuditVerdict::kNotJudged;
      counts.failed += totals.verdict() == AuditVerdict::kFailed;
      counts.compared_pairs += static_cast<double>(totals.compared_pairs);
      counts.all_pairs += static_cast<double>(whole.compared_pairs);
    }
  }
  return counts;
}

std::string text_of(const Counts& counts) {
  return fmt::format("{} audits of {} runs: {} judged, {} of them failed; {:.1f} % of the pairs compared",
                     counts.audits, counts.runs, counts.judged, counts.failed,
                     100 * counts.compared_pairs / counts.all_pairs);
}

std::uint64_t number(const char* name, std::uint64_t otherwise) {
  const char* const text = std::getenv(name);
  return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

TEST_CASE("an audit of a campaign's run raises no false alarm when it misses messages", "[slow]") {
  const Counts counts = audit_thinned(1, 20, 10);
  CAPTURE(text_of(counts));
  CHECK(counts.failed == 0);
  CHECK(counts.judged < counts.audits);
  CHECK(counts.compared_pairs > 0.05 * counts.all_pairs);
}

TEST_CASE("audits of a thousand campaign runs raise no false alarm when they miss messages",
          "[.long][slow]") {
  // SIDESTEP_FIRST_SEED and SIDESTEP_SEEDS choose a subset of the runs.
  const Counts counts = audit_thinned(number("SIDESTEP_FIRST_SEED", 1), number("SIDESTEP_SEEDS", 1000), 10);
  std::cout << text_of(counts) << "\n";
  CHECK(counts.audits > 0);
}

}  // namespace sidestep::thinned_history_test
