// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/plan/disturbance_reader.hpp"

#include <algorithm>

#include "deploy/audit/disturbances.hpp"
#include "deploy/trial/test/plan/plan_names.hpp"
#include "simulator/world/disturbance_codec.hpp"

namespace sidestep {
namespace {

using Kind = msg::DisturbanceKind;

// The ranges of the options of `sidestep fault`.
constexpr Range kPush_mps{-kMaxPush_mps, kMaxPush_mps};
constexpr Range kVisionError_m{-10, 10};
constexpr Range kOffset_ms{-1e6, 1e6};
constexpr Range kPlace_m{-1000, 1000};
constexpr Range kSeconds{0.001, 3600};

void require(YamlMap& map, const char* key) { (void)map.require(key); }

void read_place(YamlMap& map, const char* key, RobotDisturbance& disturbance, const Scenario& scenario) {
  require(map, key);
  map.read(key, kPlace_m, disturbance.place_m);
  if (!scenario.field.contains(disturbance.place_m, scenario.radius_m))
    map.location_of(key).fail("expected a place where the whole robot is on the field");
}

void read_seconds(YamlMap& map, RobotDisturbance& disturbance) {
  double seconds = 1;
  map.read("seconds", kSeconds, seconds);
  disturbance.duration = from_seconds(seconds);
}

}  // namespace

std::vector<std::string> disturbance_keys() {
  std::vector<std::string> keys;
  while (const auto cause = cause_of(static_cast<Kind>(keys.size()))) {
    std::string& key = keys.emplace_back(*cause);
    std::ranges::replace(key, ' ', '_');
  }
  return keys;
}

bool has_duration(const RobotDisturbance& disturbance) {
  return disturbance.kind == Kind::DISTURBANCE_SLIP || disturbance.kind == Kind::DISTURBANCE_BLOCK ||
         disturbance.kind == Kind::DISTURBANCE_CARRY || disturbance.kind == Kind::DISTURBANCE_SEEN_BESIDE ||
         disturbance.kind == Kind::DISTURBANCE_SEEN_AS || disturbance.kind == Kind::DISTURBANCE_SEEN_FROZEN;
}

RobotDisturbance read_disturbance(YamlMap& map, const std::string& key, const Scenario& scenario) {
  RobotDisturbance disturbance;
  disturbance.robot = robot_from(map, key, scenario);
  const std::vector<std::string> keys = disturbance_keys();
  disturbance.kind = static_cast<Kind>(std::ranges::find(keys, key) - keys.begin());
  switch (disturbance.kind) {
    case Kind::DISTURBANCE_PUSH:
      require(map, "velocity_mps");
      map.read("velocity_mps", kPush_mps, disturbance.push_mps);
      break;
    case Kind::DISTURBANCE_SLIP:
      require(map, "grip");
      map.read("grip", {0, 1}, disturbance.grip);
      break;
    case Kind::DISTURBANCE_BLOCK:
      map.read_heading("heading_rad", disturbance.heading_rad);
      break;
    case Kind::DISTURBANCE_PLACE:
      read_place(map, "at_m", disturbance, scenario);
      map.read_heading("heading_rad", disturbance.heading_rad);
      break;
    case Kind::DISTURBANCE_CLOCK:
      require(map, "offset_ms");
      map.read_ms("offset_ms", kOffset_ms, disturbance.clock_offset);
      break;
    case Kind::DISTURBANCE_CARRY:
      read_place(map, "to_m", disturbance, scenario);
      break;
    case Kind::DISTURBANCE_SEEN_BESIDE:
      require(map, "by_m");
      map.read("by_m", kVisionError_m, disturbance.place_m);
      break;
    case Kind::DISTURBANCE_SEEN_AS:
      require(map, "other");
      disturbance.other_robot = robot_from(map, "other", scenario);
      break;
    default:
      break;
  }
  if (has_duration(disturbance)) read_seconds(map, disturbance);
  return disturbance;
}

}  // namespace sidestep
