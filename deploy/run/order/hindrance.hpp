// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/time/time.hpp"

namespace sidestep {

/// A reason why a robot does not carry out its order.
struct Hindrance {
  std::string state;                  ///< what to call the robot's state in a table: "off floor"
  std::string text;                   ///< "it is off the floor"
  std::optional<Duration> silence{};  ///< since the last report, if the reason is that reports are missing
};

/// All reasons in words: "it has sent no report for 12 s; it is held by client bob". Empty if there are none.
[[nodiscard]] std::string to_text(const std::vector<Hindrance>& hindrances);

/// The reasons without the durations of silences, which grow.
[[nodiscard]] std::string lasting_text(const std::vector<Hindrance>& hindrances);

}  // namespace sidestep
