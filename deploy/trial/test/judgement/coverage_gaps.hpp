// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "deploy/trial/test/judgement/judge.hpp"

namespace sidestep {

/// "Not judged" if the run ended before this time; otherwise nullopt.
[[nodiscard]] std::optional<Judgement> ended_before(double at_s, const RunHistory& history);
/// "Not judged" if the run was aborted, or if ground truth is missing at its end, so that the totals of
/// ground truth do not cover the whole run; otherwise nullopt.
[[nodiscard]] std::optional<Judgement> gap_at_end(const RunHistory& history);
/// "Not judged" if ground truth is missing for longer than a moment between these times; otherwise nullopt.
[[nodiscard]] std::optional<Judgement> gap_between(double from_s, double to_s, const RunHistory& history);

}  // namespace sidestep
