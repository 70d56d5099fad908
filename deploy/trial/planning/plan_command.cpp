// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/planning/plan_command.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fmt/format.h>
#include <memory>

#include "agents/navigation/local_driver.hpp"
#include "agents/planning/smoothing/leader_follower.hpp"
#include "common/config/planner_names.hpp"
#include "common/file/console.hpp"
#include "common/file/write_file.hpp"
#include "common/process/command_line.hpp"
#include "common/process/help/page_path.hpp"
#include "common/process/process.hpp"
#include "deploy/trial/planning/plan_picture.hpp"
#include "deploy/trial/planning/world_file.hpp"

namespace sidestep {
namespace {

struct PlanOptions {
  std::string world;
  std::string planner = "lazy-visibility";
  std::string picture_file;
  std::size_t query = 0;
  std::uint64_t seed = 1;
  double milliseconds = 100;
};

Time now() {
  return Time(std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch()));
}

/// Loads a world file, or makes one of the benchmark's worlds, given by its name.
PlanWorld world_of(const PlanOptions& options) {
  const auto& names = world_names();
  const bool is_name = std::find(names.begin(), names.end(), options.world) != names.end();
  return is_name ? make_world(options.world, options.query + 1, options.seed)
                 : load_plan_world(options.world);
}

/// All planners, including local methods that drive without a plan.
std::vector<std::string> names() {
  std::vector<std::string> names = planner_names();
  for (const std::string& name : driving_planners())
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  return names;
}

NamedPlanner planner_of(const std::string& name) {
  const bool only_drives = std::ranges::find(planner_names(), name) == planner_names().end();
  return only_drives ? make_driving_planner(name) : make_planner(name);
}

/// The bubbles of a local method's band along a path, after enough updates for the band to settle.
std::vector<Circle> band_along(const std::vector<Vec2>& path_m, const NamedPlanner& planner,
                               const PlanWorld& world, const ObstacleWorld& obstacles) {
  constexpr int kUpdates = 100;
  LocalDriver driver(*planner.local, world.field, world.radius_m, world.radius_m, MotionLimits{});
  for (int i = 0; i < kUpdates; ++i)
    (void)driver.choose(
        {.at = {path_m.front(), {0, 0}}, .path_m = std::span(path_m).subspan(1), .world = &obstacles});
  std::vector<Circle> band;
  for (const Bubble& bubble : driver.bubbles()) band.push_back({bubble.centre_m, bubble.radius_m});
  return band;
}

int plan(const PlanOptions& options) {
  // The picture is drawn even if the reader of the output disappears.
  std::signal(SIGPIPE, SIG_IGN);
  const PlanWorld world = world_of(options);
  if (options.query >= world.queries.size()) {
    fmt::print(stderr, "sidestep: --query: expected 0..{} for {}, got {}\n", world.queries.size() - 1,
               options.world, options.query);
    return kExitUsage;
  }
  if (!options.picture_file.empty()) require_replaceable(options.picture_file);
  const PlanQuery& query = world.queries[options.query];
  const ObstacleWorld obstacles(world.obstacles);
  const NamedPlanner planner = planner_of(options.planner);
  const DiscDomain domain(obstacles, world.field, world.radius_m, query.start_m, query.goal_m,
                          planner.domain_settings(world.field, world.radius_m));
  Rng rng(options.seed);
  const Budget budget{.until = now() + from_seconds(options.milliseconds * 1e-3), .clock = now};
  const Time begin = now();
  const Plan<Vec2>& found = planner.plan(domain, query.start_m, budget, rng);
  const Time planned = now();
  Plan<Vec2> smoothed = found;
  LeaderFollower<DiscDomain>().smooth(domain, smoothed);
  const Time end = now();
  const std::string result =
      fmt::format("{}: {}{}{}, {:.3f} m in {:.1f} us, smoothed {:.3f} m in {:.1f} us; {} nodes, {} samples\n",
                  world.name, name_of(found.reason), found.start_blocked ? ", start blocked" : "",
                  found.goal_blocked ? ", goal blocked" : "", found.length, 1e6 * to_seconds(planned - begin),
                  smoothed.length, 1e6 * to_seconds(end - planned), found.nodes, found.samples);
  const int error = write_text(stdout, result);
  if (!options.picture_file.empty()) {
    PlanDrawing drawing = planner.draw();
    if (planner.local && planner.local->uses_band && found.arrives() && smoothed.states.size() > 1)
      drawing.band = band_along(smoothed.states, planner, world, obstacles);
    const std::string subtitle = fmt::format(
        "query {}, {}: {}", options.query, options.planner,
        found.arrives() ? fmt::format("{:.2f} m, smoothed {:.2f} m", found.length, smoothed.length)
                        : std::string(name_of(found.reason)));
    write_file(options.picture_file,
               plan_picture(world, query, drawing, found.states, smoothed.states, subtitle));
  }
  require_printed(error);
  return found.arrives() ? 0 : kExitFailure;
}

}  // namespace

void add_plan_command(const CliCommand& root, std::function<int()>& action) {
  const CliCommand command = root.add_subcommand("plan", "Plans a path in a world and draws it");
  const auto options = std::make_shared<PlanOptions>();
  command
      .add_option("WORLD", options->world,
                  fmt::format("world file (see {}), or one of {}",
                              page_path("deploy/trial/planning/README.md"), fmt::join(world_names(), ", ")))
      .required();
  command.add_option("--planner", options->planner, "name of the planner")
      .check(one_of(names()))
      .show_default();
  command.add_option(
      "--svg", options->picture_file,
      "draw the world, the tree, the cache, the path and a local method's band into this file; an earlier "
      "file is replaced");
  command.add_option("--query", options->query, "index of the world's query to plan, from 0")
      .check(in_range(0, 99'999))
      .show_default();
  command.add_option("--seed", options->seed, "random seed").check(non_negative()).show_default();
  command.add_option("--ms", options->milliseconds, "time limit of the planner, milliseconds")
      .check(in_range(0.001, 3.6e6))
      .show_default();
  command.on_parsed([&action, options] { action = [options] { return plan(*options); }; });
}

}  // namespace sidestep
