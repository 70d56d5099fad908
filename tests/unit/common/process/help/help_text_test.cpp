// SPDX-License-Identifier: Apache-2.0
#include "common/process/help/help_text.hpp"

#include <sstream>

#include "tests/catch.hpp"

namespace sidestep::help_text_test {

OptionInfo option(std::vector<std::string> names, const std::string& value, const std::string& description) {
  OptionInfo info;
  info.names = std::move(names);
  info.value = value;
  info.description = description;
  return info;
}

CommandInfo sample() {
  CommandInfo command;
  command.path = "sidestep send";
  command.description = "Sends robots to goals";
  OptionInfo robot = option({"ROBOT"}, "NUMBER", "robot id");
  robot.is_required = true;
  OptionInfo goals = option({"GOAL"}, "TEXT...", "X,Y in metres");
  goals.is_list = true;
  command.positionals = {robot, goals};
  OptionInfo domain = option({"--domain"}, "NUMBER", "DDS domain");
  domain.limits = "0 to 232";
  domain.default_value = "0";
  OptionInfo mode = option({"--mode"}, "TEXT", "how to drive");
  mode.choices = {"fast", "slow"};
  mode.needs = {"--domain"};
  OptionInfo monitor = option({"--monitor"}, "TEXT", "show it in the browser [8080]");
  monitor.is_value_optional = true;
  monitor.excludes = {"--mode"};
  command.options = {option({"-h", "--help"}, "", "print this help"), domain, mode, monitor,
                     option({"--a-very-long-option-name"}, "TEXT", "no room beside it")};
  CommandInfo inner;
  inner.path = "sidestep send back";
  inner.description = "Sends them back";
  command.commands = {inner};
  command.footer = "More is in the guide.";
  return command;
}

TEST_CASE("help has usage and arguments and options and commands with limits and defaults in plain words") {
  CHECK(help_text(sample(), 100) == R"(Sends robots to goals
Usage: sidestep send [OPTIONS] ROBOT [GOAL...] [COMMAND]

Arguments:
  ROBOT                   robot id
  GOAL...                 X,Y in metres

Options:
  -h, --help              print this help
  --domain NUMBER         DDS domain, 0 to 232 [0]
  --mode TEXT             how to drive: fast, slow; needs --domain
  --monitor[=TEXT]        show it in the browser [8080]; not with --mode
  --a-very-long-option-name TEXT
                          no room beside it

Commands:
  back                    Sends them back

More is in the guide.
)");
}

TEST_CASE("lines of help fit into the terminal") {
  CommandInfo command = sample();
  for (int i = 0; i < 30; ++i) command.options[2].choices.push_back("choice-" + std::to_string(i));
  const std::size_t width = GENERATE(60, 80, 120);
  std::istringstream text(help_text(command, width));
  std::string all;
  for (std::string line; std::getline(text, line); all += line) {
    CAPTURE(line);
    CHECK(line.size() <= width);
  }
  CHECK_THAT(all, ContainsSubstring("choice-0,") && ContainsSubstring("choice-29;"));
}

}  // namespace sidestep::help_text_test
