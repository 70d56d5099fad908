// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/protocol/robot_disturbance.hpp"
#include "common/yaml/yaml_map.hpp"

namespace sidestep {

/// The keys for disturbances of robots: the names of all kinds (cause_of()), such as push or forget_pose, in
/// the order of DisturbanceKind.
[[nodiscard]] std::vector<std::string> disturbance_keys();

/// Reads the robot's disturbance under one of these keys. Throws ConfigError.
[[nodiscard]] RobotDisturbance read_disturbance(YamlMap& map, const std::string& key,
                                                const Scenario& scenario);
/// Whether the disturbance lasts for RobotDisturbance::duration.
[[nodiscard]] bool has_duration(const RobotDisturbance& disturbance);

}  // namespace sidestep
