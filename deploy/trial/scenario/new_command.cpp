// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/scenario/new_command.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <stdexcept>

#include "common/file/console.hpp"
#include "common/file/write_file.hpp"
#include "deploy/trial/scenario/scenario_schema.hpp"
#include "deploy/trial/scenario/scenario_template.hpp"

namespace sidestep {
namespace {

int write_new_scenario(const std::string& path) {
  std::error_code error;
  if (std::filesystem::exists(std::filesystem::symlink_status(path, error)))
    throw std::invalid_argument(path + " exists and is not overwritten; expected the name of a new file");
  write_file(path, scenario_template(scenario_schema_path()));
  print_output(
      "wrote {0}: a hall with a wall, a door and three robots\n"
      "  sidestep check {0}                             checks and draws it\n"
      "  sidestep simulate {0} --svg paths.svg          runs it in virtual time\n"
      "  sidestep run {0} --monitor                     runs it over DDS, in the browser\n",
      path);
  return 0;
}

}  // namespace

void add_new_command(const CliCommand& root, std::function<int()>& action) {
  const auto path = std::make_shared<std::string>();
  const CliCommand command = root.add_subcommand("new", "Writes a scenario to start from, with comments");
  command.add_option("FILE", *path, "the scenario file to write, such as hall.yaml; never overwritten")
      .required();
  command.on_parsed([path, &action] { action = [path] { return write_new_scenario(*path); }; });
}

}  // namespace sidestep
