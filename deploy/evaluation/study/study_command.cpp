// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/study/study_command.hpp"

#include <CLI/CLI.hpp>
#include <charconv>
#include <memory>

#include "deploy/evaluation/study/planning/planning_study.hpp"
#include "deploy/evaluation/study/safety/safety_study.hpp"
#include "deploy/evaluation/study/vision/vision_study.hpp"

namespace sidestep {
namespace {

/// In place of the library's own: that takes -1 for a large number.
std::string whole_number(const std::string& text) {
  std::uint64_t number = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && rest == end
             ? ""
             : "expected a whole number from 0 to 18446744073709551615, got \"" + text + "\"";
}

std::string not_empty(const std::string& text) { return text.empty() ? "must not be empty" : ""; }

CLI::App* add_study(CLI::App& study, const std::string& name, const std::string& description,
                    StudyOptions& options) {
  CLI::App* command = study.add_subcommand(name, description);
  command->add_option("--out", options.folder, "folder for the tables and plots")
      ->required()
      ->check(not_empty);
  command->add_option("--seed", options.seed, "of everything that is random")
      ->check(whole_number)
      ->capture_default_str();
  command->add_flag("--quick", options.is_quick, "little of everything");
  return command;
}

}  // namespace

void add_study_command(CLI::App& root, std::function<int()>& action) {
  CLI::App* study = root.add_subcommand("study", "Measures what the system is good for, see deploy/evaluation/study");
  study->require_subcommand(1);
  const auto options = std::make_shared<StudyOptions>();
  CLI::App* safety = add_study(
      *study, "safety", "The safety search: with and without it, margins against noise, time", *options);
  safety->add_option("--jobs", options->jobs, "processes at work")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  safety->callback([&action, options] { action = [options] { return study_safety(*options); }; });
  CLI::App* planning = add_study(
      *study, "planning",
      "Planners and collision structures: caches, trees, graphs, roadmaps, from 4 to 16,384 obstacles",
      *options);
  planning->callback([&action, options] { action = [options] { return study_planning(*options); }; });
  CLI::App* vision =
      add_study(*study, "vision", "Vision in rendered frames: who is found, errors of poses, time", *options);
  vision->callback([&action, options] { action = [options] { return study_vision(*options); }; });
}

}  // namespace sidestep
