// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/process/bases_bus.hpp"
#include "common/process/command_line.hpp"
#include "simulator/bases/base_control.hpp"
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
  double latency_ms = 100;
  double silence_ms = 100;
  double braking_mps2 = BaseSettings{}.braking_mps2;
  double loss = 0;
  double speed = 1;
  bool accepts_global = false;
  bool has_geometry_in_every_packet = false;
  bool counts_from_start = false;
};

/// Throws UsageError if both --league and --velocity are given.
void check(const BaseOptions& options);

void add_base_options(const CliCommand& app, BaseOptions& options);

BaseSettings settings_of(const BaseOptions& options);
LeagueTraits traits_of(const BaseOptions& options);
/// Throws std::invalid_argument if an address is invalid.
LeagueServerPorts ports_of(const BaseOptions& options);

}  // namespace sidestep
