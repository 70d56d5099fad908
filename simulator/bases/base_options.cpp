// SPDX-License-Identifier: Apache-2.0
#include "simulator/bases/base_options.hpp"

#include <array>
#include <string_view>
#include <utility>

#include "common/league/decode_error.hpp"

namespace sidestep {
namespace {

constexpr std::array<std::pair<std::string_view, StartPlaces>, 3> kStarts{
    {{"scenario", StartPlaces::kScenario},
     {"line", StartPlaces::kLine},
     {"shuffled", StartPlaces::kShuffled}}};

std::vector<std::string> names_of_starts() {
  std::vector<std::string> names;
  for (const auto& [name, starts] : kStarts) names.emplace_back(name);
  return names;
}

void add_motion_options(const CliCommand& app, BaseOptions& options) {
  app.add_option("--latency-ms", options.latency_ms,
                 "without firmware: delay from a command to the first motion")
      .check(in_range(0, 1000))
      .show_default();
  app.add_option("--silence-ms", options.silence_ms,
                 "without firmware: robots follow their last command for this time, then come to rest")
      .check(in_range(10, 10000))
      .show_default();
  app.add_option("--coast-ms", options.coast_ms,
                 "without firmware: time in which robots without commands come to rest evenly; 0: they brake")
      .check(in_range(0, 10000))
      .show_default();
  app.add_option("--braking", options.braking_mps2, "without firmware: deceleration of the robots, m/s²")
      .check(in_range(0.1, 20))
      .show_default();
  app.add_option("--drag", options.drag_per_s,
                 "without firmware: deceleration by drag, as a multiple of the velocity, 1/s")
      .check(in_range(0, 10))
      .show_default();
  app.add_option("--turn-speed", options.max_turn_radps,
                 "without firmware: maximum turning speed of the robots, rad/s")
      .check(in_range(0.1, 100))
      .show_default();
}

void add_time_options(const CliCommand& app, BaseOptions& options) {
  app.add_option("--speed", options.speeds,
                 "without firmware: speed of the simulation, relative to real time; or several, which take "
                 "turns, e.g. 0.98,0.66")
      .comma_separated()
      .check(in_range(0.1, 10))
      .show_default("1");
  app.add_option("--speed-change-s", options.speed_duration_s,
                 "without firmware: time after which the next of several speeds begins")
      .check(in_range(0.1, 3600))
      .show_default();
  const Option step = app.add_option("--step-hz", options.step_rate_hz,
                                     "without firmware: simulated time advances in this many steps per "
                                     "second; otherwise continuously")
                          .check(in_range(5, 1000));
  app.add_option("--step-delay-ms", options.step_delay_ms,
                 "without firmware: each step is late by a random time up to this")
      .check(in_range(0, 500))
      .needs(step)
      .show_default();
}

void add_packet_options(const CliCommand& app, BaseOptions& options) {
  app.add_option("--loss", options.server.loss,
                 "with --league: probability that a command or vision packet is lost")
      .check(in_range(0, 1))
      .show_default();
  app.add_flag("--accept-global", options.server.accepts_global,
               "with --league: also accept velocities in the field's frame");
  app.add_option("--packets-per-answer", options.server.packets_per_answer,
                 "with --league: number of a team's command packets that are answered together")
      .check(in_range(1, 100))
      .show_default();
  app.add_option("--camera-error", options.camera_error_m,
                 "without firmware: each camera sees everything this far too far away from the field's "
                 "centre, m")
      .check(in_range(0, 0.1))
      .show_default();
  app.add_flag("--geometry-always", options.has_geometry_in_every_packet,
               "with --league: send the geometry in every vision packet instead of every 3 s");
  app.add_option("--reported-field", options.reported_field_m,
                 "with --league: LENGTH,WIDTH of the field in geometry packets, m [those of the scenario]")
      .comma_separated(2)
      .check(in_range(0.5, 1000));
  app.add_option("--start-time-s", options.start_time_s,
                 "with --league: times in vision packets count simulated seconds from this value; otherwise "
                 "they are real times since 1970")
      .check(in_range(-1000, 4e9));
  app.add_option(
         "--capture-error-ms", options.capture_error_ms,
         "with --league: capture times in vision packets are too late by this, but at most the time of "
         "sending")
      .check(in_range(0, 1000))
      .show_default();
}

}  // namespace

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
  app.add_option("--starts", options.starts,
                 "without firmware: where robots start: where the scenario says, in a line along the field's "
                 "upper edge, or each at another one's place")
      .check(one_of(names_of_starts()))
      .show_default();
  add_motion_options(app, options);
  add_time_options(app, options);
  add_packet_options(app, options);
}

void check(const BaseOptions& options) {
  if (options.is_league && options.is_velocity)
    throw UsageError("--velocity: cannot be combined with --league");
}

BaseFloorSettings settings_of(const BaseOptions& options) {
  BaseFloorSettings settings;
  settings.bases.latency = from_seconds(options.latency_ms * 1e-3);
  settings.bases.silence_timeout = from_seconds(options.silence_ms * 1e-3);
  settings.bases.coast = from_seconds(options.coast_ms * 1e-3);
  settings.bases.braking_mps2 = options.braking_mps2;
  settings.bases.drag_per_s = options.drag_per_s;
  settings.bases.max_turn_radps = options.max_turn_radps;
  settings.team_size = options.is_league ? options.team_size : 0;
  for (const auto& [name, starts] : kStarts) {
    if (name == options.starts) settings.starts = starts;
  }
  settings.pace.speeds = options.speeds;
  settings.pace.speed_duration = from_seconds(options.speed_duration_s);
  if (options.step_rate_hz) settings.pace.step = from_seconds(1 / *options.step_rate_hz);
  settings.pace.max_step_delay = from_seconds(options.step_delay_ms * 1e-3);
  settings.camera_error_m = options.camera_error_m;
  return settings;
}

LeagueTraits traits_of(const BaseOptions& options) {
  LeagueTraits traits;
  if (options.has_geometry_in_every_packet) traits.geometry_period = Duration::zero();
  if (options.start_time_s) traits.times.start = from_seconds(*options.start_time_s);
  traits.times.capture_error = from_seconds(options.capture_error_ms * 1e-3);
  traits.loss = options.server.loss;
  return traits;
}

Scenario reported_floor(const Scenario& floor, const BaseOptions& options) {
  Scenario reported = floor;
  if (options.reported_field_m.size() == 2)
    reported.field = {options.reported_field_m[0], options.reported_field_m[1]};
  return reported;
}

LeagueServerPorts ports_of(const BaseOptions& options) {
  return {league::parse_unicast_endpoint(options.control), league::parse_unicast_endpoint(options.blue),
          league::parse_unicast_endpoint(options.yellow)};
}

}  // namespace sidestep
