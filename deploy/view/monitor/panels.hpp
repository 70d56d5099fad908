// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "deploy/inspect/floor/floor_state.hpp"
#include "deploy/view/monitor/closest_pair.hpp"
#include "deploy/view/monitor/run_assessment.hpp"
#include "deploy/view/monitor/waits.hpp"

namespace sidestep {

/// Whether the protocol's guarantee has held so far: {"state": "kept", "broken" or "not judged", "reason":…,
/// "contacts":…, "violations":…, "coverage":…, "closest":…, "smallest":…}. It is "kept" only while the audit
/// covers enough of the run. `assessment` is nullptr if the scenario is unknown.
[[nodiscard]] nlohmann::ordered_json promise_json(const RunAssessment* assessment, bool is_heard,
                                                  const std::optional<ClosestPair>& closest,
                                                  const std::optional<ClosestPair>& smallest);

/// One row per robot: its agent's activity and performance.
[[nodiscard]] nlohmann::ordered_json robots_json(const FloorState& floor, const Waits& waits, Time now);
/// One row per coordinator.
[[nodiscard]] nlohmann::ordered_json coordinators_json(const FloorState& floor, Time now);
/// The zones that clients have set.
[[nodiscard]] nlohmann::ordered_json zones_json(const FloorState& floor);
/// The epochs that coordinators have begun, with the reasons.
[[nodiscard]] nlohmann::ordered_json epochs_json(const RunAssessment* assessment);

}  // namespace sidestep
