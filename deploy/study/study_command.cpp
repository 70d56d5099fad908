// SPDX-License-Identifier: Apache-2.0
#include "deploy/study/study_command.hpp"

#include <CLI/CLI.hpp>
#include <memory>

#include "deploy/study/safety_study.hpp"

namespace sidestep {

void add_study_command(CLI::App& root, std::function<int()>& action) {
  CLI::App* study = root.add_subcommand("study", "Measures what the system is good for, see deploy/study");
  study->require_subcommand(1);
  CLI::App* safety =
      study->add_subcommand("safety", "The safety search: with and without it, margins against noise, time");
  const auto options = std::make_shared<StudyOptions>();
  safety->add_option("--out", options->folder, "folder for the tables and plots")->required();
  safety->add_option("--seed", options->seed, "of everything that is random")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  safety->add_option("--jobs", options->jobs, "processes at work")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  safety->add_flag("--quick", options->is_quick, "little of everything");
  safety->callback([&action, options] { action = [options] { return study_safety(*options); }; });
}

}  // namespace sidestep
