// SPDX-License-Identifier: Apache-2.0
#include "common/process/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <type_traits>
#include <utility>

#include "common/process/exit_code.hpp"

namespace sidestep {
namespace {

ValueCheck from_library(const CLI::Validator& validator) {
  return {validator.get_description(), [validator](const std::string& text) { return validator(text); }};
}

template <typename Value>
constexpr bool is_real_number =
    std::is_same_v<Value, double> || std::is_same_v<Value, std::optional<double>> ||
    std::is_same_v<Value, std::vector<double>>;

/// The library's checks of ranges let NaN through.
CLI::Validator finite() {
  const auto problem = [](const std::string& text) {
    double value = 0;
    const bool is_finite = !CLI::detail::lexical_cast(text, value) || std::isfinite(value);
    return is_finite ? "" : text + " is not a finite number";
  };
  return CLI::Validator(problem, "");
}

/// Turns the project's exception into the library's, which adds the option's name.
template <typename Callback>
auto translated(Callback callback) {
  return [callback = std::move(callback)](const auto&... arguments) {
    try {
      callback(arguments...);
    } catch (const UsageError& error) {
      throw CLI::ValidationError(error.what());
    }
  };
}

}  // namespace

ValueCheck in_range(double min, double max) {
  return {fmt::format("in [{}, {}]", min, max),
          [range = CLI::Range(min, max)](const std::string& text) { return range(text); }};
}

ValueCheck positive() {
  constexpr double kLimit = 1e9;
  const auto problem = [range = CLI::Range(1 / kLimit, kLimit)](const std::string& text) {
    return range(text).empty() ? "" : text + " is not a number above 0, up to 1e9";
  };
  return {"POSITIVE", problem};
}

ValueCheck non_negative() { return from_library(CLI::NonNegativeNumber); }

ValueCheck one_of(std::vector<std::string> values) { return from_library(CLI::IsMember(std::move(values))); }

Option Option::required() const {
  option_->required();
  return *this;
}

Option Option::check(const ValueCheck& check) const {
  option_->check(CLI::Validator([problem = check.problem](std::string& text) { return problem(text); },
                                check.description));
  return *this;
}

Option Option::check(std::function<std::string(const std::string&)> problem) const {
  return check(ValueCheck{"", std::move(problem)});
}

Option Option::show_default() const {
  option_->capture_default_str();
  return *this;
}

Option Option::show_default(const std::string& text) const {
  option_->default_str(text);
  return *this;
}

Option Option::comma_separated(std::optional<int> count) const {
  option_->delimiter(',');
  if (count)
    option_->expected(*count);
  else
    option_->allow_extra_args(false);
  return *this;
}

Option Option::needs(const Option& other) const {
  option_->needs(other.option_);
  return *this;
}

Option Option::excludes(const Option& other) const {
  option_->excludes(other.option_);
  return *this;
}

bool Option::is_given() const { return option_->count() > 0; }

CliCommand CliCommand::add_subcommand(const std::string& name, const std::string& description) const {
  return CliCommand(*app_->add_subcommand(name, description));
}

void CliCommand::require_subcommand() const { app_->require_subcommand(1); }

void CliCommand::add_footer(const std::string& text) const { app_->footer(text); }

void CliCommand::add_version(const std::string& text) const { app_->set_version_flag("--version", text); }

template <typename Value>
Option CliCommand::add_option(const std::string& name, Value& value, const std::string& description) const {
  CLI::Option& option = *app_->add_option(name, value, description);
  if constexpr (is_real_number<Value>) option.check(finite());
  return Option(option);
}

template Option CliCommand::add_option(const std::string&, std::string&, const std::string&) const;
template Option CliCommand::add_option(const std::string&, double&, const std::string&) const;
template Option CliCommand::add_option(const std::string&, int&, const std::string&) const;
template Option CliCommand::add_option(const std::string&, std::uint32_t&, const std::string&) const;
template Option CliCommand::add_option(const std::string&, std::uint64_t&, const std::string&) const;
template Option CliCommand::add_option(const std::string&, std::optional<std::string>&,
                                       const std::string&) const;
template Option CliCommand::add_option(const std::string&, std::optional<double>&, const std::string&) const;
template Option CliCommand::add_option(const std::string&, std::optional<int>&, const std::string&) const;
template Option CliCommand::add_option(const std::string&, std::optional<std::uint32_t>&,
                                       const std::string&) const;
template Option CliCommand::add_option(const std::string&, std::vector<std::string>&,
                                       const std::string&) const;
template Option CliCommand::add_option(const std::string&, std::vector<double>&, const std::string&) const;
template Option CliCommand::add_option(const std::string&, std::vector<int>&, const std::string&) const;
template Option CliCommand::add_option(const std::string&, std::vector<std::uint32_t>&,
                                       const std::string&) const;

Option CliCommand::add_flag(const std::string& name, bool& value, const std::string& description) const {
  return Option(*app_->add_flag(name, value, description));
}

Option CliCommand::add_option(const std::string& name, std::function<void(const std::string&)> take,
                              const std::string& description) const {
  return Option(*app_->add_option_function<std::string>(name, translated(std::move(take)), description));
}

Option CliCommand::add_optional_value(const std::string& name, std::optional<std::string>& value,
                                      const std::string& default_value,
                                      const std::string& description) const {
  const auto take = [&value, default_value](const std::vector<std::string>& given) {
    const bool is_left_out = given.empty() || given.front().empty();
    value = is_left_out ? default_value : given.front();
  };
  CLI::Option* option = app_->add_option_function<std::vector<std::string>>(
      name, take, description + " [" + default_value + "]");
  option->expected(0, 1);
  return Option(*option);
}

Option CliCommand::option(const std::string& name) const { return Option(*app_->get_option(name)); }

void CliCommand::on_parsed(std::function<void()> callback) const {
  app_->callback(translated(std::move(callback)));
}

CommandLine::CommandLine(const std::string& description, const std::string& program_name)
    : app_(std::make_unique<CLI::App>(description, program_name)) {}

CommandLine::~CommandLine() = default;

/// As the library wants them. It takes "-.5" for an option, but not "-0.5".
std::vector<std::string> CommandLine::reversed(std::vector<std::string> arguments) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  for (std::string& argument : arguments) {
    if (argument.size() > 2 && argument.starts_with("-.") && is_digit(argument[2])) argument.insert(1, "0");
  }
  std::ranges::reverse(arguments);
  return arguments;
}

std::optional<int> CommandLine::parse(int argc, const char* const* argv) {
  try {
    app_->parse(reversed({argv + 1, argv + argc}));
  } catch (const CLI::ParseError& error) {
    return app_->exit(error) == 0 ? 0 : kExitUsage;
  }
  return std::nullopt;
}

void CommandLine::parse(std::vector<std::string> arguments) {
  try {
    app_->parse(reversed(std::move(arguments)));
  } catch (const CLI::ParseError& error) {
    throw UsageError(error.what());
  }
}

}  // namespace sidestep
