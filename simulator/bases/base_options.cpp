// SPDX-License-Identifier: Apache-2.0
#include "simulator/bases/base_options.hpp"

#include "common/league/decode_error.hpp"

namespace sidestep {

void add_base_options(const CliCommand& app, BaseOptions& options) {
  app.add_flag("--league", options.is_league,
               "robots have no firmware; they are driven by clients of the league's simulation protocol");
  app.add_flag("--velocity", options.is_velocity,
               "robots have no firmware; they are bases with ROS 2's topics for velocities and odometry");
  add_bases_bus_options(app, "with --velocity", options.velocity);
  app.add_option("--odometry-drift", options.odometry_drift,
                 "with --velocity: relative error of the odometry")
      .check(in_range(0, 0.5))
      .show_default();
  app.add_option("--control", options.control, "with --league: ADDRESS:PORT for simulator commands")
      .show_default();
  app.add_option("--blue", options.blue, "with --league: ADDRESS:PORT for the blue team's commands")
      .show_default();
  app.add_option("--yellow", options.yellow, "with --league: ADDRESS:PORT for the yellow team's commands")
      .show_default();
  app.add_option("--team-size", options.team_size,
                 "with --league: add opponents until each team has this many robots")
      .check(in_range(0, league::kRobotNumbers))
      .show_default();
  app.add_option("--latency-ms", options.latency_ms,
                 "without firmware: delay from a command to the first motion")
      .check(in_range(0, 1000))
      .show_default();
  app.add_option("--silence-ms", options.silence_ms,
                 "without firmware: robots brake after this time without a command")
      .check(in_range(10, 10000))
      .show_default();
  app.add_option("--braking", options.braking_mps2, "without firmware: deceleration of the robots, m/s²")
      .check(in_range(0.1, 20))
      .show_default();
  app.add_option("--loss", options.loss, "with --league: probability that a command or vision packet is lost")
      .check(in_range(0, 1))
      .show_default();
  app.add_option("--speed", options.speed, "without firmware: speed of the simulation, relative to real time")
      .check(in_range(0.1, 10))
      .show_default();
  app.add_flag("--accept-global", options.accepts_global,
               "with --league: also accept velocities in the field's frame");
  app.add_flag("--geometry-always", options.has_geometry_in_every_packet,
               "with --league: send the geometry in every vision packet instead of every 3 s");
  app.add_flag("--times-from-start", options.counts_from_start,
               "with --league: capture times count from the simulation's start instead of 1970");
}

void check(const BaseOptions& options) {
  if (options.is_league && options.is_velocity)
    throw UsageError("--velocity: cannot be combined with --league");
}

BaseSettings settings_of(const BaseOptions& options) {
  BaseSettings settings;
  settings.latency = from_seconds(options.latency_ms * 1e-3);
  settings.silence_timeout = from_seconds(options.silence_ms * 1e-3);
  settings.braking_mps2 = options.braking_mps2;
  return settings;
}

LeagueTraits traits_of(const BaseOptions& options) {
  LeagueTraits traits;
  if (options.has_geometry_in_every_packet) traits.geometry_period = Duration::zero();
  traits.counts_from_start = options.counts_from_start;
  traits.loss = options.loss;
  return traits;
}

LeagueServerPorts ports_of(const BaseOptions& options) {
  return {league::parse_unicast_endpoint(options.control), league::parse_unicast_endpoint(options.blue),
          league::parse_unicast_endpoint(options.yellow)};
}

}  // namespace sidestep
