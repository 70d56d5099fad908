// SPDX-License-Identifier: Apache-2.0
#include "common/process/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <utility>

#include "common/file/console.hpp"
#include "common/file/similar_name.hpp"
#include "common/process/exit_code.hpp"
#include "common/process/help/app_info.hpp"
#include "common/process/help/completion.hpp"
#include "common/process/help/help_text.hpp"
#include "common/process/help/man_page.hpp"
#include "common/process/number_text.hpp"
#include "common/version/version.hpp"

namespace sidestep {

CommandLine::CommandLine(const std::string& description, const std::string& program_name)
    : app_(std::make_unique<CLI::App>(description, program_name)) {
  // Called here, because every program starts by creating its command line.
  reopen_standard_streams();
  // Writing beyond the limit of a file's size then fails like writing to a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  app_->set_help_flag("-h,--help", "print this help");
  const std::function<void(const std::string&)> print = [this](const std::string& form) {
    form_ = form;
    throw CLI::CallForHelp();
  };
  root()
      .add_option("--help-as", print,
                  "print this help as a man page, or as a script with which a shell completes commands")
      .check(one_of({"man", "bash", "zsh", "fish"}));
  app_->formatter_fn([](const CLI::App* app, const std::string& path, CLI::AppFormatMode) {
    return help_text(command_info(*app, path), help_width());
  });
}

CommandLine::~CommandLine() = default;

namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

/// Says what is wrong with a word where a command is expected, and what it may stand for.
std::string unknown_command(const std::string& word, const CLI::App& app, const CommandInfo& program) {
  std::vector<std::string> names, elsewhere;
  for (const CLI::App* command : commands_of(app)) names.push_back(command->get_name());
  for_each_command(program, [&](const CommandInfo& command) {
    if (command.name() == word) elsewhere.push_back("`" + command.path + "`");
  });
  std::string hint = did_you_mean(word, names);
  if (hint.empty() && !elsewhere.empty())
    hint = fmt::format("; did you mean {}?", fmt::join(elsewhere, " or "));
  if (hint.empty()) hint = fmt::format(", expected one of: {}", fmt::join(names, ", "));
  return fmt::format("{} is not a command{}", in_quotes(word), hint);
}

/// What is wrong with an option of the program in front of a command, which would ignore it. Empty: nothing.
std::string option_before_command(const CLI::App& root) {
  if (root.get_subcommands().empty()) return "";
  const auto given = root.get_options([](const CLI::Option* option) { return option->count() > 0; });
  if (given.empty()) return "";
  return fmt::format("{}: expected after the command {}", given.front()->get_name(),
                     root.get_subcommands().front()->get_name());
}

/// Names the word found where a command is expected, because the library would only say that a command is
/// missing, and what a mistyped word may stand for.
std::string clear_message(const CLI::ParseError& error, const CLI::App& root, const CommandInfo& program) {
  if (const std::string problem = option_before_command(root);
      !problem.empty() && error.get_name() == "RequiredError")
    return problem;
  const CLI::App* app = &root;
  while (!app->get_subcommands().empty()) app = app->get_subcommands().front();
  const std::vector<std::string> rest = app->remaining(), all_rest = root.remaining(true);
  if (!commands_of(*app).empty() && !rest.empty() && !rest.front().starts_with("-"))
    return unknown_command(rest.front(), *app, program);
  const auto option = std::ranges::find_if(
      all_rest, [](const auto& word) { return word.starts_with("--") && word.size() > 2; });
  // An unknown option is the cause also if the library misses something that would have come after it.
  const auto code = static_cast<CLI::ExitCodes>(error.get_exit_code());
  const bool is_of_option = code == CLI::ExitCodes::ExtrasError || code == CLI::ExitCodes::RequiredError;
  if (!is_of_option || option == all_rest.end()) return error.what();
  std::vector<std::string> names;
  for (const OptionInfo& known : command_info(*app, "").options)
    names.insert(names.end(), known.names.begin(), known.names.end());
  return fmt::format("The following argument was not expected: {}{}", *option,
                     did_you_mean(option->substr(0, option->find('=')), names));
}

}  // namespace

/// Converts arguments to the form that the library expects. The library takes "-.5" for an option but not
/// "-0.5".
std::vector<std::string> CommandLine::reversed(std::vector<std::string> arguments) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  for (std::string& argument : arguments) {
    if (argument.size() > 2 && argument.starts_with("-.") && is_digit(argument[2])) argument.insert(1, "0");
  }
  std::ranges::reverse(arguments);
  return arguments;
}

void CommandLine::add_help_command() {
  help_command_ = app_->add_subcommand("help", "Shows the help of a command");
  CliCommand(*help_command_)
      .add_option("COMMAND", help_words_, "command, and the one below it if there is any, e.g. topic echo");
}

CommandInfo CommandLine::info() const { return command_info(*app_, app_->get_name()); }

std::string CommandLine::help(const std::vector<std::string>& words) const {
  const CLI::App* app = app_.get();
  std::string path = app->get_name();
  for (const std::string& word : words) {
    const auto commands = commands_of(*app);
    const auto found = std::ranges::find_if(commands, [&](const auto* c) { return c->get_name() == word; });
    if (found == commands.end()) throw UsageError(unknown_command(word, *app, info()));
    app = *found;
    path += " " + word;
  }
  return help_text(command_info(*app, path), help_width());
}

std::string CommandLine::help_as(const std::string& form) const {
  if (form == "man") return man_page(info(), kVersion);
  if (form == "bash") return bash_completion(info());
  return form == "zsh" ? zsh_completion(info()) : fish_completion(info());
}

int CommandLine::refuse(const std::string& problem) const {
  (void)app_->exit(CLI::ParseError(problem, CLI::ExitCodes::ExtrasError));
  return kExitUsage;
}

void CommandLine::parse_words(std::vector<std::string> arguments) {
  app_->parse(reversed(std::move(arguments)));
  if (const std::string problem = option_before_command(*app_); !problem.empty()) throw UsageError(problem);
}

std::optional<int> CommandLine::parse(int argc, const char* const* argv) {
  try {
    parse_words({argv + 1, argv + argc});
    if (!help_command_ || !help_command_->parsed()) return std::nullopt;
    print_to(stdout, "{}", help(help_words_));
    return 0;
  } catch (const CLI::Success& done) {
    if (form_.empty()) return app_->exit(done);
    print_to(stdout, "{}", help_as(form_));
    return 0;
  } catch (const CLI::ParseError& error) {
    return refuse(clear_message(error, *app_, info()));
  } catch (const UsageError& error) {
    return refuse(error.what());
  }
}

void CommandLine::parse(std::vector<std::string> arguments) {
  try {
    parse_words(std::move(arguments));
  } catch (const CLI::ParseError& error) {
    throw UsageError(clear_message(error, *app_, info()));
  }
}

}  // namespace sidestep
