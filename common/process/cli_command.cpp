// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdint>
#include <fmt/format.h>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>

#include "common/process/command_line.hpp"
#include "common/process/number_text.hpp"

namespace sidestep {
namespace {

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
  using Limits = std::numeric_limits<Number>;
  if (is_whole_number(text))
    return text.starts_with('-') ? fmt::format("expected at least {}, got {}", Limits::min(), in_quotes(text))
                                 : fmt::format("expected at most {}, got {}", Limits::max(), in_quotes(text));
  return "expected a whole number, got " + in_quotes(text);
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
  // At most one command: a later word with the name of a command is an argument of the first.
  if (app_->get_require_subcommand_max() == 0) app_->require_subcommand(0, 1);
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
      name, take, default_value.empty() ? description : fmt::format("{} [{}]", description, default_value));
  option->expected(0, 1);
  return Option(*option);
}

Option CliCommand::option(const std::string& name) const { return Option(*app_->get_option(name)); }

void CliCommand::on_parsed(std::function<void()> callback) const {
  app_->callback(translated("", std::move(callback)));
}

}  // namespace sidestep
