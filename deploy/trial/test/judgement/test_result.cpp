// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/judgement/test_result.hpp"

#include <fmt/format.h>

namespace sidestep {

std::vector<std::string> TestResult::failures() const {
  std::vector<std::string> lines;
  if (!error.empty()) lines.push_back("could not run: " + error);
  if (!abort_reason.empty()) lines.push_back(fmt::format("at {:.3f} s: aborted: {}", run_s, abort_reason));
  for (const FaultProblem& problem : problems)
    lines.push_back(fmt::format("at {:.3f} s: could not {}", problem.at_s, problem.text));
  for (const JudgedExpectation& expectation : expectations) {
    const Judgement& judgement = expectation.judgement;
    if (judgement.outcome == Outcome::kPassed) continue;
    lines.push_back(fmt::format("at {:.3f} s: {}line {} expects {}, but {}", judgement.at_s,
                                judgement.outcome == Outcome::kNotJudged ? "not judged: " : "",
                                expectation.line, expectation.text, judgement.reason));
  }
  return lines;
}

std::string summary(const TestResult& result) {
  const std::vector<std::string> failures = result.failures();
  std::string text =
      fmt::format("{}, {} expectations, {:.1f} s in {:.1f} s\n", failures.empty() ? "passed" : "FAILED",
                  result.expectations.size(), result.run_s, result.wall_s);
  for (const std::string& failure : failures) text += fmt::format("  {}\n", failure);
  if (!result.report_file.empty()) text += fmt::format("  report: {}\n", result.report_file);
  if (!result.log_file.empty()) text += fmt::format("  log: {}\n", result.log_file);
  return text;
}

TestResult judged(const FaultTest& test, const RunOutcome& outcome) {
  TestResult result;
  result.file = test.file;
  result.run_s = outcome.history.end.at_s;
  result.abort_reason = outcome.history.end.abort_reason;
  result.problems = outcome.problems;
  result.log_file = outcome.log_file;
  result.report_file = outcome.report_file;
  for (const Expectation& expectation : test.expectations) {
    result.expectations.push_back(
        {describe(expectation), expectation.line, judge(expectation, outcome.history)});
  }
  return result;
}

}  // namespace sidestep
