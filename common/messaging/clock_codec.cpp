// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/clock_codec.hpp"

#include <algorithm>

#include "common/file/utf8.hpp"
#include "common/protocol/senders.hpp"

namespace sidestep {
namespace {

constexpr double kMaxClockBound_s = 1;

bool has_clock(std::uint32_t process) {
  return process < kMaxRobots || is_coordinator(process) ||
         process == static_cast<std::uint32_t>(Sender::kVision) ||
         process == static_cast<std::uint32_t>(Sender::kSimulator) ||
         process == static_cast<std::uint32_t>(Sender::kRobots) ||
         process == static_cast<std::uint32_t>(Sender::kReferee);
}

bool is_reading(std::int64_t ns) { return ns >= 0 && ns <= to_ns(kMaxTime); }

}  // namespace

std::optional<ClockAnswer> decode(const msg::ClockReading& message) {
  const std::int64_t answered_ns = message.header().stamp_ns(), ahead_ns = message.host_ahead_ns();
  const double bound_s = message.clock_bound_s();
  if (!has_clock(message.process()) || message.header().sender() != message.process()) return std::nullopt;
  if (!is_reading(answered_ns) || !is_reading(message.probe_sent_ns()) ||
      !is_reading(message.probe_received_ns()) || message.probe_received_ns() > answered_ns)
    return std::nullopt;
  if (ahead_ns > to_ns(kMaxTime) || ahead_ns < -to_ns(kMaxTime)) return std::nullopt;
  if (!(bound_s >= 0 && bound_s <= kMaxClockBound_s)) return std::nullopt;
  const std::string place(message.place().begin(), message.place().end());
  const std::size_t end = place.find('\n');
  return ClockAnswer{message.process(),
                     message.header().incarnation(),
                     message.client(),
                     time_from_ns(message.probe_sent_ns()),
                     time_from_ns(message.probe_received_ns()),
                     time_from_ns(answered_ns),
                     Duration{ahead_ns},
                     bound_s,
                     printable_name(place.substr(0, end)),
                     printable_name(end == std::string::npos ? std::string() : place.substr(end + 1))};
}

std::vector<std::uint8_t> encode_place(const std::string& host, const std::string& scenario) {
  const std::string place = printable_name(host) + '\n' + printable_name(scenario);
  return {place.begin(), place.end()};
}

std::string printable_name(const std::string& name) {
  std::string result;
  for (std::size_t at = 0; at < name.size();) {
    const std::size_t length = printable_length(name, at);
    const std::string character = length > 0 ? name.substr(at, length) : "?";
    if (result.size() + character.size() > msg::MAX_PLACE_NAME) break;
    result += character;
    at += std::max<std::size_t>(length, 1);
  }
  return result;
}

}  // namespace sidestep
