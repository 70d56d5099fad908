// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/judgement/coverage_gaps.hpp"

#include <fmt/format.h>

namespace sidestep {
namespace {

// Ground truth is sent sixty times a second.
constexpr double kMaxSilence_s = 0.25;

Judgement truth_missing_after(double at_s, const RunHistory& history) {
  if (history.truths.empty()) return Judgement::not_judged(at_s, "no ground truth was heard");
  return Judgement::not_judged(at_s, fmt::format("ground truth is missing after {:.3f} s", at_s));
}

}  // namespace

std::optional<Judgement> ended_before(double at_s, const RunHistory& history) {
  const RunEnd& end = history.end;
  if (end.at_s >= at_s) return std::nullopt;
  return Judgement::not_judged(end.at_s, fmt::format("the run ended at {:.3f} s{}{}", end.at_s,
                                                     end.abort_reason.empty() ? "" : ": ", end.abort_reason));
}

std::optional<Judgement> gap_at_end(const RunHistory& history) {
  const RunEnd& end = history.end;
  if (!end.abort_reason.empty())
    return Judgement::not_judged(end.at_s, "the run was aborted: " + end.abort_reason);
  const double heard_s = history.truths.empty() ? 0 : history.truths.back().at_s;
  if (!history.truths.empty() && end.at_s - heard_s <= kMaxSilence_s) return std::nullopt;
  return truth_missing_after(heard_s, history);
}

std::optional<Judgement> gap_between(double from_s, double to_s, const RunHistory& history) {
  if (const auto ended = ended_before(to_s, history)) return ended;
  double heard_s = from_s;
  for (const TruthSample& sample : history.truths) {
    if (sample.at_s < from_s) continue;
    if (sample.at_s - heard_s > kMaxSilence_s || sample.at_s > to_s) break;
    heard_s = sample.at_s;
  }
  if (!history.truths.empty() && to_s - heard_s <= kMaxSilence_s) return std::nullopt;
  return truth_missing_after(heard_s, history);
}

}  // namespace sidestep
