// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/scenario/scenario_template.hpp"

#include "common/process/help/page_path.hpp"

namespace sidestep {
namespace {

/// The pages that the template names.
constexpr const char *kScenarioPage = "deploy/scenarios/README.md", *kMapPage = "common/map/README.md";

constexpr const char* kTemplate =
    R"yaml(# A floor with a wall, a door in it, and three robots that pass it. Lengths are in metres, positions are [x, y] from the
# centre of the floor, angles in radians, counter-clockwise from x. Remove the # in front of a key to switch it on.
# All keys: deploy/scenarios/README.md

field: {length_m: 8, width_m: 5}    # robots stay on it with their whole disc
radius_m: 0.09                      # of every robot
limits: {speed_mps: 2, acceleration_mps2: 3, deceleration_mps2: 5}    # what robots surely keep

# Clearance that robots keep. It has to cover what robots deviate from their paths, and what clocks deviate from each
# other: margin_m is at least 2 * tracking_bound_m + 4 * clock_bound_s * speed_mps.
margin_m: 0.014
tracking_bound_m: 0.005
clock_bound_s: 0.0005

obstacles:
  - wall: {points_m: [[0, -2.5], [0, -0.5]], thickness_m: 0.1}    # a door of 1 m is between the two walls
  - wall: {points_m: [[0, 0.5], [0, 2.5]], thickness_m: 0.1}
  - box: {min_m: [2, 1.2], max_m: [3, 1.8]}
  - circle: {centre_m: [-2.5, -1.5], radius_m: 0.4}
#  - polygon: {corners_m: [[2, -2], [3, -2], [2.5, -1.4]]}        # convex, corners counter-clockwise
#map: hall-map.yaml    # a building as a map, as ROS's map_server has it: common/map/README.md

robots:
  - id: 0
    start_m: [-3, 0.8]
    heading_rad: 0
    goals_m: [[3, 0.6]]              # visited in order; a third number is the heading there
  - {id: 1, start_m: [3, -0.8], goals_m: [[-3, -0.6]]}
  - {id: 2, start_m: [-3, -0.4], team: yellow, goals_m: [[2.5, -1, 1.57], [-1, 1.5]]}
#  - {id: 3, start_m: [3, 2]}        # has no goals, and waits: `sidestep go 3 1,1`

# People, or robots of others, who walk to and fro and do not give way.
#max_opponent_speed_mps: 1.5         # robots keep clear of whatever moves no faster than this
#opponents:
#  - {radius_m: 0.25, speed_mps: 1, path_m: [[-1.8, -2], [-1.8, 2]]}

# What the simulator's cameras see.
vision: {rate_hz: 60, position_noise_m: 0.0005, delay_ms: 10}

time_limit_s: 60                     # for all robots to arrive
#coordinators: 2                     # the second one takes over if the first one dies
#restart: [agents, coordinator]      # processes that `sidestep run` starts again when they die

# With these keys, `sidestep test` breaks something and checks what happens.
#faults:
#  - {at_s: 1, kill: agent 1}
#  - {at_s: 3, restart: agent 1}
#expect:
#  - {no_contact: all}
#  - {arrived: all}
)yaml";

std::string with_installed_page(std::string text, const std::string& page) {
  return text.replace(text.find(page), page.size(), page_path(page));
}

}  // namespace

std::string scenario_template(const std::string& schema_path) {
  return (schema_path.empty() ? "" : "# yaml-language-server: $schema=" + schema_path + "\n") +
         with_installed_page(with_installed_page(kTemplate, kScenarioPage), kMapPage);
}

}  // namespace sidestep
