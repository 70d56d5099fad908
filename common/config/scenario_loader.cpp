// SPDX-License-Identifier: Apache-2.0
#include "common/config/scenario_loader.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fmt/format.h>
#include <numbers>
#include <stdexcept>
#include <string_view>

#include "common/config/planner_names.hpp"
#include "common/config/scenario_floor.hpp"
#include "common/config/scenario_robots.hpp"
#include "common/file/utf8.hpp"
#include "common/protocol/senders.hpp"
#include "common/yaml/yaml_document.hpp"
#include "common/yaml/yaml_map.hpp"
#include "idl/laser.hpp"
#include "idl/vision.hpp"

namespace sidestep {
namespace {

constexpr const char* kExpected = "a scenario";
constexpr Range kProbability{0, 1};
constexpr std::size_t kMaxNameLength = 64;
constexpr std::array<std::string_view, 2> kPixelFormats{"yuv422", "rgb"};
constexpr std::array<std::string_view, 2> kLeagueInterfaces{"loopback", "all"};
constexpr std::array<std::string_view, 4> kRestartable{"agents", "coordinator", "vision", "robots"};

/// Turns the text into a name for reports and their files. Allowed are letters and digits of any language,
/// '-', '_' and '.', but no leading '.'. Every other character becomes '_', and text beyond kMaxNameLength is
/// cut off.
std::string sanitised_name(const std::string& text) {
  std::string name;
  std::size_t characters = 0;
  for (std::size_t at = 0; at < text.size() && characters < kMaxNameLength; ++characters) {
    const std::size_t length = printable_length(text, at);
    const auto first = static_cast<unsigned char>(text[at]);
    const bool is_allowed =
        length > 1 ||
        (length == 1 && (std::isalnum(first) || first == '-' || first == '_' || (first == '.' && at > 0)));
    name += is_allowed ? text.substr(at, length) : "_";
    at += std::max<std::size_t>(utf8_length(text, at), 1);
  }
  return name;
}

void read_name(YamlMap& map, const std::string& file, Scenario& scenario) {
  const auto name = map.text("name");
  if (!name) {
    const std::string stem = sanitised_name(std::filesystem::path(file).stem().string());
    scenario.name = stem.empty() ? "scenario" : stem;
    return;
  }
  scenario.name = *name;
  if (scenario.name.empty() || sanitised_name(scenario.name) != scenario.name)
    map.location_of("name").fail(
        fmt::format("expected 1 to {} letters, digits, '-', '_' or '.', and no leading '.'", kMaxNameLength));
}

void read_field_and_limits(YamlMap& map, Scenario& scenario) {
  read_section(map, "field", [&](YamlMap& field) {
    field.read("length_m", {0.5, 1000}, scenario.field.length_m);
    field.read("width_m", {0.5, 1000}, scenario.field.width_m);
  });
  read_section(map, "limits", [&](YamlMap& limits) {
    limits.read("acceleration_mps2", {0.1, 50}, scenario.limits.acceleration_mps2);
    limits.read("deceleration_mps2", {0.1, 50}, scenario.limits.deceleration_mps2);
    limits.read("speed_mps", {0.05, 20}, scenario.limits.speed_mps);
  });
  map.read("radius_m", {0.01, 5}, scenario.radius_m);
  double control_rate_hz = 0;
  map.read("control_rate_hz", {5, 500}, control_rate_hz);
  if (control_rate_hz > 0) scenario.cycle = from_seconds(1 / control_rate_hz);
  map.read("goal_tolerance_m", {0.001, 1}, scenario.goal_tolerance_m);
  map.read("time_limit_s", {0.1, kMaxTimeLimit_s}, scenario.time_limit_s);
}

/// The line of the key that makes the margin too small: its own or, by default, that of a key that raises the
/// safety budget.
int line_of_budget(YamlMap& map, const Scenario& scenario) {
  const Scenario defaults;
  if (map.find("margin_m").IsDefined()) return map.location_of("margin_m").line;
  if (scenario.limits.speed_mps > defaults.limits.speed_mps)
    return YamlMap(map.find("limits"), map.location_of("limits")).location_of("speed_mps").line;
  return map
      .location_of(scenario.tracking_bound_m > defaults.tracking_bound_m ? "tracking_bound_m"
                                                                         : "clock_bound_s")
      .line;
}

void read_budget(YamlMap& map, Scenario& scenario) {
  map.read("margin_m", {0, 1}, scenario.margin_m);
  map.read("tracking_bound_m", {0.0005, 1}, scenario.tracking_bound_m);
  map.read("clock_bound_s", {0, 1}, scenario.clock_bound_s);
  const SafetyBudget budget = budget_of(scenario);
  constexpr double kRounding_m = 1e-9;
  if (scenario.margin_m >= budget.required_margin_m() - kRounding_m) return;
  YamlLocation location = map.location_of("margin_m");
  location.line = line_of_budget(map, scenario);
  location.fail(
      fmt::format("{:g} m is less than the safety budget: expected at least {:.6g} m (2 x "
                  "tracking_bound_m {:g} + 4 x clock_bound_s {:g} x limits.speed_mps {:g})",
                  scenario.margin_m, budget.required_margin_m(), budget.tracking_bound_m,
                  budget.clock_bound_s, budget.speed_mps));
}

void read_images(YamlMap& map, std::optional<ImageSpec>& images) {
  read_section(map, "images", [&](YamlMap& inner) {
    ImageSpec& spec = images.emplace();
    std::string format{kPixelFormats.front()};
    inner.read("format", kPixelFormats, format);
    spec.format = *pixel_format_named(format);
    inner.read("width_px", {16, 4096}, spec.width_px);
    inner.read("height_px", {16, 4096}, spec.height_px);
    inner.read("camera_height_m", {1, 100}, spec.camera_height_m);
    inner.read("distortion", {0, 2}, spec.distortion);
    if (spec.format == PixelFormat::kYuv422 && spec.width_px % 2 != 0)
      inner.location_of("width_px").fail("expected an even number with yuv422");
    const ImageView view{spec.format, spec.width_px, spec.height_px};
    if (view.bytes() > msg::MAX_IMAGE_BYTES) {
      inner.location_of("width_px")
          .fail(fmt::format("{} x {} pixels are {} bytes, expected at most {}", spec.width_px, spec.height_px,
                            view.bytes(), msg::MAX_IMAGE_BYTES));
    }
  });
}

/// Rejects scenarios with images in which two robots of a team have the same marker pattern.
void check_images(YamlMap& map, const Scenario& scenario) {
  if (!scenario.vision.images) return;
  try {
    require_unique_numbers(scenario);
  } catch (const std::invalid_argument& error) {
    map.location_of("vision").fail(std::string("images: ") + error.what());
  }
}

void read_vision(YamlMap& map, VisionSpec& vision) {
  read_section(map, "vision", [&](YamlMap& inner) {
    // The lower limit excludes frames more than 0.3 s apart, which are too rare to supervise robots.
    inner.read("rate_hz", {5, 1000}, vision.rate_hz);
    inner.read("columns", {1, 16}, vision.columns);
    inner.read("rows", {1, 16}, vision.rows);
    inner.read("overlap_m", {0, 10}, vision.overlap_m);
    inner.read("position_noise_m", {0, 0.1}, vision.position_noise_m);
    inner.read("heading_noise_rad", {0, 1}, vision.heading_noise_rad);
    inner.read_ms("delay_ms", {0, 1000}, vision.delay);
    inner.read("miss_probability", kProbability, vision.miss_probability);
    inner.read("ghost_probability", kProbability, vision.ghost_probability);
    inner.read("ghost_obstacle_probability", kProbability, vision.ghost_obstacle_probability);
    std::string interfaces{kLeagueInterfaces.front()};
    inner.read("league_interfaces", kLeagueInterfaces, interfaces);
    vision.has_league_everywhere = interfaces == kLeagueInterfaces.back();
    read_images(inner, vision.images);
  });
}

void read_odometry(YamlMap& map, OdometrySpec& odometry) {
  read_section(map, "odometry", [&](YamlMap& inner) {
    inner.read("scale_error", {0, 0.5}, odometry.scale_error);
    inner.read("velocity_noise_mps", {0, 1}, odometry.velocity_noise_mps);
  });
}

void read_laser(YamlMap& map, Scenario& scenario) {
  read_section(map, "laser", [&](YamlMap& inner) {
    LaserSpec& laser = scenario.laser.emplace();
    inner.read("beams", {8, msg::MAX_BEAMS}, laser.settings.beams);
    inner.read("field_of_view_rad", {0.1, 2 * std::numbers::pi}, laser.settings.field_of_view_rad);
    inner.read("min_range_m", {0, 1}, laser.settings.min_range_m);
    inner.read("max_range_m", {1.001, 200}, laser.settings.max_range_m);
    inner.read("rate_hz", {1, 200}, laser.rate_hz);
    inner.read("range_error_m", {0, 0.5}, laser.range_error_m);
    inner.read("dropout_probability", kProbability, laser.dropout_probability);
    inner.read("person_radius_m", {0.01, 1}, laser.person_radius_m);
    if (inner.schema()) return;  // the opponents are placeholders
    for (std::size_t i = 0; i < scenario.opponents.size(); ++i) {
      if (scenario.opponents[i].radius_m >= laser.person_radius_m) continue;
      inner.location_of("person_radius_m")
          .fail(fmt::format("expected at most the radius of every opponent, but opponents[{}] has {:g} m", i,
                            scenario.opponents[i].radius_m));
    }
  });
}

void read_network(YamlMap& map, NetworkSpec& network) {
  read_section(map, "network", [&](YamlMap& inner) {
    inner.read("loss", kProbability, network.loss);
    inner.read("duplicate", kProbability, network.duplicate);
    inner.read_ms("delay_min_ms", {0, 10000}, network.delay_min);
    inner.read_ms("delay_max_ms", {0, 10000}, network.delay_max);
    if (network.delay_max < network.delay_min) {
      inner.location_of("delay_max_ms")
          .fail(fmt::format("expected at least delay_min_ms, {} ms", to_seconds(network.delay_min) * 1e3));
    }
  });
}

void read_restart(YamlMap& map, RestartSpec& restart) {
  for (const std::string& process : map.names("restart", kRestartable, 16)) {
    restart.agents |= process == "agents";
    restart.coordinator |= process == "coordinator";
    restart.vision |= process == "vision";
    restart.robots |= process == "robots";
  }
}

/// Reads all keys but `faults` and `expect`. The name of the file is the default name of the scenario.
void read_keys(YamlMap& map, const std::string& file_name, const OccupancyMap* map_cells,
               Scenario& scenario) {
  read_name(map, file_name, scenario);
  read_field_and_limits(map, scenario);
  read_budget(map, scenario);
  read_floor(map, map_cells, scenario);
  read_vision(map, scenario.vision);
  read_odometry(map, scenario.odometry);
  read_laser(map, scenario);
  map.read("command_loss", kProbability, scenario.command_loss);
  read_network(map, scenario.network);
  read_restart(map, scenario.restart);
  map.read("coordinators", {1, kMaxCoordinators}, scenario.coordinators);
  map.read("planner", kDrivingPlanners, scenario.planner);
  // Only `sidestep test` reads these keys (deploy/trial/test/plan).
  for (const char* key : {"faults", "expect"})
    scenario.has_test_keys = map.find(key).IsDefined() || scenario.has_test_keys;
  // Placements are checked after all keys have been read, because a misspelt key may be the reason why a
  // placement is invalid.
  map.find("robots");
  map.find("circle");
  map.find("disc");
  map.find("streams");
  map.finish();
  read_robots(map, scenario);
}

}  // namespace

Scenario parse_scenario(const std::string& text, const std::string& file_name,
                        const OccupancyMap* map_cells) {
  YamlMap map = document_map(text, file_name, kExpected);
  Scenario scenario;
  read_keys(map, file_name, map_cells, scenario);
  check_images(map, scenario);
  return scenario;
}

void describe_scenario(YamlMap& map) {
  Scenario scenario;
  read_keys(map, "", nullptr, scenario);
}

Scenario load_scenario(const std::string& path) {
  return parse_scenario(read_yaml_file(path, kExpected), path);
}

}  // namespace sidestep
