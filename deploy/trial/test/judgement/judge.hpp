// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "deploy/trial/test/judgement/run_history.hpp"
#include "deploy/trial/test/plan/expectation.hpp"

namespace sidestep {

/// kNotJudged means that too little of the run was received to decide.
enum class Outcome { kPassed, kFailed, kNotJudged };

struct Judgement {
  Outcome outcome = Outcome::kPassed;
  double at_s = 0;     ///< time of the decision since the first grant; meaningless if passed
  std::string reason;  ///< what was observed instead; empty if passed

  static Judgement failed(double at_s, std::string reason) {
    return {Outcome::kFailed, at_s, std::move(reason)};
  }
  static Judgement not_judged(double at_s, std::string reason) {
    return {Outcome::kNotJudged, at_s, std::move(reason)};
  }
};

/// Judges whether a run met an expectation.
[[nodiscard]] Judgement judge(const Expectation& expectation, const RunHistory& history);

// Judge functions for the individual kinds of expectations.
[[nodiscard]] Judgement judge(const ExpectNoContact& check, const RunHistory& history);
[[nodiscard]] Judgement judge(const ExpectMinClearance& check, const RunHistory& history);
[[nodiscard]] Judgement judge(const ExpectAtRest& check, const RunHistory& history);
[[nodiscard]] Judgement judge(const ExpectMoving& check, const RunHistory& history);
[[nodiscard]] Judgement judge(const ExpectMaxSpeed& check, const RunHistory& history);
[[nodiscard]] Judgement judge(const ExpectTakeover& check, const RunHistory& history);
[[nodiscard]] Judgement judge(const ExpectNamed& check, const RunHistory& history);
[[nodiscard]] Judgement judge(const ExpectNoViolations& check, const RunHistory& history);
[[nodiscard]] Judgement judge(const ExpectArrived& check, const RunHistory& history);
[[nodiscard]] Judgement judge(const ExpectNotArrived& check, const RunHistory& history);
[[nodiscard]] Judgement judge(const ExpectMismatch& check, const RunHistory& history);

}  // namespace sidestep
