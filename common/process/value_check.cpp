// SPDX-License-Identifier: Apache-2.0
#include "common/process/value_check.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <utility>

#include "common/file/similar_name.hpp"
#include "common/process/number_text.hpp"

namespace sidestep {
namespace {

constexpr double kMin = 1e-9, kMax = 1e9;  ///< of positive()

}  // namespace

ValueCheck in_range(double min, double max) {
  const std::string limits = fmt::format("{:.10g} to {:.10g}", min, max);
  const auto problem = [=](const std::string& text) {
    const auto number = parsed<double>(text);
    if (number && *number >= min && *number <= max) return std::string();
    return fmt::format("expected a number from {}, got {}", limits, in_quotes(text));
  };
  return {limits, problem, ValueCheck::Limits{min, max}};
}

ValueCheck in_whole_range(std::int64_t min, std::int64_t max) {
  const std::string limits = fmt::format("{} to {}", min, max);
  return {limits, [=](const std::string& text) {
            const auto number = parsed<std::int64_t>(text);
            if (number && *number >= min && *number <= max) return std::string();
            return fmt::format("expected a whole number from {}, got {}", limits, in_quotes(text));
          }};
}

ValueCheck positive() {
  return {"greater than 0", [](const std::string& text) {
            const auto number = parsed<double>(text);
            if (number && *number >= kMin && *number <= kMax) return std::string();
            if (number && *number > kMax)
              return fmt::format("expected at most {:.0f}, got {}", kMax, in_quotes(text));
            if (number && *number > 0)
              return fmt::format("expected at least {:.9f}, got {}", kMin, in_quotes(text));
            return "expected a number greater than 0, got " + in_quotes(text);
          }};
}

ValueCheck non_negative() {
  return {"at least 0", [](const std::string& text) {
            const auto number = parsed<double>(text);
            return number && *number < 0 ? "expected at least 0, got " + in_quotes(text) : std::string();
          }};
}

ValueCheck one_of(std::vector<std::string> values) {
  return {fmt::format("{{{}}}", fmt::join(values, ",")), [values](const std::string& text) {
            if (std::ranges::find(values, text) != values.end()) return std::string();
            return fmt::format("expected one of {}, got {}{}", fmt::join(values, ", "), in_quotes(text),
                               did_you_mean(text, values));
          }};
}

}  // namespace sidestep
