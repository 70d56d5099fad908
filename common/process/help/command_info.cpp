// SPDX-License-Identifier: Apache-2.0
#include "common/process/help/command_info.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace sidestep {

std::string full_description(const OptionInfo& option) {
  std::string text = option.description, default_text;
  // Some descriptions end with the default in words: "duration [until Ctrl-C]".
  if (const std::size_t bracket = text.rfind(" ["); bracket != std::string::npos && text.ends_with(']')) {
    default_text = text.substr(bracket);
    text.erase(bracket);
  }
  if (!option.default_value.empty()) default_text = fmt::format(" [{}]", option.default_value);
  const char* const separator = text.empty() ? "" : ", ";
  if (!option.limits.empty()) text += separator + option.limits;
  if (!option.choices.empty())
    text += fmt::format("{}{}", text.empty() ? "" : ": ", fmt::join(option.choices, ", "));
  text += default_text;
  if (!option.needs.empty()) text += fmt::format("; needs {}", fmt::join(option.needs, " "));
  if (!option.excludes.empty()) text += fmt::format("; not with {}", fmt::join(option.excludes, " "));
  if (option.is_required && option.names.front().starts_with('-')) text += "; required";
  return text;
}

std::string usage(const CommandInfo& command) {
  std::string text = command.path;
  if (!command.options.empty()) text += " [OPTIONS]";
  for (const OptionInfo& positional : command.positionals) {
    const std::string word = positional.names.front() + (positional.is_list ? "..." : "");
    text += positional.is_required ? " " + word : " [" + word + "]";
  }
  if (!command.commands.empty()) text += command.needs_command ? " COMMAND" : " [COMMAND]";
  return text;
}

}  // namespace sidestep
