// SPDX-License-Identifier: Apache-2.0
#include "common/process/help/app_info.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <set>
#include <string>
#include <vector>

namespace sidestep {
namespace {

/// Splits "{a,b}" into its names; empty if the text has another form.
std::vector<std::string> choices_in(const std::string& text) {
  if (text.size() < 2 || !text.starts_with('{') || !text.ends_with('}')) return {};
  return CLI::detail::split(text.substr(1, text.size() - 2), ',');
}

/// The value as a word: "NUMBER" or "TEXT", once for each value of a list with commas.
std::string value_text(const CLI::Option& option, const std::string& type) {
  const std::string word = type == "INT" || type == "UINT" || type == "FLOAT" ? "NUMBER" : "TEXT";
  const bool is_unlimited = option.get_expected_max() >= CLI::detail::expected_max_vector_size;
  if (is_unlimited) return word + (option.get_delimiter() == '\0' ? "..." : ",...");
  std::string text = word;
  for (int i = 1; i < option.get_expected_min(); ++i) text += "," + word;
  return text;
}

std::vector<std::string> names_of(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) names.push_back(option->get_name());
  std::ranges::sort(names);  // the library orders them by their addresses
  return names;
}

OptionInfo option_info(const CLI::Option& option) {
  OptionInfo info;
  const bool is_positional = option.get_positional();
  if (is_positional) info.names.push_back(option.get_name(true, false));
  for (const std::string& name : option.get_snames()) info.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) info.names.push_back("--" + name);
  info.description = option.get_description();
  info.is_required = option.get_required();
  info.default_value = option.get_default_str();
  info.needs = names_of(option.get_needs());
  info.excludes = names_of(option.get_excludes());
  if (option.get_expected_max() == 0) return info;  // a flag
  // The library separates the type and the descriptions of checks by colons.
  const std::string type = option.get_type_name(), base = type.substr(0, type.find(':'));
  const std::string checks = base.size() < type.size() ? type.substr(base.size() + 1) : "";
  info.choices = choices_in(checks);
  if (info.choices.empty()) info.limits = checks;
  info.value = value_text(option, base);
  info.is_list = option.get_expected_max() >= CLI::detail::expected_max_vector_size;
  info.is_value_optional = !is_positional && option.get_expected_min() == 0;
  return info;
}

}  // namespace

CommandInfo command_info(const CLI::App& app, const std::string& path) {
  CommandInfo info;
  info.path = path;
  info.description = app.get_description();
  info.footer = app.get_footer();
  info.needs_command = app.get_require_subcommand_min() > 0;
  for (const CLI::Option* option : app.get_options([](const CLI::Option*) { return true; }))
    (option->get_positional() ? info.positionals : info.options).push_back(option_info(*option));
  for (const CLI::App* inner : app.get_subcommands([](const CLI::App*) { return true; }))
    info.commands.push_back(command_info(*inner, path + " " + inner->get_name()));
  for (CommandInfo& inner : info.commands) {
    if (inner.name() != "help") continue;
    for (const CommandInfo& command : info.commands)
      inner.positionals.front().choices.push_back(command.name());
  }
  return info;
}

}  // namespace sidestep
