// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// A kind of scenes in which many robots have to get past each other. A seed gives one of its scenes.
struct CrowdFamily {
  std::string name;
  std::string description;
  /// Makes the scene, except for its name. Draws everything random from the generator.
  Scenario (*make)(Rng& rng) = nullptr;
};

/// All families, in the order of the table of `sidestep bench crowds`.
[[nodiscard]] const std::vector<CrowdFamily>& crowd_families();

/// The family with a name, or nullptr.
[[nodiscard]] const CrowdFamily* find_crowd_family(std::string_view name);

/// The scene of a family for a seed. All robots have one goal; starts and goals are free, and all goals can
/// be reached. Ids are in random order and say nothing about the team. A robot that is slower than others has
/// the limit of its speed in its goal.
[[nodiscard]] Scenario crowd_scene(const CrowdFamily& family, std::uint64_t seed);

}  // namespace sidestep
