// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/process/bases_bus.hpp"
#include "common/process/command_line.hpp"
#include "simulator/bases/league_server.hpp"
#include "simulator/league/league_output.hpp"

namespace sidestep {

/// Options for simulated robots that external programs drive.
struct BaseOptions {
  bool is_league = false, is_velocity = false;
  BasesBusOptions velocity;
  double odometry_drift = 0;
  std::string control = "127.0.0.1:10300", blue = "127.0.0.1:10301", yellow = "127.0.0.1:10302";
  std::uint32_t team_size = 0;
  std::string starts = "scenario";
  double latency_ms = 100;
  double silence_ms = 100;
  double coast_ms = 0;
  double braking_mps2 = BaseSettings{}.braking_mps2;
  double drag_per_s = 0;
  double max_turn_radps = BaseSettings{}.max_turn_radps;
  std::vector<double> speeds{1};
  double speed_duration_s = to_seconds(PaceSettings{}.speed_duration);
  std::optional<double> step_rate_hz;
  double step_delay_ms = 0;
  double camera_error_m = 0;
  LeagueServerSettings server;
  bool has_geometry_in_every_packet = false;
  std::optional<double> start_time_s;
  double capture_error_ms = 0;
  std::vector<double> reported_field_m;  ///< length and width; empty: those of the scenario
};

/// Throws UsageError if both --league and --velocity are given.
void check(const BaseOptions& options);

void add_base_options(const CliCommand& app, BaseOptions& options);

BaseFloorSettings settings_of(const BaseOptions& options);
LeagueTraits traits_of(const BaseOptions& options);
/// The floor with the field that the simulator reports in geometry packets.
Scenario reported_floor(const Scenario& floor, const BaseOptions& options);
/// Throws std::invalid_argument if an address is invalid.
LeagueServerPorts ports_of(const BaseOptions& options);

}  // namespace sidestep
