// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace sidestep {

/// A condition on the text of an option's value.
struct ValueCheck {
  std::string description;                                 ///< for --help, e.g. "0 to 232" or "{a,b}"
  std::function<std::string(const std::string&)> problem;  ///< returns why a value is invalid; empty if valid
  struct Limits {
    double min, max;
  };
  std::optional<Limits> limits{};  ///< set by in_range()
};
/// For options with whole numbers, Option::check() uses in_whole_range() instead of this check.
[[nodiscard]] ValueCheck in_range(double min, double max);
[[nodiscard]] ValueCheck in_whole_range(std::int64_t min, std::int64_t max);
/// Greater than 0, and usable as a duration in seconds or as a rate per second: from 1e-9 to 1e9.
[[nodiscard]] ValueCheck positive();
[[nodiscard]] ValueCheck non_negative();
[[nodiscard]] ValueCheck one_of(std::vector<std::string> values);

}  // namespace sidestep
