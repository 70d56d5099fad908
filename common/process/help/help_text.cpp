// SPDX-License-Identifier: Apache-2.0
#include "common/process/help/help_text.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sstream>
#include <unistd.h>

#include "common/terminal/terminal.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kColumn = 26;  ///< where descriptions begin

/// The words in lines of at most `width` columns, each after `indent` spaces.
std::string wrapped(const std::string& text, std::size_t indent, std::size_t width) {
  std::istringstream words(text);
  std::string result, line;
  const auto end_line = [&] {
    if (!line.empty()) result += std::string(indent, ' ') + line + "\n";
    line.clear();
  };
  for (std::string word; words >> word;) {
    if (!line.empty() && indent + line.size() + 1 + word.size() > width) end_line();
    line += (line.empty() ? "" : " ") + word;
  }
  end_line();
  return result;
}

/// A row of two columns; the second begins on the next line if the first is too long.
std::string row(const std::string& heading, const std::string& description, std::size_t width) {
  const std::string first = "  " + heading;
  std::string text = wrapped(description, kColumn, width);
  if (text.empty()) return first + "\n";
  if (first.size() + 2 > kColumn) return first + "\n" + text;
  return first + text.substr(first.size());
}

}  // namespace

std::string option_heading(const OptionInfo& option) {
  std::string text = fmt::format("{}", fmt::join(option.names, ", "));
  if (!option.names.front().starts_with('-')) return option.is_list ? text + "..." : text;
  if (option.is_value_optional) return fmt::format("{}[={}]", text, option.value);
  return option.value.empty() ? text : text + " " + option.value;
}

std::string help_text(const CommandInfo& command, std::size_t width) {
  std::string text = wrapped(command.description, 0, width) + "Usage: " + usage(command) + "\n";
  const auto add_options = [&](const char* heading, const std::vector<OptionInfo>& options) {
    if (!options.empty()) text += fmt::format("\n{}:\n", heading);
    for (const OptionInfo& option : options)
      text += row(option_heading(option), full_description(option), width);
  };
  add_options("Arguments", command.positionals);
  add_options("Options", command.options);
  if (!command.commands.empty()) text += "\nCommands:\n";
  for (const CommandInfo& inner : command.commands) text += row(inner.name(), inner.description, width);
  if (!command.footer.empty()) text += "\n" + wrapped(command.footer, 0, width);
  return text;
}

std::size_t help_width() {
  if (isatty(STDOUT_FILENO) == 0) return 100;
  return static_cast<std::size_t>(std::clamp(screen_size(STDOUT_FILENO).columns, 60, 120));
}

}  // namespace sidestep
