// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "deploy/trial/test/judgement/judge.hpp"
#include "deploy/trial/test/plan/fault_test.hpp"

namespace sidestep {

/// The outcome of a run of a test.
struct RunOutcome {
  RunHistory history;
  std::vector<FaultProblem> problems;
  std::string log_file = {};     ///< log of the run's processes; empty: none
  std::string report_file = {};  ///< empty: none was written
};

struct JudgedExpectation {
  std::string text;
  int line = 0;
  Judgement judgement;
};

/// The result of one run of a test.
struct TestResult {
  std::string file;
  std::string bus;  ///< "SimBus" or "DDS"
  std::uint64_t seed = 1;
  double run_s = 0;          ///< by the run's clock, since the first grant
  double wall_s = 0;         ///< wall-clock time that the run took
  std::string error;         ///< why there was no run; empty: there was a run
  std::string abort_reason;  ///< empty: the run was not aborted
  std::vector<FaultProblem> problems;
  std::vector<JudgedExpectation> expectations;
  std::string log_file;     ///< empty: none
  std::string report_file;  ///< empty: none

  bool passed() const { return failures().empty(); }
  /// One line for each reason why the test did not pass: the time, what was expected, and what was observed.
  std::vector<std::string> failures() const;
};

/// The verdict, the reasons for it, and where report and log are.
[[nodiscard]] std::string summary(const TestResult& result);

/// Judges the outcome by all expectations of the test. The caller fills in bus, seed and wall_s.
[[nodiscard]] TestResult judged(const FaultTest& test, const RunOutcome& outcome);

}  // namespace sidestep
