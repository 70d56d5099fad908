// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "common/messaging/dds/bus.hpp"
#include "common/messaging/dds/discovered_endpoint.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// A received payload: its bytes, including the encapsulation header.
struct RawSample {
  Time received;
  const std::vector<std::uint8_t>& bytes;
};

/// Lists all endpoints of a domain, and reads topics of any type as raw bytes.
class DdsListener {
 public:
  /// Throws std::runtime_error if DdsBus does.
  explicit DdsListener(const DdsSettings& settings);
  ~DdsListener();
  DdsListener(const DdsListener&) = delete;
  DdsListener& operator=(const DdsListener&) = delete;

  /// All endpoints that are known now, except this listener's, sorted by topic.
  std::vector<DiscoveredEndpoint> endpoints() const;
  /// Calls back from run_until() for each sample of the writer's topic. All calls for one topic must name the
  /// same type. Throws std::runtime_error if DdsParticipant::create_reader() does.
  void listen(const DiscoveredEndpoint& writer, std::function<void(const RawSample&)> callback);

  Time now() const;
  void run_until(Time when);
  /// Makes run_until() return soon. Thread-safe and async-signal-safe.
  void stop();
  bool stopped() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sidestep
