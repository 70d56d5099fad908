// SPDX-License-Identifier: Apache-2.0
#include "tests/study/study_command.hpp"

#include <fstream>

#include "common/process/command_line.hpp"
#include "common/process/process.hpp"
#include "tests/catch.hpp"
#include "tests/unit/study/study_files.hpp"

namespace sidestep::study_command_test {

/// Parses `sidestep study ARGUMENTS`, runs its action if there is one, and returns the exit code.
int study(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"sidestep", "study"});
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  CommandLine command_line("test", "sidestep");
  const CliCommand app = command_line.root();
  std::function<int()> action;
  add_study_command(app, action);
  const auto exit_code = command_line.parse(static_cast<int>(argv.size()), argv.data());
  return exit_code ? *exit_code : action();
}

TEST_CASE("a study with invalid arguments is rejected before it begins") {
  const std::string name = GENERATE(as<std::string>(), "safety", "planning", "vision", "clutter", "corners",
                                    "explicit", "navigation", "potential", "camera");
  StudyFolder folder;
  CAPTURE(name);
  CHECK(study({}) == kExitUsage);
  CHECK(study({"tides"}) == kExitUsage);
  CHECK(study({name}) == kExitUsage);
  CHECK(study({name, "--out", ""}) == kExitUsage);
  CHECK(study({name, "--out", folder.path(), "more"}) == kExitUsage);
  for (const char* seed : {"-1", "1.5", "one", "18446744073709551616"}) {
    CAPTURE(seed);
    CHECK(study({name, "--out", folder.path(), "--seed", seed}) == kExitUsage);
  }
  CHECK_FALSE(std::filesystem::exists(folder.path()));
}

TEST_CASE("a study of buildings rejects missing scenarios and planners that cannot drive") {
  StudyFolder folder;
  const std::string file = SIDESTEP_SOURCE_DIR "/deploy/scenarios/house.yaml";
  CHECK(study({"buildings", "--out", folder.path()}) == kExitUsage);
  CHECK(study({"buildings", file}) == kExitUsage);
  for (const auto& [option, value] : {std::pair{"--planner", "errt,legs"},
                                      {"--planner", "legs"},
                                      {"--seconds", "0"},
                                      {"--trials", "-1"},
                                      {"--jobs", "0"}}) {
    CAPTURE(option, value);
    CHECK(study({"buildings", file, "--out", folder.path(), option, value}) == kExitUsage);
  }
  CHECK_THROWS_WITH(study({"buildings", "nowhere.yaml", "--out", folder.path()}),
                    ContainsSubstring("nowhere.yaml"));
  CHECK_FALSE(std::filesystem::exists(folder.path()));
}

TEST_CASE("a study reports an unwritable folder before it begins") {
  const std::string name = GENERATE(as<std::string>(), "safety", "planning", "vision", "clutter", "corners",
                                    "explicit", "navigation", "potential", "camera");
  StudyFolder folder;
  std::ofstream(folder.path()) << "a file";
  CHECK_THROWS_WITH(study({name, "--out", folder.path()}), ContainsSubstring(folder.path()));
}

}  // namespace sidestep::study_command_test
