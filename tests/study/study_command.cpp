// SPDX-License-Identifier: Apache-2.0
#include "tests/study/study_command.hpp"

#include <memory>

#include "common/config/planner_names.hpp"
#include "common/process/command_line.hpp"
#include "tests/study/buildings/buildings_study.hpp"
#include "tests/study/camera/camera_study.hpp"
#include "tests/study/clutter/clutter_study.hpp"
#include "tests/study/corners/corner_study.hpp"
#include "tests/study/joint_planning/joint_planning_study.hpp"
#include "tests/study/navigation/navigation_study.hpp"
#include "tests/study/planning/planning_study.hpp"
#include "tests/study/potential/potential_study.hpp"
#include "tests/study/safety/safety_study.hpp"
#include "tests/study/vision/vision_study.hpp"

namespace sidestep {
namespace {

void add_jobs_option(const CliCommand& command, int& jobs) {
  command.add_option("--jobs", jobs, "number of parallel processes").check(in_range(1, 256)).show_default();
}

CliCommand add_study(const CliCommand& study, const std::string& name, const std::string& description,
                     StudyOptions& options) {
  const CliCommand command = study.add_subcommand(name, description);
  command.add_option("--out", options.folder, "folder for the tables and plots").required();
  command.add_option("--seed", options.seed, "seed of all random numbers").show_default();
  command.add_flag("--quick", options.is_quick, "run a small version of every experiment");
  return command;
}

void add_clutter_study(const CliCommand& study, std::function<int()>& action) {
  const auto options = std::make_shared<StudyOptions>();
  const auto planners = std::make_shared<std::vector<std::string>>();
  const CliCommand clutter = add_study(
      study, "clutter", "Every planner among obstacles and people: time, contacts, crashes", *options);
  clutter
      .add_option("--planner", *planners,
                  "planners, separated by commas [all planners that can drive robots]")
      .comma_separated()
      .check(one_of(driving_planners()));
  add_jobs_option(clutter, options->jobs);
  clutter.on_parsed([&action, options, planners] {
    action = [options, planners] { return study_clutter(*options, *planners); };
  });
}

void add_buildings_study(const CliCommand& study, std::function<int()>& action) {
  const auto options = std::make_shared<BuildingsOptions>();
  const CliCommand buildings = add_study(
      study, "buildings", "Robots that repeatedly drive to random places of scenarios", options->study);
  buildings
      .add_option("SCENARIO", options->scenario_files,
                  "scenario files; robots drive between their starts and goals")
      .required();
  buildings.add_option("--planner", options->planners, "planners, separated by commas")
      .comma_separated()
      .check(one_of(driving_planners()))
      .show_default();
  buildings.add_flag("--dds", options->over_dds,
                     "run over DDS in real time, with a process for each part of the system");
  buildings.add_option("--seconds", options->seconds, "virtual time of each run")
      .check(in_range(1, 86400))
      .show_default();
  buildings.add_option("--trials", options->trials, "runs of each planner, with consecutive seeds")
      .check(positive())
      .show_default();
  add_jobs_option(buildings, options->study.jobs);
  buildings.on_parsed([&action, options] { action = [options] { return study_buildings(*options); }; });
}

void add_sight_study(const CliCommand& study, const std::string& name, const std::string& description,
                     int (*run)(const StudyOptions&), std::function<int()>& action) {
  const auto options = std::make_shared<StudyOptions>();
  const CliCommand command = add_study(study, name, description, *options);
  command.add_option("--cases", options->cases, "number of random cases").check(positive()).show_default();
  add_jobs_option(command, options->jobs);
  command.on_parsed([&action, options, run] { action = [options, run] { return run(*options); }; });
}

}  // namespace

void add_study_command(const CliCommand& root, std::function<int()>& action) {
  const CliCommand study = root.add_subcommand("study", "Experiments on the system, see tests/study");
  study.require_subcommand();
  const auto options = std::make_shared<StudyOptions>();
  const CliCommand safety =
      add_study(study, "safety",
                "The safety search: traversals with and without it, margins under noise, time", *options);
  add_jobs_option(safety, options->jobs);
  safety.on_parsed([&action, options] { action = [options] { return study_safety(*options); }; });
  const CliCommand planning =
      add_study(study, "planning",
                "Planners and collision structures: caches, trees, graphs, roadmaps, terrain", *options);
  planning.on_parsed([&action, options] { action = [options] { return study_planning(*options); }; });
  add_clutter_study(study, action);
  add_buildings_study(study, action);
  add_sight_study(study, "corners",
                  "A robot with a laser, and people who step out from behind corners: crashes, time",
                  study_corners, action);
  add_sight_study(study, "doorways",
                  "A robot with a laser, and people who stand in doorways and step out: crashes, time",
                  study_doorways, action);
  const CliCommand joint =
      add_study(study, "explicit",
                "Joint planning of robots as one or by priority, compared with the safety search", *options);
  joint.on_parsed([&action, options] { action = [options] { return study_joint_planning(*options); }; });
  const CliCommand potential =
      add_study(study, "potential",
                "Potential fields: local minima and oscillation, compared with E* and NF1", *options);
  potential.on_parsed([&action, options] { action = [options] { return study_potential(*options); }; });
  const CliCommand camera =
      add_study(study, "camera",
                "A robot guided by colour blobs in one camera's image: drives, stages, paths", *options);
  camera.on_parsed([&action, options] { action = [options] { return study_camera(*options); }; });
  const CliCommand navigation =
      add_study(study, "navigation", "Navigation functions on grids: errors, replanning, costs", *options);
  navigation.on_parsed([&action, options] { action = [options] { return study_navigation(*options); }; });
  const CliCommand vision =
      add_study(study, "vision", "Vision in rendered frames: recognition, pose errors, time", *options);
  vision.on_parsed([&action, options] { action = [options] { return study_vision(*options); }; });
}

}  // namespace sidestep
