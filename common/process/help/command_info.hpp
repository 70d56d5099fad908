// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace sidestep {

/// An option or a positional argument, as help, man pages and completions describe it.
struct OptionInfo {
  std::vector<std::string> names;  ///< "-h", "--help"; of a positional argument its name in capitals
  std::string value;               ///< "NUMBER", "TEXT" or "NUMBER,NUMBER"; empty: a flag
  std::string description;
  std::string limits;                ///< "0 to 232" or "greater than 0"; empty: none
  std::vector<std::string> choices;  ///< the permitted values; empty: no such list
  std::string default_value;         ///< empty: none, or named in the description
  bool is_required = false;
  bool is_list = false;            ///< takes several values
  bool is_value_optional = false;  ///< takes a value or none
  std::vector<std::string> needs;  ///< names of options without which it is refused
  std::vector<std::string> excludes;

  bool takes_number() const { return value.starts_with("NUMBER"); }
};

/// A program or command with its options and its own commands.
struct CommandInfo {
  std::string path;  ///< "sidestep keys issue"
  std::string description, footer;
  bool needs_command = false;  ///< refused without one of its commands
  std::vector<OptionInfo> positionals, options;
  std::vector<CommandInfo> commands;

  /// The last word of the path.
  std::string name() const { return path.substr(path.rfind(' ') + 1); }
};

/// The option's description with its limits, choices, default and relations: "DDS domain, 0 to 232 [0]".
[[nodiscard]] std::string full_description(const OptionInfo& option);

/// "sidestep go [OPTIONS] [ROBOT] [GOAL...]".
[[nodiscard]] std::string usage(const CommandInfo& command);

/// Calls `use` for the command and for every command below it.
template <typename Use>
void for_each_command(const CommandInfo& command, Use use) {
  use(command);
  for (const CommandInfo& inner : command.commands) for_each_command(inner, use);
}

}  // namespace sidestep
