// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/senders/sender_meter.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "common/protocol/process_names.hpp"

namespace sidestep {

void SenderMeter::add(const msg::Header& header, Time received) {
  const std::pair key(header.sender(), header.incarnation());
  if (streams_.size() >= kMaxStreams && !streams_.contains(key)) {
    streams_.erase(
        std::ranges::min_element(streams_, {}, [](const auto& entry) { return entry.second.last_received; }));
    ++forgotten_;
  }
  Stream& stream = streams_[key];
  stream.last_received = received;
  const Reception reception = stream.trace.record(0, header, received);
  if (!reception.is_newest) ++stream.not_newest;
  // Each of these times fits into 64 bits as nanoseconds; their difference might not.
  const auto difference_ns = static_cast<double>(to_ns(received)) - static_cast<double>(header.stamp_ns());
  const Duration delay = from_seconds(std::clamp(difference_ns * 1e-9, -1e9, 1e9));
  stream.min_delay = std::min(stream.min_delay, delay);
  stream.max_delay = std::max(stream.max_delay, delay);
  stream.delays.add(delay);
}

std::string SenderMeter::table() const {
  std::map<std::uint32_t, int> incarnations;
  for (const auto& [sender, stream] : streams_) ++incarnations[sender.first];
  std::string text = fmt::format("{:24}  {:>9}  {:>6}  {:>8}  {:>12}  {}\n", "SENDER", "RECEIVED", "LOST",
                                 "REPEATED", "OUT OF ORDER", "DELAY MS: MIN  P50  P99  MAX");
  for (const auto& [sender, stream] : streams_) {
    std::string name = process_name(sender.first);
    if (incarnations[sender.first] > 1) name += fmt::format(" ({})", sender.second);
    const std::uint64_t repeated = stream.trace.received() - stream.trace.distinct();
    const auto ms = [](Duration duration) { return to_seconds(duration) * 1e3; };
    text += fmt::format("{:24}  {:>9}  {:>6}  {:>8}  {:>12}  {:.3f}  {:.3f}  {:.3f}  {:.3f}\n", name,
                        stream.trace.received(), stream.trace.missed(), repeated,
                        stream.not_newest - repeated, ms(stream.min_delay), ms(stream.delays.quantile(0.5)),
                        ms(stream.delays.quantile(0.99)), ms(stream.max_delay));
  }
  if (forgotten_ > 0) text += fmt::format("and {} others, last heard before these\n", forgotten_);
  return text;
}

}  // namespace sidestep
