// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/process/help/command_info.hpp"
#include "common/process/value_check.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace sidestep {

/// An error in the command line; the message says where and why. Programs exit with kExitUsage.
class UsageError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// Handle of one option, valid during the lifetime of its command line.
class Option {
 public:
  explicit Option(CLI::Option& option, bool is_whole = false) : option_(&option), is_whole_(is_whole) {}

  Option required() const;
  Option check(const ValueCheck& check) const;
  Option check(std::function<std::string(const std::string&)> problem) const;
  /// Makes --help show the variable's current value, or `text`, as the default.
  Option show_default() const;
  Option show_default(const std::string& text) const;
  /// The value is a comma-separated list, with exactly `count` elements if `count` is given.
  Option comma_separated(std::optional<int> count = std::nullopt) const;
  Option needs(const Option& other) const;
  Option excludes(const Option& other) const;
  bool is_given() const;

 private:
  CLI::Option* option_;
  bool is_whole_;  ///< the option's values are whole numbers
};

/// Handle of a command or subcommand, to which options are added. Variables must outlive the parsing.
class CliCommand {
 public:
  explicit CliCommand(CLI::App& app) : app_(&app) {}

  /// A command line contains at most one of the subcommands, and then none of the program's own options.
  CliCommand add_subcommand(const std::string& name, const std::string& description) const;
  void require_subcommand() const;
  /// Text at the end of --help.
  void add_footer(const std::string& text) const;
  /// Adds --version, which prints this text.
  void add_version(const std::string& text) const;
  /// An option if the name begins with dashes, else a positional argument. `Value` is one of the types for
  /// which cli_command.cpp instantiates this template. NaN and infinity are refused.
  template <typename Value>
  Option add_option(const std::string& name, Value& value, const std::string& description = {}) const;
  Option add_flag(const std::string& name, bool& value, const std::string& description = {}) const;
  /// An option whose value is passed to `take`, which throws UsageError if it rejects the value.
  Option add_option(const std::string& name, std::function<void(const std::string&)> take,
                    const std::string& description) const;
  /// An option whose value may be omitted; it is then `default_value`, which --help shows unless it is empty.
  Option add_optional_value(const std::string& name, std::optional<std::string>& value,
                            const std::string& default_value, const std::string& description) const;
  Option option(const std::string& name) const;
  /// `callback` is called after parsing if the command line contains this command; it may throw UsageError.
  void on_parsed(std::function<void()> callback) const;

 private:
  CLI::App* app_;
};

/// A program's command line. Only its implementation uses CLI11, whose headers take seconds to compile.
class CommandLine {
 public:
  explicit CommandLine(const std::string& description, const std::string& program_name);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  CliCommand root() const { return CliCommand(*app_); }

  /// Adds the command `help [COMMAND]`, which prints what --help prints.
  void add_help_command();

  /// Parses the program's arguments. Returns an exit code if the program should end: 0 after printing help or
  /// the version, or kExitUsage after reporting wrong usage on stderr. Otherwise returns nullopt.
  [[nodiscard]] std::optional<int> parse(int argc, const char* const* argv);
  /// Parses the arguments after the program's name. Throws UsageError.
  void parse(std::vector<std::string> arguments);
  /// Reports on stderr wrong usage that parse() cannot find. Returns kExitUsage.
  int refuse(const std::string& problem) const;

  /// The program with all its options and commands.
  [[nodiscard]] CommandInfo info() const;
  /// The help of a command, e.g. {"topic", "echo"}; of the program if there is no word. Throws UsageError if
  /// there is no such command.
  [[nodiscard]] std::string help(const std::vector<std::string>& words) const;
  /// The help in another form: "man", or "bash", "zsh" or "fish" for the completion of a shell.
  [[nodiscard]] std::string help_as(const std::string& form) const;

 private:
  static std::vector<std::string> reversed(std::vector<std::string> arguments);
  /// Throws CLI::Error or UsageError.
  void parse_words(std::vector<std::string> arguments);
  std::unique_ptr<CLI::App> app_;
  std::string form_;                     ///< value of --help-as
  CLI::App* help_command_ = nullptr;     ///< null: the program has no command `help`
  std::vector<std::string> help_words_;  ///< the arguments of `help`
};

}  // namespace sidestep
