// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fmt/core.h>
#include <optional>
#include <vector>

#include "common/file/console.hpp"
#include "common/messaging/dds/listener.hpp"
#include "common/process/process.hpp"
#include "common/process/stop_signals.hpp"
#include "deploy/inspect/topic/rate_meter.hpp"
#include "deploy/inspect/topic/silence.hpp"
#include "deploy/inspect/topic/topic_table.hpp"
#include "deploy/inspect/topic/topic_tools.hpp"
#include "deploy/inspect/topic/topic_writer.hpp"

namespace sidestep {
namespace {

constexpr Duration kSecond{1'000'000'000};

void print_rate(const char* label, const Rate& rate) {
  if (!rate.min_gap) {
    print_output("{}{} sample(s)\n", label, rate.samples);
  } else {
    print_output("{}{} samples  {:.2f} Hz  gap min {:.2f} ms  max {:.2f} ms  {:.2f} kB/s\n", label,
                 rate.samples, rate.rate_hz, to_seconds(*rate.min_gap) * 1e3, to_seconds(*rate.max_gap) * 1e3,
                 rate.bytes_per_second * 1e-3);
  }
}

void print_bandwidth(const char* label, const Rate& rate) {
  if (rate.samples == 0)
    print_output("{}nothing\n", label);
  else
    print_output("{}{} samples  {:.2f} kB/s  size min {} B  mean {:.0f} B  max {} B\n", label, rate.samples,
                 rate.bytes_per_second * 1e-3, rate.min_bytes, rate.mean_bytes, rate.max_bytes);
}

}  // namespace

int list_topics(const TopicOptions& options) {
  DdsListener listener(options.dds);
  const StopSignals stop_signals([&listener] { listener.stop(); });
  listener.run_until(listener.now() + from_seconds(options.discovery_s));
  const std::vector<DiscoveredEndpoint> endpoints = listener.endpoints();
  write_output(topic_table(endpoints));
  if (endpoints.empty()) fmt::print(stderr, "{}\n", empty_domain_text(options.dds.domain));
  return 0;
}

int show_topic(const TopicOptions& options) {
  DdsListener listener(options.dds);
  const StopSignals stop_signals([&listener] { listener.stop(); });
  listener.run_until(listener.now() + from_seconds(options.discovery_s));
  const std::string details = topic_details(listener.endpoints(), options.topic);
  if (details.empty()) {
    print_missing_topic(options, "neither a writer nor a reader", listener);
    return kExitFailure;
  }
  write_output(details);
  return 0;
}

namespace {

/// Listens to a topic of any type. Calls `print(label, rate)` every second, and once for the total.
template <typename Print>
int measure(const TopicOptions& options, Print print) {
  DdsListener listener(options.dds);
  const StopSignals stop_signals([&listener] { listener.stop(); });
  const std::optional<DiscoveredEndpoint> writer = find_writer(listener, options);
  if (!writer) return listener.stopped() ? 0 : kExitFailure;
  RateMeter meter;
  listener.listen(*writer, [&meter](const RawSample& s) { meter.add(s.received, s.bytes.size()); });
  const Time begin = listener.now();
  const Time end = options.seconds > 0 ? begin + from_seconds(options.seconds) : Time::max();
  for (Time next = begin; !listener.stopped() && next < end;) {
    next = std::min(next + kSecond, end);
    listener.run_until(next);
    print("", meter.take_recent());
  }
  print("total: ", meter.total());
  return 0;
}

}  // namespace

int measure_rate(const TopicOptions& options) { return measure(options, print_rate); }
int measure_bandwidth(const TopicOptions& options) { return measure(options, print_bandwidth); }

}  // namespace sidestep
