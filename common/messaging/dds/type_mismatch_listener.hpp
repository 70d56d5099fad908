// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "common/messaging/dds/discovered_endpoint.hpp"
#include "common/time/time.hpp"
#include "fast_dds/discovery_listener.hpp"

namespace sidestep {

/// Watches discovery. Logs endpoints that use one of our channels with a different type, because DDS silently
/// never matches them. Also records when the writers of each channel were discovered. Thread-safe.
class TypeMismatchListener : public fast_dds::DiscoveryListener {
 public:
  /// Registers one of our channels and its type.
  void expect(const std::string& channel, const std::string& type);
  /// Discovery time of the channel's most recently discovered writer of our type; nullopt if there is no
  /// writer.
  std::optional<Time> latest_writer_found_at(const std::string& channel) const;

  void on_endpoint(const fast_dds::rtps::GUID_t& guid, DiscoveredEndpoint&& endpoint,
                   EndpointChange change) override;

 private:
  void compare(const DiscoveredEndpoint& endpoint);

  mutable std::mutex mutex_;
  std::map<std::string, std::string> types_;  ///< type of each channel
  /// Discovery times, indexed by channel and type, then by the writer's GUID.
  std::map<std::pair<std::string, std::string>, std::map<std::string, Time>> writers_;
};

}  // namespace sidestep
