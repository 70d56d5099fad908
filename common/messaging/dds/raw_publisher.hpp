// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <string>

#include "common/messaging/cdr.hpp"
#include "common/messaging/dds/bus.hpp"

namespace sidestep {

/// Writes messages of any type to a topic, as bytes. Reliable and durable, so that readers of any QoS match.
class DdsRawPublisher {
 public:
  /// `type` must be the name that the topic's readers use. Throws std::runtime_error if DdsBus does.
  DdsRawPublisher(const DdsSettings& settings, const std::string& topic, const std::string& type,
                  bool is_keyed);
  ~DdsRawPublisher();
  DdsRawPublisher(const DdsRawPublisher&) = delete;
  DdsRawPublisher& operator=(const DdsRawPublisher&) = delete;

  /// Sends a payload including its encapsulation header. Throws std::runtime_error if DDS cannot send it.
  void write(std::span<const std::uint8_t> bytes, const CdrKey& key);
  /// The GUIDs of the readers that match now, as DiscoveredEndpoint has them.
  std::set<std::string> readers() const;
  /// Waits until every reliable reader has acknowledged all messages; false on timeout.
  [[nodiscard]] bool wait_until_acknowledged(Duration timeout);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sidestep
