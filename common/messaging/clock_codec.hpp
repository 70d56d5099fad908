// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/motion/version.hpp"
#include "idl/clock.hpp"

namespace sidestep {

/// A process's answer to a clock probe; see ClockReading in idl/clock.idl.
struct ClockAnswer {
  std::uint32_t process = 0;
  Incarnation incarnation = 0;
  std::uint32_t client = 0;
  Time probe_sent;                ///< send time of the probe, by the client's clock
  Time probe_received, answered;  ///< by the process's clock
  Duration host_ahead{0};         ///< the host's clock - the process's clock
  double clock_bound_s = 0;
  std::string host, scenario;  ///< printable, UTF-8
};

/// nullopt unless the message comes from an agent, a coordinator, vision, the simulator, a robot driver or
/// the referee, and every value is within its bounds. The process's clock may be arbitrarily wrong.
[[nodiscard]] std::optional<ClockAnswer> decode(const msg::ClockReading& message);

/// Encodes ClockReading.place.
[[nodiscard]] std::vector<std::uint8_t> encode_place(const std::string& host, const std::string& scenario);

/// Replaces every unprintable character with "?", and truncates the name to the message's bound.
[[nodiscard]] std::string printable_name(const std::string& name);

}  // namespace sidestep
