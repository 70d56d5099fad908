// SPDX-License-Identifier: Apache-2.0
#include "common/process/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <fmt/format.h>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>

#include "common/file/console.hpp"
#include "common/process/exit_code.hpp"
#include "common/yaml/plus_sign.hpp"

namespace sidestep {
namespace {

ValueCheck from_library(const CLI::Validator& validator) {
  return {validator.get_description(), [validator](const std::string& text) { return validator(text); }};
}

/// Quotes a value for a message, and truncates long values.
std::string in_quotes(const std::string& text) {
  constexpr std::size_t kMaxLength = 60;
  return fmt::format("\"{}\"", text.size() > kMaxLength ? text.substr(0, kMaxLength) + "..." : text);
}

/// Parses a number in decimal notation that is the whole text. A leading "+" is allowed; NaN and infinity are
/// not.
template <typename Number>
std::optional<Number> parsed(std::string_view text) {
  text = without_plus(text);
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc{} || stop != end) return std::nullopt;
  if constexpr (std::is_floating_point_v<Number>) {
    if (!std::isfinite(number)) return std::nullopt;
  }
  return number;
}

/// The type of a single value of an option.
template <typename Value>
struct Element {
  using Type = Value;
};
template <typename Value>
struct Element<std::optional<Value>> {
  using Type = Value;
};
template <typename Value>
struct Element<std::vector<Value>> {
  using Type = Value;
};

/// Prevents misreadings by the CLI library: it reads 010 as 8, a number that is too large as the maximum, and
/// an empty text as a missing value. Such texts are refused or rewritten in the form that the library reads
/// correctly.
template <typename Number>
std::string normalise_number(std::string& text) {
  const auto number = parsed<Number>(text);
  if (number && std::is_floating_point_v<Number>) {
    if (text.starts_with('+')) text.erase(0, 1);
    return "";
  }
  if (number) {
    text = std::to_string(*number);
    return "";
  }
  if constexpr (std::is_floating_point_v<Number>) return "expected a finite number, got " + in_quotes(text);
  return fmt::format("expected a whole number from {} to {}, got {}", std::numeric_limits<Number>::min(),
                     std::numeric_limits<Number>::max(), in_quotes(text));
}

template <typename Type>
CLI::Validator type_check() {
  if constexpr (std::is_arithmetic_v<Type>) {
    return CLI::Validator([](std::string& text) { return normalise_number<Type>(text); }, "");
  } else {
    // Refuses empty values, so that a script's unset variable does not count as a missing option.
    return CLI::Validator(
        [](std::string& text) { return text.empty() ? "expected some text, got \"\"" : ""; }, "");
  }
}

/// Wraps a callback: its UsageError becomes the library's exception, prefixed with the option's name if any.
template <typename Callback>
auto translated(const std::string& option, Callback callback) {
  return [option, callback = std::move(callback)](const auto&... arguments) {
    try {
      callback(arguments...);
    } catch (const UsageError& error) {
      throw option.empty() ? CLI::ValidationError(error.what()) : CLI::ValidationError(option, error.what());
    }
  };
}

}  // namespace

ValueCheck in_range(double min, double max) {
  const std::string description = fmt::format("in [{:.10g}, {:.10g}]", min, max);
  const auto problem = [=](const std::string& text) {
    const auto number = parsed<double>(text);
    if (number && *number >= min && *number <= max) return std::string();
    return fmt::format("expected a number {}, got {}", description, in_quotes(text));
  };
  return {description, problem, ValueCheck::Limits{min, max}};
}

ValueCheck in_whole_range(std::int64_t min, std::int64_t max) {
  const std::string description = fmt::format("in [{}, {}]", min, max);
  return {description, [=](const std::string& text) {
            const auto number = parsed<std::int64_t>(text);
            if (number && *number >= min && *number <= max) return std::string();
            return fmt::format("expected a whole number {}, got {}", description, in_quotes(text));
          }};
}

ValueCheck positive() {
  return {"POSITIVE", [](const std::string& text) {
            const auto number = parsed<double>(text);
            if (number && *number >= 1e-9 && *number <= 1e9) return std::string();
            return "expected a number from 1e-9 to 1e9, got " + in_quotes(text);
          }};
}

ValueCheck non_negative() {
  return {"NONNEGATIVE", [](const std::string& text) {
            const auto number = parsed<double>(text);
            return number && *number < 0 ? "expected at least 0, got " + in_quotes(text) : std::string();
          }};
}

ValueCheck one_of(std::vector<std::string> values) { return from_library(CLI::IsMember(std::move(values))); }

Option Option::required() const {
  option_->required();
  return *this;
}

// Inserted before the type check, because its message names the limits.
Option Option::check(const ValueCheck& check) const {
  ValueCheck used = check;
  if (is_whole_ && check.limits)
    used = in_whole_range(static_cast<std::int64_t>(check.limits->min),
                          static_cast<std::int64_t>(check.limits->max));
  option_->transform(CLI::Validator([problem = used.problem](std::string& text) { return problem(text); },
                                    used.description));
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
  option.transform(type_check<typename Element<Value>::Type>());
  return Option(option, std::is_integral_v<typename Element<Value>::Type>);
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
  return Option(
      *app_->add_option_function<std::string>(name, translated(name, std::move(take)), description));
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
  app_->callback(translated("", std::move(callback)));
}

CommandLine::CommandLine(const std::string& description, const std::string& program_name)
    : app_(std::make_unique<CLI::App>(description, program_name)) {
  // Called here, because every program starts by creating its command line.
  reopen_standard_streams();
  // Writing beyond the limit of a file's size then fails like writing to a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
}

CommandLine::~CommandLine() = default;

namespace {

/// Names the word found where a command is expected; the library would only say that a command is missing.
std::optional<CLI::ParseError> unknown_command(const CLI::App& root) {
  const CLI::App* app = &root;
  while (!app->get_subcommands().empty()) app = app->get_subcommands().front();
  const std::vector<std::string> rest = app->remaining();
  if (app->get_require_subcommand_min() == 0 || rest.empty() || rest.front().starts_with("-"))
    return std::nullopt;
  std::vector<std::string> names;
  for (const CLI::App* command : app->get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return CLI::ParseError(fmt::format("{} is not a command, expected one of: {}", in_quotes(rest.front()),
                                     fmt::join(names, ", ")),
                         CLI::ExitCodes::ExtrasError);
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

std::optional<int> CommandLine::parse(int argc, const char* const* argv) {
  try {
    app_->parse(reversed({argv + 1, argv + argc}));
  } catch (const CLI::ParseError& error) {
    const auto problem = unknown_command(*app_);
    return app_->exit(problem ? *problem : error) == 0 ? 0 : kExitUsage;
  }
  return std::nullopt;
}

void CommandLine::parse(std::vector<std::string> arguments) {
  try {
    app_->parse(reversed(std::move(arguments)));
  } catch (const CLI::ParseError& error) {
    if (const auto problem = unknown_command(*app_)) throw UsageError(problem->what());
    throw UsageError(error.what());
  }
}

}  // namespace sidestep
