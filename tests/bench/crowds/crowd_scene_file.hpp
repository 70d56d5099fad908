// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "common/config/scenario.hpp"

namespace sidestep {

/// The scenario file (YAML) of a crowd scene, for `sidestep run` and `simulate`. nullopt if a robot has a
/// speed limit of its own, which scenario files cannot state. Precondition: the obstacles are circles and
/// boxes.
std::optional<std::string> crowd_scene_file(const Scenario& scene);

}  // namespace sidestep
