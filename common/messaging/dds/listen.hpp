// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/messaging/dds/dds_bus.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// A writer or reader that somebody in the domain has announced, of any vendor.
struct DdsEndpoint {
  enum class Durability : std::uint8_t { kVolatile, kTransientLocal, kTransient, kPersistent };
  enum class Liveliness : std::uint8_t { kAutomatic, kByParticipant, kByTopic };

  std::string guid;
  std::string participant;  ///< its name, as announced
  std::string topic;
  std::string type;
  bool is_writer = false;
  bool is_keyed = false;
  bool is_reliable = false;
  bool is_exclusive = false;  ///< ownership
  Durability durability = Durability::kVolatile;
  Liveliness liveliness = Liveliness::kAutomatic;
  Duration lease = Duration::max();  ///< of the liveliness
  Duration deadline = Duration::max();
  std::vector<std::string> partitions;  ///< empty: the unnamed one
};

/// Why this writer and this reader of one topic exchange nothing, in plain words; empty when they do.
std::vector<std::string> dds_mismatches(const DdsEndpoint& writer, const DdsEndpoint& reader);

/// A payload as it came: its bytes with the encapsulation header.
struct RawSample {
  Time received;
  const std::vector<std::uint8_t>& bytes;
};

/// Sees every endpoint of a domain and listens to topics of any type, without knowing the types.
class DdsListener {
 public:
  /// Throws std::runtime_error as DdsBus does.
  explicit DdsListener(const DdsSettings& settings);
  ~DdsListener();
  DdsListener(const DdsListener&) = delete;
  DdsListener& operator=(const DdsListener&) = delete;

  /// Everybody who is known now, without this listener, sorted by topic.
  std::vector<DdsEndpoint> endpoints() const;
  /// Calls back for each sample of the writer's topic, from run_until(). A second call for the same topic
  /// must be for the same type. Throws std::runtime_error.
  void listen(const DdsEndpoint& writer, std::function<void(const RawSample&)> callback);

  Time now() const;
  void run_until(Time when);
  /// From any thread, and from a signal handler.
  void stop();
  bool stopped() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sidestep
