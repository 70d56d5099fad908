// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "deploy/monitor/view/closest_pair.hpp"
#include "deploy/monitor/view/floor_state.hpp"
#include "deploy/monitor/view/run_judges.hpp"

namespace sidestep {

/// Whether the promise has been kept so far: {"state": "kept", "broken" or "not judged", "reason":…,
/// "contacts":…, "violations":…, "coverage":…, "closest":…, "smallest":…}. It is "kept" only while the audit
/// covers enough of the run. `judges`: nullptr: the scenario is not known.
[[nodiscard]] nlohmann::ordered_json promise_json(const RunJudges* judges, bool is_heard,
                                                  const std::optional<ClosestPair>& closest,
                                                  const std::optional<ClosestPair>& smallest);

/// A row per robot: what its agent does, and how well.
[[nodiscard]] nlohmann::ordered_json robots_json(const FloorState& floor, Time now);
/// A row per coordinator.
[[nodiscard]] nlohmann::ordered_json coordinators_json(const FloorState& floor, Time now);
/// The zones that clients have set.
[[nodiscard]] nlohmann::ordered_json zones_json(const FloorState& floor);
/// The epochs that coordinators have begun, and why.
[[nodiscard]] nlohmann::ordered_json epochs_json(const RunJudges* judges);

}  // namespace sidestep
