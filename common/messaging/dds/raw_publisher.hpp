// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "common/messaging/cdr.hpp"
#include "common/messaging/dds/bus.hpp"

namespace sidestep {

/// Writes messages of any type to a topic, as bytes. Reliable and durable, so that readers of any QoS match.
class DdsRawPublisher {
 public:
  /// `type` as the topic's readers name it. Throws std::runtime_error as DdsBus.
  DdsRawPublisher(const DdsSettings& settings, const std::string& topic, const std::string& type,
                  bool is_keyed);
  ~DdsRawPublisher();
  DdsRawPublisher(const DdsRawPublisher&) = delete;
  DdsRawPublisher& operator=(const DdsRawPublisher&) = delete;

  /// Bytes with their encapsulation header. Throws std::runtime_error if DDS cannot send them.
  void write(std::span<const std::uint8_t> bytes, const CdrKey& key);
  /// Readers that match at present.
  int readers() const;
  /// Waits until every reliable reader has acknowledged all messages; false on timeout.
  [[nodiscard]] bool wait_until_acknowledged(Duration timeout);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sidestep
