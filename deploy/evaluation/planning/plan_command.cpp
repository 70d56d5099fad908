// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/planning/plan_command.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <fstream>
#include <memory>

#include "agents/planning/smoothing/leader_follower.hpp"
#include "common/process/process.hpp"
#include "deploy/evaluation/planning/plan_bench.hpp"
#include "deploy/evaluation/planning/plan_picture.hpp"
#include "deploy/evaluation/planning/replan_bench.hpp"
#include "deploy/evaluation/planning/world_file.hpp"

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

/// A file, or one of the benchmark's worlds by its name.
PlanWorld world_of(const PlanOptions& options) {
  const auto& names = world_names();
  const bool is_name = std::find(names.begin(), names.end(), options.world) != names.end();
  return is_name ? make_world(options.world, options.query + 1, options.seed)
                 : load_plan_world(options.world);
}

void write_file(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path);
}

int plan(const PlanOptions& options) {
  const PlanWorld world = world_of(options);
  if (options.query >= world.queries.size()) {
    fmt::print(stderr, "sidestep: --query {}: {} has {} queries, the first is 0\n", options.query,
               options.world, world.queries.size());
    return kExitUsage;
  }
  const PlanQuery& query = world.queries[options.query];
  const ObstacleWorld obstacles(world.obstacles);
  const DiscDomain domain(obstacles, world.field, world.radius_m, query.start_m, query.goal_m);
  NamedPlanner planner = make_planner(options.planner);
  Rng rng(options.seed);
  const Budget budget{.until = now() + from_seconds(options.milliseconds * 1e-3), .clock = now};
  const Time begin = now();
  const Plan<Vec2>& found = planner.plan(domain, query.start_m, budget, rng);
  const Time planned = now();
  Plan<Vec2> smooth = found;
  LeaderFollower<DiscDomain>().smooth(domain, smooth);
  const Time smoothed = now();
  fmt::print("{}: {}{}{}, {:.3f} m in {:.1f} us, smoothed {:.3f} m in {:.1f} us; {} nodes, {} samples\n",
             world.name, name_of(found.reason), found.start_blocked ? ", start blocked" : "",
             found.goal_blocked ? ", goal blocked" : "", found.length, 1e6 * to_seconds(planned - begin),
             smooth.length, 1e6 * to_seconds(smoothed - planned), found.nodes, found.samples);
  if (!options.picture_file.empty())
    write_file(options.picture_file, plan_picture(world, query, planner.draw(), found.states, smooth.states));
  return found.arrives() ? 0 : kExitFailure;
}

void add_plan_command(CLI::App& root, std::function<int()>& action) {
  CLI::App* command = root.add_subcommand("plan", "Plans a way in a world and draws it");
  const auto options = std::make_shared<PlanOptions>();
  command
      ->add_option(
          "WORLD", options->world,
          fmt::format("world file, see deploy/evaluation/planning/README.md, or {}", fmt::join(world_names(), ", ")))
      ->required();
  command->add_option("--planner", options->planner, "the planner")
      ->check(CLI::IsMember(planner_names()))
      ->capture_default_str();
  command->add_option("--svg", options->picture_file, "draw world, tree, cache and way into this file");
  command->add_option("--query", options->query, "which of the world's")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--seed", options->seed, "of everything that is random")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--ms", options->milliseconds, "time that the planner may take")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->callback([&action, options] { action = [options] { return plan(*options); }; });
}

void add_bench_command(CLI::App& root, std::function<int()>& action) {
  CLI::App* bench = root.add_subcommand("bench", "Measures parts of the system side by side");
  bench->require_subcommand(1);
  CLI::App* command = bench->add_subcommand("planning", "All planners in all worlds: time, length, validity");
  const auto options = std::make_shared<PlanBenchOptions>();
  command->add_option("--world", options->worlds, "only these")->check(CLI::IsMember(world_names()));
  command->add_option("--planner", options->planners, "only these")
      ->check(CLI::IsMember(bench_planner_names()));
  command->add_option("--queries", options->queries, "in each world")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--seed", options->seed, "of everything that is random")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--ms", options->milliseconds, "time that a planner may take for a query")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->callback([&action, options] {
    action = [options] {
      bench_planning(*options);
      if (options->worlds.empty()) bench_replanning(*options);
      return 0;
    };
  });
}

}  // namespace

void add_plan_commands(CLI::App& root, std::function<int()>& action) {
  add_plan_command(root, action);
  add_bench_command(root, action);
}

}  // namespace sidestep
